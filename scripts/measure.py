#!/usr/bin/env python3
"""What scripts/measure.sh runs once everything is built: see there."""
import argparse
import datetime
import os
import resource
import sys
import time

from figures.results import RESULTS, Wrong, commit_now, machine_facts, slug_of, write_facts, write_topic
from figures.topics import TOPICS


def cpu_seconds():
    """Of the programs that ran so far."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main():
    parser = argparse.ArgumentParser(prog="measure.sh", description="Measures, and writes benchmarks/results/MACHINE.")
    parser.add_argument("--quick", action="store_true",
                        help="repeat less and leave out what takes minutes; rows left out stay as they are")
    parser.add_argument("topics", nargs="*", metavar="NAME", help=f"of {', '.join(TOPICS)}; default: all")
    arguments = parser.parse_args()
    unknown = [name for name in arguments.topics if name not in TOPICS]
    if unknown:
        parser.error(f"no topic '{unknown[0]}': expected {', '.join(TOPICS)}")

    facts = machine_facts() | {"load": f"{os.getloadavg()[0]:.1f}"}
    folder = RESULTS / slug_of(facts)
    today, commit = datetime.datetime.now(datetime.timezone.utc).date().isoformat(), commit_now()
    began = time.monotonic()
    for topic in arguments.topics or TOPICS:
        started, computed = time.monotonic(), cpu_seconds()
        rows = TOPICS[topic](arguments.quick)
        for row in rows:
            row.commit, row.date = commit, today
        if rows:
            write_topic(folder, topic, rows, keep_others=arguments.quick)
        print(f"{topic}: {len(rows)} rows, {time.monotonic() - started:.0f} s, {cpu_seconds() - computed:.0f} s of CPU time",
              flush=True)
    write_facts(folder, facts | {"measured": today, "commit": commit})
    print(f"{folder.relative_to(RESULTS.parent.parent)}: {time.monotonic() - began:.0f} s in all")


try:
    main()
except Wrong as wrong:
    sys.exit(f"measure.sh: {wrong}")
