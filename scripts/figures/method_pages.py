"""What docs/methods says of each method by the registry's own words, between markers, and what people write around it."""
import re

from figures.results import ROOT, Wrong

PAGES = ROOT / "docs" / "methods"
SECTION = re.compile(r"^## (\S+)\n(.*?)(?=^## |\Z)", re.M | re.S)
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
        name, body = match.groups()
        if name not in methods:
            return match.group()
        block = block_of(methods[name], papers)
        rest = BLOCK.sub("", body).strip("\n")
        return f"## {name}\n\n{block}\n{rest}\n\n"
    return SECTION.sub(renew, text).rstrip("\n") + "\n"


def complaints(registry):
    """Methods without a section, sections without a method, parts that are not current or that say nothing."""
    methods, found = forms_of(registry), {}
    for page in sorted(PAGES.glob("*.md")):
        text = page.read_text(encoding="utf-8")
        for name, body in SECTION.findall(text):
            found[name] = page.name
            if name not in methods:
                yield f"docs/methods/{page.name}: no method '{name}'"
                continue
            prose = BLOCK.sub("", body).strip()
            if not re.search(r"^\*\*Cost:\*\* \S", prose, re.M):
                yield f"docs/methods/{page.name}: {name} does not say its cost"
            if len(prose.split("**Cost:**")[0].split()) < 5:
                yield f"docs/methods/{page.name}: {name} does not say what it does"
        if renewed(text, registry) != text:
            yield f"docs/methods/{page.name}: not as the registry has it: run scripts/make-method-pages.py"
    for name in methods.keys() - found.keys():
        yield f"{name}: no section in docs/methods/"


def pages():
    found = sorted(PAGES.glob("*.md"))
    if not found:
        raise Wrong("docs/methods holds no page")
    return found
