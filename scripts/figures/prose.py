"""Figures in documents. A comment before a figure says where it is from:

  <!--fig TOPIC ID COLUMN-->6.8      a row of benchmarks/results/MACHINE/TOPIC.csv; COLUMN is median (with its unit, the
                                     default), min, max, ratio, kept, lost, lost_pixels or excess. Filled in by
                                     scripts/make-measurements.py: write 0 for a start.
  <!--paper KEY-->1.45               published; KEY is a row of benchmarks/results/published.csv
  <!--given-->20 %                   chosen, not measured: a goal, a setting, a definition
"""
import csv
import re

from figures.results import RESULTS, ROOT, SECONDS, Wrong, page_machine, read_all

NUMBER = r"\d(?:[\d,]*\d)?(?:\.\d+)?"
UNITS = ("ns", "µs", "ms", "s", "%", "×", "B", "bytes", "KiB", "MiB", "GiB", "kB", "MB", "GB", "fps", "M triangles/s",
         "M boxes/s", "objects", "rays", "calls", "triangles", "tiles", "vertices", "frames", "views", "cycles")
UNIT = "|".join(sorted(map(re.escape, UNITS), key=len, reverse=True))
MARK = re.compile(r"(?<!`)<!--(fig|paper|given)( [^>]*?)?-->")
FIGURE = re.compile(rf"({NUMBER})(?: ({UNIT})(?![\w/]))?")
# What reads like a measured figure: a number with a unit of time, memory or rate, a share, or so many times something.
MEASURED = re.compile(
    rf"(?<![\w.])({NUMBER})[  ]?(ns|µs|us|ms|s|seconds?|minutes?|min|%|per cent|fps|frames? (?:a|per) second|[KMG]i?B|kB"
    rf"|M(?:illion)? [a-z]+ ?(?:/|a |per )s(?:econd)?|M/s|x|×(?!\s?\d)|times)(?![\w/])")
PLAIN = ("objects", "rays", "calls", "triangles", "tiles", "vertices", "frames", "views")


def show(value, unit=""):
    """Three significant digits in the unit that suits, counts in full with commas."""
    if unit in SECONDS:
        seconds = value * SECONDS[unit]
        unit = next((name for name, size in reversed(SECONDS.items()) if abs(seconds) >= size), "ns")
        value = seconds / SECONDS[unit]
    if unit in PLAIN or unit == "bytes":
        return f"{value:,.0f} {unit}"
    return significant(value) + (f" {unit}" if unit else "")


def significant(value):
    """Three digits, without an exponent."""
    if value == 0:
        return "0"
    digits = 2 - int(f"{value:.2e}".split("e")[1])
    return f"{round(value, digits):,.{max(0, digits)}f}"


def figure_of(topics, words):
    """The text for TOPIC ID [COLUMN]."""
    topic, name, column = (words + ["median"])[:3] if len(words) == 2 else words if len(words) == 3 else (None,) * 3
    if topic is None:
        raise Wrong(f"'{' '.join(words)}': expected TOPIC ID [COLUMN]")
    topic = topic.removesuffix(".csv")
    if topic not in topics:
        raise Wrong(f"no topic '{topic}': expected {', '.join(topics)}")
    if name not in topics[topic]:
        raise Wrong(f"{topic}.csv has no row '{name}'")
    row = topics[topic][name]
    value = getattr(row, column, None)
    if column not in ("median", "min", "max", "ratio", "kept", "lost", "lost_pixels", "excess") or value is None:
        raise Wrong(f"{topic}.csv, row '{name}' has no {column}")
    if column == "ratio":
        return significant(value)
    return f"{value:,.0f}" if column in ("kept", "lost", "lost_pixels", "excess") else show(value, row.unit)


def published():
    with open(RESULTS / "published.csv", encoding="utf-8", newline="") as stream:
        return {line["key"]: line for line in csv.DictReader(stream)}


class Documents:
    """Every document that may quote a figure, and what is wrong with it."""

    def __init__(self):
        self.topics, self.published = read_all(page_machine()), published()
        self.wrong = []

    def files(self):
        found = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
        return [file for file in found if file.name != "measurements.md"]

    def filled(self, file):
        """The document with its figures as the CSVs have them."""
        text = file.read_text(encoding="utf-8")

        def fill(match):
            kind, words = match.group(1), (match.group(2) or "").split()
            if kind != "fig":
                return match.group()
            line = text.count("\n", 0, match.start()) + 1
            try:
                return match.group(0)[:match.group(0).index("-->") + 3] + figure_of(self.topics, words)
            except Wrong as wrong:
                self.wrong.append(f"{file.relative_to(ROOT)}:{line}: {wrong}")
                return match.group()
        return re.sub(MARK.pattern + FIGURE.pattern, fill, text)

    def check(self, file):
        """Figures that are not as the CSVs have them, published ones that nobody published, and those without a mark."""
        text, name = file.read_text(encoding="utf-8"), file.relative_to(ROOT)
        if self.filled(file) != text:
            self.wrong.append(f"{name}: figures are not those of the CSVs: run scripts/make-measurements.py")
        self.wrong += [f"{name}:{line}: {what}" for line, what in unmarked(text, self.published)]


def unmarked(text, known):
    """(line, complaint) for each figure that no mark stands before, and each mark that means nothing."""
    code = False
    for at, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("```"):
            code = not code
        if code or line.lstrip().startswith("```"):
            continue
        line = re.sub(r"`[^`]*`", lambda match: " " * len(match.group()), line)
        for mark in MARK.finditer(line):
            kind, words = mark.group(1), (mark.group(2) or "").split()
            if not FIGURE.match(line, mark.end()):
                yield at, f"expected a number after {mark.group()}"
            if kind == "paper" and (len(words) != 1 or words[0] not in known):
                yield at, f"benchmarks/results/published.csv has no key '{' '.join(words)}'"
        plain = re.sub(MARK.pattern + FIGURE.pattern + r"(?: ?(?:times|×))?", "", line)
        for figure in MEASURED.finditer(plain):
            yield at, (f"'{figure.group().strip()}' reads like a measurement: tie it to a row by <!--fig TOPIC ID-->, or "
                       "say <!--paper KEY--> or <!--given-->")
