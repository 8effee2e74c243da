"""What is measured, topic by topic: each function gives the rows of one CSV. `quick` repeats less and leaves out what
takes minutes."""
import dataclasses
import os
import re
import tempfile
import time

from figures.programs import (BUILD, compare, google_benchmark, number, reproduced, run, sightline, table_of,
                              tables)
from figures.results import ROOT, Row, Wrong, compare_with, read_topic, row_of
from figures.stages import stage_rows

LEVEL = "pak1-maps.pk3:maps/{}.bsp"


def repeats(quick):
    return {"repetitions": 3, "min_time": 0.01 if quick else 0.1}


def world(quick):
    """One world and its peers on the same million boxes; views at once; sectors far apart."""
    only = "-^(build|move_|columns/|far_sectors/move" + ("|openscenegraph/d|.*/10000000)" if quick else ")")
    rows = google_benchmark("world", 3 if quick else 11, 0.02 if quick else 0.1, only)
    return compare_with(rows, lambda name: None if name in ("far_sectors/cull", "one_view") else
                        "one_view" if name.startswith("four_views") else "world/1000000")


def columns(quick):
    """Layers, distances and levels of a million boxes beside a world that has none: where a chunk's objects have the same,
    and where each has its own; there also what each visible object costs more, in turns with the plain cull."""
    rows = google_benchmark("world", 3 if quick else 21, 0.02 if quick else 0.1, "^columns/")
    plain = next(row for row in rows if row.id == "columns/none")
    whole = ("columns/whole_layers", "columns/whole")
    compare_with(rows, lambda name: plain.id if name in whole else None)
    return rows + [more_each(row, plain) for row in rows if "random" in row.case or "levels" in row.case]


def more_each(row, plain):
    """Nanoseconds that a visible object costs more than in the plain cull: by the medians, and by the quickest of both,
    which is the machine's own where neighbours share its cores."""
    def each(time, plain_time):
        return 1000 * (time - plain_time) / row.kept
    return Row("more", row.case, "ns", each(row.median, plain.median), each(row.min, plain.min),
               repetitions=row.repetitions, beside=plain.id)


def moving(quick):
    """A world that moves beside flat arrays: means over 600 frames, or 60, and the world's slowest frame."""
    rows = google_benchmark("movers", 1, 0.01, f"^{'short' if quick else 'movers'}/")
    return compare_with(rows, lambda name: name.removesuffix("world") + "flat" if name.endswith("/world") else
                        name.removesuffix("worst_frame") + "world" if name.endswith("/worst_frame") else None)


def forms(quick):
    """The same out of structs that have a centre and a half size; the flat arrays are given minima and maxima."""
    rows = google_benchmark("movers", 1, 0.01, f"^{'short_' if quick else ''}forms/")
    return compare_with([row for row in rows if not row.case.endswith("/worst_frame")],
                        lambda name: name.removesuffix("world") + "flat" if name.endswith("/world") else None)


def instances(quick):
    """10⁹ objects in instances of worlds beside a plain world of those that a view may see."""
    rows = google_benchmark("instances", 3, 0.02 if quick else 0.2, counters=(("GiB", "GiB", 1),))
    return compare_with(rows, {f"instances/{form}": f"plain/{form}" for form in ("quarters", "turned")})


def snapshots(quick):
    """The first view of ten million boxes out of a mapped file, and a flight over a hundred million within a budget; the
    latter takes 11 GiB and some minutes, so not in a quick run."""
    rows = google_benchmark("snapshots", 3 if quick else 9, 0.01, "first_view", counters=(
        ("open_ms", "ms", 1), ("sectors", "sectors", 1), ("loaded", "objects", 1)))
    return rows if quick else rows + google_benchmark("snapshots", 1, 0.01, "flight", counters=(
        ("open_ms", "ms", 1), ("budget_MiB", "MiB", 1), ("most_MiB", "MiB", 1), ("grown_MiB", "MiB", 1),
        ("frames", "frames", 1), ("complete", "frames", 1), ("missed", "objects", 1), ("checked", "frames", 1),
        ("update_p99_ms", "ms", 1), ("update_worst_ms", "ms", 1)))


def ranges(quick):
    """What is seen of a million boxes as ranges of their order beside the same as ids."""
    rows = google_benchmark("ranges", 3 if quick else 21, 0.02 if quick else 0.1)
    return compare_with(rows, lambda name: name.replace(name.split("/")[0], "ids")
                        if name.startswith(("ranges/", "whole_chunks/")) else None)


def movers(quick):
    """What moves: a world's boxes, the chunks of the raster methods, a scene's objects under each method."""
    rows = google_benchmark("world", 3, 0.02, "^(build|move_|far_sectors/move)")
    rows += google_benchmark("chunk_map", 3, 0.02)
    anew = {"move_a_tenth": "build", "build_from_structs": "build", "move_all_from_structs": "move_all"}
    compare_with(rows, lambda name: "rebuild" if name.startswith("move_objects") else anew.get(name))
    scene = compare("world:irregular", "vfc-vc,grid-cell,object-frustum,masked,wide-rays", "irregular", moving=0.1,
                    frames=2 if quick else 6)
    return rows + [row for row in scene if row.case.endswith("/cull")]


def frustum(quick):
    """Flat arrays, and the paper on a grid of cells."""
    rows = google_benchmark("frustum_cull", **repeats(quick))
    sizes = [10**n for n in range(4, 8)]
    pairs = [("FlatSimd", "BareRead"), ("ScalarLoop", "FlatSimd")]
    pairs += [(f"PlainLoop{form}", "FlatSimd") for form in ("", "Out1", "Out2", "Out4")]
    compare_with(rows, {f"{mine}{ids}/{n}": f"{other}{ids}/{n}" for n in sizes for ids in ("", "Coherent")
                        for mine, other in pairs})
    paper = []
    for row in compare("world:forest", "grid-cell,object-frustum", "forest", frames=3 if quick else 10):
        method, what = row.case.split("/")
        if what == "cull":
            paper.append(Row("forest", method, "ms", row.median, row.min, row.max, row.repetitions, kept=row.kept,
                             lost=row.lost, lost_pixels=row.lost_pixels, excess=row.excess))
            paper.append(Row("forest-kept", method, "objects", row.kept, repetitions=row.repetitions))
        elif what == "tested":
            paper.append(Row("forest-tested", method, "%", 100 * row.median / 30000, repetitions=row.repetitions))
    return rows + compare_with(paper, {"forest/grid-cell": "forest/object-frustum",
                                       "forest-kept/grid-cell": "forest-kept/object-frustum"})


def occlusion(quick):
    """The depth buffer by itself."""
    rows = google_benchmark("occlusion", only="^draw", rate="M triangles/s", **repeats(quick))
    return rows + google_benchmark("occlusion", only="^query", rate="M boxes/s",
                                   counters=(("excess_%", "%", 1),), **repeats(quick))


def drawn_meshes(key, scene, quick, *arguments):
    """A scene's triangles drawn as one occluder, its fronts and both sides: ours at every place of a pixel, at half
    resolution and by two threads, and who is named as a peer, beside ours."""
    rows = []
    for sides in ((), ("--two-sided",)):
        with tempfile.NamedTemporaryFile(suffix=".csv") as file:
            run(BUILD / "benchmarks" / "occluder_meshes_benchmark", scene, f"--rounds={3 if quick else 11}", "--threads=2",
                f"--csv={file.name}", f"--name={key}", *sides, *arguments)
            rows += read_topic(file.name)
    timed = {row.id for row in rows if row.unit == "ms"}
    return compare_with(rows, lambda name: name[:name.rindex("/")] + "/sightline" if name in timed else None)


def meshes(quick):
    """Levels drawn as one occluder, and by stages what that takes."""
    rows = []
    for key in ("oa_dm4", "ctf_inyard"):
        its = drawn_meshes(key, LEVEL.format(key), quick)
        by_id = {row.id: row for row in its}
        work = {what: by_id[f"{key}/both/{what}s"].median for what in ("triangle", "tile")}
        rows += its + stage_rows(LEVEL.format(key), by_id[f"{key}/both/sightline"], work)
    return rows


def peers(quick):
    """The same beside peers, which the tree does not have: SIGHTLINE_PEERS names shared libraries with the functions of
    benchmarks/peer.h, SIGHTLINE_CASTLE a file of Intel's castle. Without them what was measured stays."""
    given = [file for file in os.environ.get("SIGHTLINE_PEERS", "").split(":") if file]
    if not given:
        return []
    named = [f"--peer={file}" for file in given]
    rows = []
    if castle := os.environ.get("SIGHTLINE_CASTLE"):
        look = "--look=27,2,47,27.1426,2.0611,46.0121"
        rows += drawn_meshes("castle", castle, quick, look, *named)
        rows += drawn_meshes("castle-8", castle, quick, look, "--headings=8", *named)
    for key in ("oa_dm4", "ctf_inyard"):
        rows += drawn_meshes(key, LEVEL.format(key), quick, *named)
    return rows


def fastest(rows, forms, name):
    """A row for each case of the fastest of several benchmarks: those that `forms` matches, told apart by what `name`
    makes of the match."""
    best = {}
    for row in rows:
        if re.fullmatch(forms, row.benchmark):
            key = re.sub(forms, name, row.benchmark), row.case
            best[key] = min(best.get(key, row), row, key=lambda one: one.median)
    return [dataclasses.replace(row, benchmark=benchmark) for (benchmark, _), row in best.items()]


def rays(quick):
    """Rays at boxes beside Embree, the paper's five ways, and rays at triangles."""
    rows = google_benchmark("ray_cast", **repeats(quick))
    rows += fastest(rows, r"Embree(?:Stream)?\d+(?:Robust)?(Avx2)?(Random)?", r"EmbreeUserGeometry\1\2")
    # Beside our own with the same rays and the same vectors.
    compare_with(rows, lambda name: re.sub("^.*?(Avx2)?(Random)?/", r"WideRays\1\2/", name))
    if quick:
        return rows
    said = reproduced("ray-pvs", "--quick")
    guided, triangles = table_of(said, "beyond the paper: guided rays"), table_of(said, "beyond the paper: triangles")
    for line, loss in zip(table_of(said, "table 6, ready"), table_of(said, "figure 12a")):
        model = f"strata-{line['model']}"
        judged = {"kept": number(loss["in the PVS"]), "lost": number(loss["lost objects"]),
                  "lost_pixels": number(loss["lost pixels"])}
        timed = [Row(model, method.removesuffix(" ms").replace(" ", "-"), "ms", cell["ours"], repetitions=2, **judged)
                 for method, cell in line["cells"].items()]
        rows += compare_with(timed, lambda name: name.split("/")[0] + "/boca")
        rows.append(Row(model, "lost-share", "%", number(loss["share"])))
    ratios = [number(line["ratio"]) for line in table_of(said, "figure 13")]
    rows.append(row_of("strata-4/figure-13-ratio", "×", ratios))
    for line, by_grid in zip(guided, triangles):
        scene = re.sub(r"^world:|\?model=", lambda m: "-" if m.group() == "?model=" else "", line["scene"])
        scene = re.sub(r".*/(\w+)\.bsp$", r"\1", scene)
        views = int(number(line["views"]))
        rows.append(Row(scene, "guided", "ms", number(line["ms a view"]), repetitions=views,
                        lost_pixels=number(line["lost pixels"])))
        rows.append(Row(scene, "guided-worst-share", "%", number(line["worst view"]), repetitions=views))
        rows.append(Row(scene, "guided-rays", "rays", number(line["rays a view"]), repetitions=views))
        rows.append(Row(scene, "triangle-pvs-lost-with-a-block", "objects",
                        number(by_grid["with a whole 13x7 block"]), repetitions=views))
    return rows + [row_of("all/guided-worst-share", "%", [number(line["worst view"]) for line in guided])]


def verified(key, scene, views, *arguments):
    """Rows of `sightline verify`: what was lost over so many random views."""
    lines = tables(sightline("verify", scene, f"--views={views}", *arguments))[0]
    return [Row(key, f"{line['method']}/verified", "views", views, repetitions=1, kept=number(line["kept"]),
                lost=number(line["lost objects"]), lost_pixels=number(line["lost pixels"]),
                excess=number(line["excess objs"])) for line in lines]


# Along whole walks, where one object in fifty is visible.
WALKS = ("czest2ctf", "czest3ctf", "ctf_inyard")
RASTER = "vfc-vc,roc,hroc,hroc?leaf=boxes,ioc,ihzb,vertex-chunk,resident-chunk,hiz,masked"


def near_view(key, scene):
    """Occlusion on a device in one view near the ground, each method beside vertex-chunk."""
    view = compare(scene, RASTER, key, device="any", size="640x360", path="near", frames=1)
    return compare_with(view, lambda name: re.sub("/[^/]*/", "/vertex-chunk/", name)
                        if name.endswith(("/frame", "/cull-gpu", "/vertices")) else None)


def scenes(quick):
    """Methods on scenes: culled on the CPU, drawn by lavapipe, judged by the oracle."""
    rows = compare(LEVEL.format("oasago2"), "none,vfc-vc,grid-cell,object-frustum,masked,wide-rays,guided,level-pvs",
                   "oasago2", frames=3 if quick else 12)
    rows += compare("world:irregular", "none,vfc-vc,grid-cell,object-frustum,masked", "irregular",
                    frames=2 if quick else 6)
    compare_with(rows, lambda name: name.split("/")[0] + "/masked/cull" if name.endswith("/cull") else None)
    for level in WALKS:
        walk = compare(LEVEL.format(level), "vfc-vc,masked", level, device="any", size="320x180", limit=True,
                       frames=6 if quick else 24)
        rows += compare_with(walk, lambda name: level + "/masked/frame" if name.endswith("/frame") else None)
    for name in ("regular", "irregular"):
        rows += near_view(f"{name}-near", f"world:{name}?detail=2")
        rows += near_view(f"{name}-120000-near", f"world:{name}?spheres=120000&detail=0")
    views = 40 if quick else 300
    for key, scene in (("oasago2", LEVEL.format("oasago2")), ("irregular", "world:irregular"),
                       ("forest", "world:forest?trees=3000&size=300")):
        rows += verified(key, scene, views)
    return rows + verified("irregular-drawn", "world:irregular?detail=1", 5 if quick else 40, "--device=any",
                           "--methods=roc,hroc,ioc,ihzb,vertex-chunk,resident-chunk,hiz", "--moving=0.1")


def kept_beside_seen(rows, case, key):
    """With what `world` keeps and what of it is seen, as rows of their own."""
    for row in [row for row in rows if row.case == case]:
        rows.append(Row(f"{key}-kept", "world", "objects", row.kept, repetitions=row.repetitions))
        rows.append(Row(f"{key}-kept", "seen", "objects", row.kept - row.excess, repetitions=row.repetitions))
    return rows


def automatic(quick):
    """Occlusion in one call: 100,000 objects of a city at street level, culled on one thread; for every place of the
    image, too; and frames along walks through levels."""
    city = compare("world:city?objects=100000", "vfc-vc,masked,world", "city-100000", size="1280x720", path="near",
                   frames=4 if quick else 12)
    rows = kept_beside_seen(city, "world/cull", "city-100000")
    rows = compare_with(rows, lambda name: "city-100000/vfc-vc/cull" if name.endswith("/cull") else
                        "city-100000-kept/seen" if name == "city-100000-kept/world" else None)
    for level in ("oasago2", "czest2ctf", "ctf_inyard"):
        walk = compare(LEVEL.format(level), "vfc-vc,masked,world,world?coverage=area", level, size="320x180", path="walk",
                       device="any", limit=True, frames=6 if quick else 16)
        rows += compare_with(walk, lambda name, level=level: f"{level}/masked/frame" if name.endswith("/frame") else None)
    # On a large image, where walls near the eye cover much of it.
    for level in ("oasago2", "ctf_inyard"):
        key = f"{level}-1280x720"
        walk = compare(LEVEL.format(level), "masked,world", key, size="1280x720", path="walk", device="any",
                       frames=6 if quick else 16)
        walk = kept_beside_seen(walk, "world/frame", key)
        rows += compare_with(walk, lambda name, key=key: f"{key}/masked/frame" if name.endswith("/frame") else
                             f"{key}-kept/seen" if name == f"{key}-kept/world" else None)
    return rows


def surfaces(quick):
    """What is lost where cut-outs and backs that are not drawn are taken for solid, and where they are not."""
    views = 60 if quick else 300
    rows = []
    for key, scene in (("islandctf", LEVEL.format("islandctf")), ("foliage", "world:foliage"),
                       ("city", "world:city?objects=3000")):
        rows += verified(key, scene, views, "--methods=masked,masked?solid=all")
    return rows


def shadows(quick):
    """Shadow casters that are drawn, beside all in the lights' frustums, and the pixels of lit pictures that change for it."""
    views = 60 if quick else 300
    rows = []
    for key, scene in (("city", "world:city"), ("foliage", "world:foliage"), ("oasago2", LEVEL.format("oasago2")),
                       ("ctf_inyard", LEVEL.format("ctf_inyard"))):
        for light in ("directional", "spot"):
            said = sightline("casters", scene, "--light", light, f"--views={views}", "--seed=7")
            count = {words: number(found) for words, found in re.findall(r"^(\S.*?)  +(\d+)", said, re.MULTILINE)}
            looked = int(re.search(r": (\d+) random views", said)[1])
            all_casters = count["casters in the lights' frustums"] / looked
            rows.append(Row(key, f"{light}/views", "views", looked))
            rows.append(Row(key, f"{light}/in-light", "objects", all_casters, repetitions=looked))
            for case, words in (("towards", "towards what the cameras see"), ("kept", "with a shadow on what is visible")):
                rows.append(Row(key, f"{light}/{case}", "objects", count[words] / looked, repetitions=looked,
                                beside=f"{key}/{light}/in-light", ratio=count[words] / looked / all_casters,
                                lost_pixels=count["pixels that dropped casters change"] if case == "kept" else None))
    return rows


def draw_calls(quick):
    """The paper's walks through three levels: ratios of simple to drawcall-wise at height 4, calls of both at every
    height as printed and by rules of ours, and what adaptive's frames cost beside the quickest method's. Many minutes
    long, so not in a quick run."""
    if quick:
        return []
    said = reproduced("draw-calls")
    rows = []
    for line in table_of(said, "text: simple against drawcall-wise"):
        if line["height"] != "4":
            continue
        level, structure = line["level"], line["structure"]
        small = next(key for key in line if key.startswith("frame at"))
        for what, column in (("calls", "calls"), ("small-frame", small), ("frame", "frame"), ("record", "CPU")):
            rows.append(Row(level, f"simple-to-wise/{structure}/{what}", "×", number(line[column])))
        rows.append(Row(level, f"zhang-to-wise/{structure}/triangles", "×", number(line["triangles zhang / wise"])))
    for line in table_of(said, "text: structures"):
        case = f"{line['structure']}/{line['rules']}/height-{line['height']}"
        for method, column in (("simple", "simple's calls"), ("drawcall-wise", "drawcall-wise's")):
            rows.append(Row(line["level"], f"calls-of-{method}/{case}", "calls", number(line[column])))
        rows.append(Row(line["level"], f"calls-simple-to-wise/{case}", "×", number(line["ratio"])))
    for line in table_of(said, "beyond the paper, by level"):
        for what, unit, column in (("adaptive-to-quickest/frame", "×", "adaptive / quickest"),
                                   ("adaptive/learning", "frames", "after frames"),
                                   ("cone-to-zhang-octree/triangles", "×",
                                    "triangles cluster-cone / zhang-octree, tight")):
            rows.append(Row(line["level"], what, unit, number(line[column])))
    if not rows:
        raise Wrong("reproduce draw-calls named no level")
    return rows + extremes(rows)


def extremes(rows):
    """What holds on all levels: a row for each case, with the median, least and greatest over the levels, and one
    over all structures."""
    cases = {}
    for row in rows:
        cases.setdefault(row.case, []).append(row)
        merged = re.sub(r"/(grid|octree|kd-tree)/", "/", row.case)
        if merged != row.case:
            cases.setdefault(merged, []).append(row)
    return [row_of(f"all/{case}", some[0].unit, [row.median for row in some]) for case, some in cases.items()]


def bake(quick):
    """Visible sets of a level, baked and checked. Minutes long, so not in a quick run."""
    if quick:
        return []
    file = BUILD / "measured.pvs"
    file.unlink(missing_ok=True)
    began = time.monotonic()
    said = sightline("bake", LEVEL.format("oa_dm1"), f"--output={file}", "--check=1000")
    seconds = time.monotonic() - began
    size, share, raw = re.search(r"(\d+) bytes, ([\d.]+) times the open cells' raw bit matrix \((\d+) bytes\)",
                                 said).groups()
    views, pixels, percent = re.search(r"(\d+) random views .*: (\d+) of \d+ pixels lost \(([\d.]+) %\)",
                                       said).groups()
    file.unlink()
    return [Row("oa_dm1", "bake-and-check", "s", seconds),
            Row("oa_dm1", "raw", "bytes", float(raw)),
            Row("oa_dm1", "file", "bytes", float(size), beside="oa_dm1/raw", ratio=float(share)),
            Row("oa_dm1", "lost-share", "%", float(percent), repetitions=int(views), lost_pixels=float(pixels))]


def large(quick):
    """20 million triangles in cells: what they take to build, to hold, to cull, and to move one object of; a hundred million
    boxes beside the million of them that are near the view. Minutes long, so not in a quick run."""
    if quick:
        return []
    rows = google_benchmark("draw_calls", 1, 0.5, "zhang-octree", counters=(
        ("method_GiB", "GiB", 1), ("peak_GiB_with_scene", "GiB", 1)))
    boxes = google_benchmark("large_world", 5, 0.1, counters=(("GiB", "GiB", 1), ("peak_GiB", "GiB", 1)))
    return rows + compare_with(boxes, {"hundred_million": "one_million"})


_built = {}


def built(quick):
    """Structures over a million boxes, for two topics; measured once."""
    if quick not in _built:
        rows = google_benchmark("startup", 3, 0.02, "-^bullet" if quick else ".", counters=(("bytes_each", "bytes", 1),))
        _built[quick] = compare_with(rows, {"bullet_dbvt": "world", "bullet_dbvt/bytes_each": "world/bytes_each",
                                            "embree": "box_bvh"})
    return _built[quick]


def of_unit(rows, units):
    return [row for row in rows if row.unit in units]


def memory(quick):
    """What structures over a million boxes hold."""
    return of_unit(built(quick), ("bytes",))


def startup(quick):
    """Until the first frame: structures over a million boxes, the command, a level."""
    rows = of_unit(built(quick), ("ns", "µs", "ms", "s"))
    for name, call in (("command/version", ["--version"]), ("command/info-oasago2", ["info", LEVEL.format("oasago2")])):
        seconds = []
        for _ in range(5 if quick else 11):
            began = time.perf_counter()
            run(BUILD / "sightline", *call)
            seconds.append(1000 * (time.perf_counter() - began))
        rows.append(row_of(name, "ms", seconds))
    return rows


def web(quick):
    """The npm package in Node and in a browser, beside three.js, its libraries, and the same calls natively; browsers hold their
    rows together by themselves."""
    rows = []
    for program, *arguments in (("bench.mjs",), ("city.mjs", "100000", "5" if quick else "41")):
        with tempfile.NamedTemporaryFile(suffix=".csv") as file:
            run("node", ROOT / "web" / "bench" / program, *arguments, "--csv", file.name)
            rows += read_topic(file.name)
    return rows


TOPICS = {"world": world, "columns": columns, "instances": instances, "ranges": ranges, "snapshots": snapshots, "movers": movers, "moving": moving, "forms": forms, "frustum": frustum,
          "occlusion": occlusion, "meshes": meshes, "peers": peers, "rays": rays, "scenes": scenes, "surfaces": surfaces, "shadows": shadows, "automatic": automatic,
          "memory": memory, "startup": startup, "large": large, "bake": bake, "draw-calls": draw_calls, "web": web}
