#!/usr/bin/env python3
"""make-method-pages.py [--check] METHODS.json: renews what docs/methods says of each method by the registry: its source,
guarantee, parameters and where it runs. METHODS.json is what `sightline methods --json` wrote. The rest of a section is
written by hand: what the method does, and what it costs. With --check it writes nothing and fails where a section is
missing, says too little, or is not as it would make it."""
import json
import sys

from figures.method_pages import complaints, forms_of, pages, renewed
from figures.results import ROOT, write_whole

*flags, file = sys.argv[1:] or [""]
if flags not in ([], ["--check"]) or not file:
    sys.exit("usage: make-method-pages.py [--check] METHODS.json")
with open(file, encoding="utf-8") as stream:
    registry = json.load(stream)
if flags:
    wrong = "\n".join(complaints(registry))
    print(wrong or f"{len(forms_of(registry))} methods have their section in docs/methods")
    sys.exit(bool(wrong))
for page in pages():
    text = page.read_text(encoding="utf-8")
    if renewed(text, registry) != text:
        write_whole(page, renewed(text, registry))
        print(f"renewed {page.relative_to(ROOT)}")
