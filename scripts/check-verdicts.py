#!/usr/bin/env python3
"""check-verdicts.py BUILD: a verdict is worth something if it comes out again. Compares methods twice on the tests' scenes,
drawn on the Vulkan device at hand, the second time in another order; the winner that the first run names takes at most
3 % more a frame in the second than the quickest there."""

import json
import random
import re
import subprocess
import sys
import tempfile

SCENES = ["world:regular?columns=40&rows=40&detail=1", "world:irregular?spheres=1000&size=60&detail=1",
          "world:city?objects=2000", "world:forest?trees=600&size=150"]
SAFE = {"exact", "conservative"}
MOST = 1.03
BUILD = sys.argv[1]


def compare(scene, methods=None):
    """What is printed, and the rows."""
    with tempfile.NamedTemporaryFile(suffix=".json") as file:
        command = [f"{BUILD}/sightline", "compare", scene, "--device", "any", "--size", "640x360", "--frames", "8",
                   "--json", file.name] + (["--methods", ",".join(methods)] if methods else [])
        text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        return text, json.load(open(file.name, encoding="utf-8"))["rows"]


def frames(rows):
    """Milliseconds a frame, the mean over the views, of each method that lost nothing and promised so."""
    of = {}
    for row in rows:
        of.setdefault(row["method"], []).append(row)
    return {method: sum(row["frame_ms"] for row in all_of) / len(all_of) for method, all_of in of.items()
            if all_of[0]["guarantee"] in SAFE and all(row["lost_objects"] == 0 for row in all_of)}


def main():
    failed = 0
    for scene in SCENES:
        text, rows = compare(scene)
        named = re.search(r"^Quickest on [^:]*(?:\([^)]*\))?[^:]*: (.+?), [0-9]", text, re.M)
        if not named:
            raise SystemExit(f"{scene}: no winner is named:\n{text}")
        winner = named.group(1).split(" and ")[0]
        methods = sorted({row["method"] for row in rows})
        random.Random(7).shuffle(methods)
        again = frames(compare(scene, methods)[1])
        ratio = again[winner] / min(again.values())
        good = ratio <= MOST
        failed += not good
        print(f"{scene}: {named.group(1)}; again {winner} takes {ratio:.3f} times the quickest, {min(again, key=again.get)}"
              + ("" if good else f": expected at most {MOST}"))
    return 1 if failed else 0


sys.exit(main())
