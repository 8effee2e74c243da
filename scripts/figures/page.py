"""docs/measurements.md out of page.md, in which braces ask for figures:

  {fig TOPIC ID [COLUMN]}           as prose.py shows it; {num …} without its unit
  {met TOPIC ID COLUMN <= LIMIT}    whether a goal is met
  {paper KEY}                       a published figure
  {machine FACT}
"""
import pathlib
import re

from figures.prose import UNITS, figure_of, unmarked
from figures.results import ROOT, Wrong, page_machine, read_facts

PAGE = ROOT / "docs" / "measurements.md"
TEMPLATE = pathlib.Path(__file__).with_name("page.md")
ASKED = re.compile(r"\{(fig|num|met|paper|machine) ([^}]*)\}")


def goal(topics, words):
    """Whether a row keeps to its limit."""
    *of, relation, limit = words
    if relation not in ("<=", ">=") or len(of) != 3:
        raise Wrong(f"'{' '.join(words)}': expected TOPIC ID COLUMN <= LIMIT")
    figure_of(topics, of)
    value = getattr(topics[of[0]][of[1]], of[2])
    holds = value <= float(limit) if relation == "<=" else value >= float(limit)
    return "met" if holds else "**missed**"


def made(documents):
    """The page's text; what it asks for in vain is added to what is wrong."""
    folder = page_machine()
    facts = read_facts(folder) | {"folder": folder.name}

    def answer(match):
        kind, words = match.group(1), match.group(2).split()
        try:
            if kind in ("fig", "num"):
                text = figure_of(documents.topics, words)
                return re.sub(rf" (?:{'|'.join(map(re.escape, UNITS))})$", "", text) if kind == "num" else text
            if kind == "met":
                return goal(documents.topics, words)
            return documents.published[words[0]]["value"] if kind == "paper" else facts[" ".join(words)]
        except KeyError as error:
            complaint = f"nothing is known of {error}"
        except Wrong as error:
            complaint = str(error)
        documents.wrong.append(f"scripts/figures/page.md: {match.group()}: {complaint}")
        return "?"
    text = ASKED.sub(answer, TEMPLATE.read_text(encoding="utf-8"))
    return ("<!-- Made by scripts/make-measurements.py of scripts/figures/page.md and benchmarks/results: change those. -->\n"
            + text)


def template_complaints(documents):
    """Figures that stand in the template itself, but for goals and settings, which are chosen."""
    text = re.sub(r"(?:≤|≥|>|target) [\d.]+ ?[%×]?", "", TEMPLATE.read_text(encoding="utf-8"))
    text = ASKED.sub("", text)
    return [f"scripts/figures/page.md:{line}: {what}" for line, what in unmarked(text, documents.published)]
