#!/usr/bin/env python3
"""make-method-pages.py METHODS.json: renews what docs/methods says of each method by the registry: its source, guarantee,
parameters and where it runs. METHODS.json is what `sightline methods --json` wrote. The rest of a section is written by
hand: what the method does, and what it costs."""
import json
import sys

from figures.method_pages import pages, renewed
from figures.results import ROOT, write_whole

if len(sys.argv) != 2:
    sys.exit("usage: make-method-pages.py METHODS.json")
with open(sys.argv[1], encoding="utf-8") as file:
    registry = json.load(file)
for page in pages():
    text = page.read_text(encoding="utf-8")
    if renewed(text, registry) != text:
        write_whole(page, renewed(text, registry))
        print(f"renewed {page.relative_to(ROOT)}")
