"""The files of benchmarks/results: one folder a machine, one CSV a topic, one row a figure."""
import csv
import dataclasses
import io
import os
import pathlib
import platform
import re
import statistics
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
RESULTS = ROOT / "benchmarks" / "results"
COLUMNS = ("benchmark", "case", "unit", "median", "min", "max", "repetitions", "beside", "ratio",
           "kept", "lost", "lost_pixels", "excess", "commit", "date")
SECONDS = {"ns": 1e-9, "µs": 1e-6, "ms": 1e-3, "s": 1}


class Wrong(Exception):
    """What a reader of the message can mend."""


@dataclasses.dataclass
class Row:
    """A figure. `beside` names the row that `ratio` compares it with: this median / that one's. What was kept, lost and
    kept in excess counts objects and pixels of the answer that was timed; empty where nobody judged."""
    benchmark: str
    case: str
    unit: str
    median: float
    min: float | None = None
    max: float | None = None
    repetitions: int = 1
    beside: str = ""
    ratio: float | None = None
    kept: float | None = None
    lost: float | None = None
    lost_pixels: float | None = None
    excess: float | None = None
    commit: str = ""
    date: str = ""

    @property
    def id(self):
        return f"{self.benchmark}/{self.case}" if self.case else self.benchmark


def row_of(name, unit, values, repetitions=None, **more):
    """A row of several measured values; `name` is benchmark/case."""
    benchmark, _, case = name.partition("/")
    return Row(benchmark, case, unit, statistics.median(values), min(values), max(values),
               repetitions or len(values), **more)


def compare_with(rows, beside):
    """Names for each row of `beside` the one that it is compared with; a function of an id, or a dictionary."""
    find = beside.get if isinstance(beside, dict) else beside
    by_id = {row.id: row for row in rows}
    for row in rows:
        other = by_id.get(find(row.id) or "")
        if other and other is not row and other.median:
            unit = SECONDS.get(row.unit, 1) / SECONDS.get(other.unit, 1)
            row.beside, row.ratio = other.id, unit * row.median / other.median
    return rows


def short(number):
    """Four significant digits, whole numbers whole, and no exponent."""
    if number is None or number == "":
        return ""
    if isinstance(number, str):
        return number
    if number == int(number) and abs(number) < 1e15:
        return str(int(number))
    digits = max(0, 3 - int(f"{number:e}".split("e")[1]))
    text = f"{number:.{digits}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def machine_facts():
    """What the figures depend on; compilers and drivers as they are now."""
    cpu, flags = platform.processor() or "processor", ""
    for line in open("/proc/cpuinfo", encoding="utf-8", errors="replace"):
        key, _, value = (part.strip() for part in line.partition(":"))
        cpu = value if key == "model name" else cpu
        flags = value if key == "flags" else flags
    lanes = next((name for name in ("avx512bw", "avx2", "sse4_1") if name in flags.split()), "")
    widest = {"avx512bw": "avx-512", "avx2": "avx2", "sse4_1": "sse4"}.get(lanes, platform.machine())
    memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") / 2**30
    system = next((line.split("=", 1)[1].strip().strip('"') for line in open("/etc/os-release", encoding="utf-8")
                   if line.startswith("PRETTY_NAME=")), platform.system())
    compiler = subprocess.run(["g++", "-dumpfullversion"], capture_output=True, text=True).stdout.strip()
    return {"processor": cpu, "simd": widest, "cores": str(os.cpu_count()), "memory": f"{memory:.0f} GiB",
            "system": system, "compiler": f"g++ {compiler}"}


def slug_of(facts):
    """A folder's name: processor, widest SIMD (virtual machines name processors vaguely) and cores."""
    name = re.sub(r"\((r|tm)\)|\bcpu\b|@.*", "", facts["processor"], flags=re.I)
    return re.sub(r"[^a-z0-9]+", "-", f"{name} {facts['simd']} {facts['cores']} cores".lower()).strip("-")


def commit_now():
    """The commit that is measured, marked where sources differ from it."""
    def git(*call):
        return subprocess.run(["git", *call], cwd=ROOT, capture_output=True, text=True).stdout.strip()
    changed = git("status", "--porcelain", "--untracked-files=no", "--", "include", "library", "workbench", "apps",
                  "benchmarks", "cmake", "CMakeLists.txt", ":!benchmarks/results")
    return git("rev-parse", "--short=9", "HEAD") + ("-changed" if changed else "")


def write_whole(file, text):
    """Under a temporary name first, so that no half a file is ever found."""
    file.parent.mkdir(parents=True, exist_ok=True)
    temporary = file.with_name(file.name + ".tmp")
    temporary.write_text(text, encoding="utf-8")
    temporary.replace(file)


def write_topic(folder, topic, rows, keep_others):
    """Writes a topic's file; with keep_others, rows that were not measured now stay as they are."""
    file = folder / f"{topic}.csv"
    if keep_others and file.exists():
        new = {row.id: row for row in rows}
        old = read_topic(file)
        rows = [new.pop(row.id, row) for row in old] + list(new.values())
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for row in rows:
        writer.writerow([short(getattr(row, column)) for column in COLUMNS])
    write_whole(file, text.getvalue())


def read_topic(file):
    """The rows of one file, numbers as numbers."""
    rows = []
    with open(file, encoding="utf-8", newline="") as stream:
        reader = csv.DictReader(stream)
        if tuple(reader.fieldnames or ()) != COLUMNS:
            raise Wrong(f"{file}: expected the columns {','.join(COLUMNS)}")
        for line in reader:
            values = {key: line[key] for key in ("benchmark", "case", "unit", "beside", "commit", "date")}
            for key in COLUMNS:
                if key not in values:
                    values[key] = float(line[key]) if line[key] else None
            rows.append(Row(**values))
    return rows


def read_facts(folder):
    with open(folder / "machine.csv", encoding="utf-8", newline="") as stream:
        return dict(csv.reader(stream))


def write_facts(folder, facts):
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(facts.items())
    write_whole(folder / "machine.csv", text.getvalue())


def page_machine():
    """The folder that documents quote: the one measured last of those that hold all topics."""
    topics = {file.name for file in RESULTS.glob("*/*.csv")}
    folders = [folder for folder in RESULTS.iterdir()
               if folder.is_dir() and all((folder / topic).exists() for topic in topics)]
    if not folders:
        raise Wrong("benchmarks/results holds no machine with all topics: run scripts/measure.sh")
    return max(folders, key=lambda folder: (read_facts(folder).get("measured", ""), folder.name))


def read_all(folder):
    """{topic: {id: row}}"""
    topics = {}
    for file in sorted(folder.glob("*.csv")):
        if file.name != "machine.csv":
            topics[file.stem] = {row.id: row for row in read_topic(file)}
    return topics
