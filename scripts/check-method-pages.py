#!/usr/bin/env python3
"""check-method-pages.py METHODS.json: every registered method has a section in docs/methods/ that says what it does, its
guarantee, parameters, cost and source, and names every parameter; and no section speaks of a method that is not there.
METHODS.json is what `sightline methods --json` wrote."""
import json
import pathlib
import re
import sys

registry = json.load(open(sys.argv[1], encoding="utf-8"))
methods = {}
for method in registry["methods"] + registry["device_methods"]:
    keys = methods.setdefault(method["name"], set())
    keys.update(parameter["name"] for parameter in method["parameters"])

sections = {}
for page in sorted((pathlib.Path(__file__).parent.parent / "docs" / "methods").glob("*.md")):
    for name, body in re.findall(r"^## (\S+)\n(.*?)(?=^## |\Z)", page.read_text(encoding="utf-8"), re.M | re.S):
        sections[name] = (page.name, body)

wrong = [f"{name}: no section in docs/methods/" for name in methods.keys() - sections.keys()]
wrong += [f"docs/methods/{sections[name][0]}: no method '{name}'" for name in sections.keys() - methods.keys()]
for name in methods.keys() & sections.keys():
    page, body = sections[name]
    for part in ("does", "guarantee", "parameters", "cost", "source"):
        if not re.search(rf"^- \*\*{part}\*\*: \S", body, re.M):
            wrong.append(f"docs/methods/{page}: {name} does not say its {part}")
    for key in methods[name]:
        if f"`{key}`" not in body:
            wrong.append(f"docs/methods/{page}: {name} does not name its parameter '{key}'")
print("\n".join(sorted(wrong)) or f"{len(methods)} methods have their section in docs/methods/")
sys.exit(bool(wrong))
