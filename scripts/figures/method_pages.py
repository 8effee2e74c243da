"""What docs/methods says of each method by the registry's own words, between markers, and what people write around it. A
section may speak of several methods, "## one, another", of which the registry says the same."""
import re

from figures.results import ROOT, Wrong

PAGES = ROOT / "docs" / "methods"
SECTION = re.compile(r"^## ([^\n]+)\n(.*?)(?=^## |\Z)", re.M | re.S)
BLOCK = re.compile(r"<!--registry-->\n.*?<!--/registry-->\n", re.S)


def forms_of(registry):
    """{name: {"CPU": form, "device": form}} in the registry's order."""
    methods = {}
    for key, place in (("methods", "CPU"), ("device_methods", "device")):
        for form in registry[key]:
            methods.setdefault(form["name"], {})[place] = form
    return methods


def papers_of(registry):
    """The letters that the registry gives papers: {"A": "Lee & Shin 2023"}."""
    named = (form["paper"].partition(": ") for key in ("methods", "device_methods") for form in registry[key])
    return {letter: paper for letter, _, paper in named if len(letter) == 1 and paper}


def source_of(form, papers):
    paper = re.sub(r"^[A-Z]: ", "", form["paper"])
    return re.sub(r"\b([A-Z])$", lambda match: papers.get(match.group(1), match.group(1)), paper)


def by_place(forms, field):
    """One value where the places agree, else each with its place."""
    values = {place: form[field] for place, form in forms.items() if form[field]}
    if len(set(values.values())) <= 1 and (len(values) == len(forms) or not values):
        return next(iter(values.values()), "")
    places = {"CPU": "on the CPU", "device": "on a device"}
    return ", ".join(f"{value} {places[place]}" for place, value in values.items())


def plain(number):
    return f"{int(number):,}" if number == int(number) else f"{number:g}".replace("e-0", "e-")


def parameters_of(forms):
    """A line of a table for each parameter, with the place where only one of two has it."""
    lines = {}
    for place, form in forms.items():
        for entry in form["parameters"]:
            allowed = (entry["choices"].replace("|", ", ") if "choices" in entry
                       else f"{plain(entry['min'])} to {plain(entry['max'])}")
            lines.setdefault((entry["name"], entry["default"], allowed, entry["summary"]), []).append(place)
    for (name, default, allowed, summary), places in lines.items():
        only = f" ({places[0]})" if len(places) < len(forms) else ""
        yield f"| `{name}` | {default} | {allowed} | {summary}{only} |"


def block_of(forms, papers):
    """The generated part of a section."""
    first = next(iter(forms.values()))
    facts = (("source", source_of(first, papers)), ("guarantee", by_place(forms, "guarantee")),
             ("runs on", " and ".join(forms)), ("needs", by_place(forms, "needs")))
    facts = [fact for fact in facts if fact[1]]
    lines = ["| " + " | ".join(name for name, _ in facts) + " |", "|---" * len(facts) + "|",
             "| " + " | ".join(value for _, value in facts) + " |"]
    parameters = list(parameters_of(forms))
    if parameters:
        lines += ["", "| parameter | default | allowed | |", "|---|---|---|---|", *parameters]
    return "\n".join(["<!--registry-->", *lines, "<!--/registry-->", ""])


def renewed(text, registry):
    """A page with the generated part of each of its sections as the registry has it."""
    methods, papers = forms_of(registry), papers_of(registry)

    def renew(match):
        heading, body = match.groups()
        blocks = {block_of(methods[name], papers) for name in heading.split(", ") if name in methods}
        rest = BLOCK.sub("", body).strip("\n")
        return f"## {heading}\n\n" + "\n".join([*sorted(blocks), rest]) + "\n\n"
    return SECTION.sub(renew, text).rstrip("\n") + "\n"


def complaints(registry):
    """Methods without a section, sections without a method, parts that are not current or that say nothing."""
    methods, found = forms_of(registry), set()
    for page in pages():
        text, name = page.read_text(encoding="utf-8"), page.relative_to(ROOT)
        for heading, body in SECTION.findall(text):
            found.update(heading.split(", "))
            prose, _, cost = BLOCK.sub("", body).partition("**Cost:**")
            if not cost.strip():
                yield f"{name}: {heading} does not say its cost"
            if len(prose.split()) < 5:
                yield f"{name}: {heading} does not say what it does"
            yield from (f"{name}: no method '{one}'" for one in heading.split(", ") if one not in methods)
        if renewed(text, registry) != text:
            yield f"{name}: not as the registry has it: run scripts/make-method-pages.py"
    yield from (f"{name}: no section in docs/methods" for name in methods if name not in found)


def pages():
    found = sorted(PAGES.glob("*.md"))
    if not found:
        raise Wrong("docs/methods holds no page")
    return found
