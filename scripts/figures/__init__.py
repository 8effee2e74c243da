"""Figures as files: measured by programs, kept as CSV by machine, quoted by the documents."""
