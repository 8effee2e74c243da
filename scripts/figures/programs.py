"""Running what measures, and reading what it says."""
import json
import re
import subprocess
import tempfile

from figures.results import ROOT, Row, Wrong, row_of

BUILD = ROOT / "build" / "release"
UNITS = {"ns": "ns", "us": "µs", "ms": "ms", "s": "s"}


def run(*call):
    """Standard output; anything but success is the end of the measuring."""
    call = [str(part) for part in call]
    done = subprocess.run(call, capture_output=True, text=True)
    if done.returncode != 0:
        raise Wrong(f"{' '.join(call)}: exit {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def sightline(*arguments):
    return run(BUILD / "sightline", *arguments)


def google_benchmark(program, repetitions, min_time, only=".", **options):
    """Rows of one program, whose benchmarks take turns: CPU time of a call, wall time where it uses all cores."""
    said = run(BUILD / "benchmarks" / f"{program}_benchmark", f"--benchmark_filter={only}",
               f"--benchmark_repetitions={repetitions}", f"--benchmark_min_time={min_time}",
               "--benchmark_enable_random_interleaving=true", "--benchmark_format=json")
    runs = {}
    for entry in json.loads(said)["benchmarks"]:
        if entry.get("error_occurred"):
            raise Wrong(f"{program}_benchmark, {entry['name']}: {entry.get('error_message')}")
        if entry["run_type"] == "iteration":
            runs.setdefault(entry["run_name"], []).append(entry)
    if not runs:
        raise Wrong(f"{program}_benchmark has no benchmark that '{only}' names")
    return [row for name, entries in sorted(runs.items(), key=place_of)
            for row in benchmark_rows(name, entries, **options)]


def place_of(named_runs):
    """Where a benchmark stands in its program."""
    first = named_runs[1][0]
    return first["family_index"], first.get("per_family_instance_index", 0)


def benchmark_rows(name, entries, rate=None, counters=()):
    """A row for the time, or for the rate where `rate` is its unit in millions; one for each of the counters, which
    are (name, unit, factor)."""
    short_name = re.sub(r"^BM_|/(real|manual)_time$|/iterations:\d+", "", name)
    first = entries[0]
    judged = {key: first[key] for key in ("lost", "excess") if key in first}
    kept = first.get("visible")
    if kept is not None and kept >= 2:
        judged["kept"] = kept
    if rate and "items_per_second" in first:
        rows = [row_of(short_name, rate, [e["items_per_second"] / 1e6 for e in entries], **judged)]
    else:
        clock = "real_time" if name.endswith(("/real_time", "/manual_time")) else "cpu_time"
        rows = [row_of(short_name, UNITS[first["time_unit"]], [e[clock] for e in entries], **judged)]
    for counter, unit, factor in counters:
        if counter in first:
            rows.append(row_of(f"{short_name}/{counter.strip('_%')}", unit, [e[counter] * factor for e in entries]))
    return rows


def compare(scene, methods, key=None, **options):
    """Rows of `sightline compare`: a view's mean over the path, with its mean least and greatest over the repeats, for
    what each method took to cull, and for its frames where a device drew them; beside what was kept and lost."""
    options.setdefault("device", "cpu")
    with tempfile.NamedTemporaryFile(suffix=".json") as file:
        arguments = [f"--{name}={value}" for name, value in options.items() if value is not True]
        flags = [f"--{name}" for name, value in options.items() if value is True]
        sightline("compare", scene, f"--methods={methods}", f"--json={file.name}", *arguments, *flags)
        document = json.load(open(file.name, encoding="utf-8"))
    by_method = {}
    for line in document["rows"]:
        by_method.setdefault(line["method"].strip("()"), []).append(line)
    drawn = document["device"] != "cpu"
    return [row for method, lines in by_method.items() for row in method_rows(f"{key or scene}/{method}", lines, drawn)]


def reproduced(paper, *arguments):
    """The document that `sightline reproduce` writes of a paper."""
    with tempfile.NamedTemporaryFile(suffix=".json") as file:
        sightline("reproduce", paper, f"--json={file.name}", *arguments)
        return json.load(open(file.name, encoding="utf-8"))


def table_of(document, name):
    """The lines of a reproduction's table of that name, or of the first of a section: [{column: cell}, …]."""
    for table in document["tables"]:
        if table["name"] == name:
            return table["rows"]
    for section in document["sections"]:
        if section["name"] == name:
            table = section["tables"][0]
            return [dict(zip(table["header"], row)) for row in table["rows"]]
    raise Wrong(f"the reproduction has no '{name}'")


def method_rows(name, lines, drawn):
    def mean(field):
        return sum(line[field] for line in lines) / len(lines)

    def total(field):
        return sum(line[field] for line in lines)

    def timed(what, field):
        benchmark, _, case = name.partition("/")
        return Row(benchmark, f"{case}/{what}", "ms", mean(field), mean(field + "_min"), mean(field + "_max"),
                   len(lines), kept=mean("visible"), lost=total("lost_objects"), lost_pixels=total("lost_pixels"),
                   excess=mean("excess_objects"))

    def counted(what, unit, field):
        benchmark, _, case = name.partition("/")
        return Row(benchmark, f"{case}/{what}", unit, mean(field), None, None, len(lines))

    rows = [timed("cull", "cull_cpu_ms")]
    if drawn:
        if any(line["cull_gpu_ms"] for line in lines):
            rows.append(timed("cull-gpu", "cull_gpu_ms"))
        rows.append(timed("frame", "frame_ms"))
    if any(line["cull_vertices"] for line in lines):
        rows.append(counted("vertices", "vertices", "cull_vertices"))
    if any(line["tested"] for line in lines):
        rows.append(counted("tested", "objects", "tested"))
    return rows + [counted("calls", "calls", "draw_calls"), counted("triangles", "triangles", "triangles"),
                   counted("visible", "objects", "truly_visible")]


def tables(text):
    """The tables that the command line prints: [{column: cell}, …] each. A rule under the header says how wide each
    column is."""
    lines, found = text.splitlines(), []
    for at, line in enumerate(lines):
        if not re.fullmatch(r"─+(  ─+)*", line):
            continue
        spans = [match.span() for match in re.finditer("─+", line)]
        header = [lines[at - 1][begin:end].strip() for begin, end in spans]
        table = []
        for body in lines[at + 1:]:
            if not body.strip():
                break
            table.append(dict(zip(header, (body[begin:end].strip() for begin, end in spans))))
        found.append(table)
    return found


def number(cell):
    """A cell's first number: "1,371", "11.56 %", "0.342 [0.198–20.4]"."""
    match = re.match(r"-?[\d,]*\.?\d+", cell)
    if not match:
        raise Wrong(f"expected a number, not '{cell}'")
    return float(match.group().replace(",", ""))
