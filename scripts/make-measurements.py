#!/usr/bin/env python3
"""make-measurements.py [--check]: makes docs/measurements.md of scripts/figures/page.md and benchmarks/results, and fills
in the figures of README.md and docs. With --check it writes nothing and fails where something is not as it would make
it, or where a document holds a figure that no row and no paper stands behind."""
import sys

from figures.page import PAGE, made, template_complaints
from figures.prose import Documents
from figures.results import ROOT, Wrong, write_whole


def main(check):
    documents = Documents()
    page = made(documents)
    wrong = documents.wrong
    if check:
        if not PAGE.exists() or PAGE.read_text(encoding="utf-8") != page:
            wrong.append("docs/measurements.md is not what the CSVs make it: run scripts/make-measurements.py")
        wrong += template_complaints(documents)
    for file in documents.files():
        if check:
            documents.check(file)
        else:
            text = documents.filled(file)
            if text != file.read_text(encoding="utf-8"):
                write_whole(file, text)
                print(f"filled in {file.relative_to(ROOT)}")
    if wrong:
        sys.exit("\n".join(dict.fromkeys(wrong)))
    if not check:
        write_whole(PAGE, page)
    rows = sum(len(rows) for rows in documents.topics.values())
    print(f"the documents' figures are those of {rows} rows")


if sys.argv[1:] not in ([], ["--check"]):
    sys.exit("usage: make-measurements.py [--check]")
try:
    main(sys.argv[1:] == ["--check"])
except Wrong as error:
    sys.exit(f"make-measurements.py: {error}")
