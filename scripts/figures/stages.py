"""Where the time of drawing a mesh of occluders goes: a profile by function, as stages."""
import re
import subprocess
import tempfile

from figures.programs import BUILD
from figures.results import Row, Wrong

# What each stage's functions are called; the first that matches has it.
STAGES = (("groups-in-view", r"find_groups|sort_by_high_bits"),
          ("groups-hidden", r"query_all_boxes|query_boxes"),
          ("spans", r"list_polygon|draw_with_margin|inset_piece"),
          ("pixels", r"draw_listed"),
          ("near-plane", r"draw_cut|draw_convex|[^a-z_]clip|clipped|exact_corners"),
          ("set-up", r"sightline::occlusion::"),
          ("begin", r"OcclusionBuffer::begin|memset"))


def shares(*call):
    """What part of a program's drawing each stage takes, as the processor's clock finds it there."""
    with tempfile.NamedTemporaryFile(suffix=".data") as file:
        try:
            done = subprocess.run(["perf", "record", "-q", "-e", "cpu-clock", "-F", "2000", "-o", file.name, "--",
                                   *map(str, call)], capture_output=True, text=True)
            said = subprocess.run(["perf", "report", "-i", file.name, "--no-children", "--stdio", "-F", "overhead,symbol"],
                                  capture_output=True, text=True).stdout
        except FileNotFoundError:
            raise Wrong("no perf: expected the package linux-perf") from None
    found = dict.fromkeys((name for name, _ in STAGES), 0.0)
    for share, symbol in re.findall(r"^ *([\d.]+)% +\[.\] (.+?) *$", said, re.MULTILINE):
        stage = next((name for name, functions in STAGES if re.search(functions, symbol)), None)
        if stage:
            found[stage] += float(share)
    total = sum(found.values())
    if done.returncode != 0 or total < 50:
        raise Wrong(f"perf record {call[0]}: expected a profile of what it draws, found {total:.0f} % of one\n"
                    f"{done.stderr[-500:]}")
    return {name: share / total for name, share in found.items()}


def nominal_megahertz():
    for line in open("/proc/cpuinfo", encoding="utf-8"):
        if line.startswith("cpu MHz"):
            return float(line.split(":")[1])
    raise Wrong("/proc/cpuinfo names no clock")


def stage_rows(scene, timed, work):
    """Cycles of the clock that /proc/cpuinfo names: of each stage for a triangle that is set up and for a tile that is
    looked at. `timed` is the time of a view, `work` the counts of both."""
    parts = shares(BUILD / "benchmarks" / "occluder_meshes_benchmark", scene, "--two-sided", "--draw=600")
    cycles = 1000 * nominal_megahertz() * timed.median
    return [Row(timed.benchmark, f"stage/{name}/{each}", "cycles", share * cycles / work[each])
            for name, share in (*parts.items(), ("all", 1.0)) for each in work]
