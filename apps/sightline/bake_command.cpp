// sightline bake and query: potentially visible sets per cell, offline, and what stands in their file.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <system_error>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/io.hpp>

#include "command.hpp"
#include "workbench/bake/bake.hpp"
#include "workbench/bake/bake_check.hpp"
#include "workbench/bake/pvs_file.hpp"
#include "workbench/io/text_file.hpp"
#include "workbench/report/table.hpp"

namespace sightline::app {

namespace {

report::Table comparison_table(const std::vector<bake::CellComparison>& rows) {
  report::Table table;
  table.header = {"objects a cell", "mean", "least", "quarter", "half", "three quarters", "most"};
  const auto add = [&](const char* what, const std::function<std::size_t(const bake::CellComparison&)>& of) {
    std::vector<std::size_t> all;
    double sum = 0;
    for (const bake::CellComparison& row : rows)
      all.push_back(of(row)), sum += static_cast<double>(all.back());
    std::ranges::sort(all);
    std::vector<std::string> cells{what, report::format_count(sum / static_cast<double>(all.size()))};
    for (std::size_t quarter = 0; quarter <= 4; ++quarter) {
      cells.push_back(std::to_string(all[(all.size() - 1) * quarter / 4]));
    }
    table.rows.push_back(std::move(cells));
  };
  if (rows.empty()) return table;
  add("baked", [](const bake::CellComparison& row) { return row.baked; });
  add("in the level's PVS", [](const bake::CellComparison& row) { return row.level; });
  add("baked, not in the level's", [](const bake::CellComparison& row) { return row.only_baked.size(); });
  add("in the level's, not baked", [](const bake::CellComparison& row) { return row.only_level.size(); });
  return table;
}

struct BakeOptions {
  std::string scene, file, cells;
  bake::CellOptions bake;
  int threads = 0;
  std::size_t check = 0;
  std::uint64_t check_seed = 1;
};

void print_level(const Scene& scene, const CellPvs& cells, const BakeOptions& options) {
  const std::vector<bake::CellComparison> rows = bake::compare_with_level(scene, cells);
  fmt::print("\nCell by cell against the level's own PVS, {} cells\n\n{}", rows.size(),
             report::render(comparison_table(rows)));
  if (options.cells.empty()) {
    fmt::print("--cells FILE.csv writes every cell's row, with the objects that only one of the two has.\n");
  } else {
    io::write_file(options.cells, bake::comparison_csv(cells, rows));
  }
}

// What would only be found out once all was baked.
void expect_sense(const BakeOptions& options) {
  expect_apart({{"SCENE", options.scene}}, {{"--output", options.file}, {"--cells", options.cells}});
  std::error_code ignored;
  if (std::filesystem::exists(options.file, ignored) &&
      !std::filesystem::is_regular_file(options.file, ignored))
    throw Error("--output '" + options.file + "': not a regular file, expected one or none");
}

int run_bake(const BakeOptions& options) {
  const bake::Ranks ranks = bake::Ranks::join();
  expect_sense(options);
  const Scene scene = load_scene(options.scene);
  if (!scene.level && !options.cells.empty())
    throw Error(options.scene + ": has no visible sets of its own, which --cells compares with");
  // Ranks share the machine out: a thread each, unless told otherwise.
  const int threads = options.threads > 0 || !ranks.joined() ? options.threads : 1;
  const auto shown = ranks.rank() == 0 ? progress("bake") : std::function<void(std::size_t, std::size_t)>();
  const auto tell = [&](std::size_t done, std::size_t all) {
    if (shown) shown(done, all);
    return true;
  };
  const auto estimated = [&](const bake::BakeEstimate& before) {
    if (!shown || before.cells == 0) return;
    fmt::print(stderr, "bake: {} cells, some {:.0f} of them open: at least {}\n", before.cells, before.open,
               in_words(before.seconds));
  };
  const bake::BakeResult result =
      bake::bake(scene, options.bake, options.file, ranks, threads, tell, estimated);
  if (ranks.rank() != 0) return Exit::done;
  const CellPvs& cells = result.cells;
  const auto open = static_cast<std::uint64_t>(std::count(cells.open.begin(), cells.open.end(), 1));
  const double bytes = static_cast<double>(std::filesystem::file_size(options.file));
  const double raw = static_cast<double>(open) * static_cast<double>((scene.size() + 7) / 8);
  fmt::print("{}: {} of {} cells open, {} objects; {} rays here, {} cells resumed\n", printable(options.file),
             open, cells.size(), scene.size(), result.rays, result.resumed);
  fmt::print("{:.0f} bytes, {:.3f} times the open cells' raw bit matrix ({:.0f} bytes)\n", bytes, bytes / raw,
             raw);
  if (const WorldPoint& o = scene.origin; o != WorldPoint{}) {
    fmt::print(
        "The file's cells, and the points that query takes, count from the scene's origin, {},{},{}.\n", o.x,
        o.y, o.z);
  }
  if (scene.level) print_level(scene, cells, options);
  if (options.check > 0) {
    const oracle::EmbreeJudge judge(scene);
    const bake::BakeLoss loss =
        bake::check_bake(scene, cells, judge, options.check, 320, 240, options.check_seed, progress("check"));
    fmt::print(
        "\n{} random views inside cells: {} of {} pixels lost ({:.5f} %), {} objects; {:.1f} kept, {:.1f} "
        "seen\n",
        loss.views, loss.lost_pixels, loss.pixels,
        100 * static_cast<double>(loss.lost_pixels) / static_cast<double>(loss.pixels), loss.lost_objects,
        static_cast<double>(loss.kept) / static_cast<double>(loss.views),
        static_cast<double>(loss.visible) / static_cast<double>(loss.views));
  }
  return Exit::done;
}

Vec3 parse_point(const std::string& text) {
  const std::vector<std::string> parts = split("--at", text);
  float v[3];
  bool good = parts.size() == 3;
  for (std::size_t i = 0; good && i < 3; ++i) {
    const char* end = parts[i].data() + parts[i].size();
    const auto read = std::from_chars(parts[i].data(), end, v[i]);
    good = read.ec == std::errc{} && read.ptr == end && std::isfinite(v[i]);
  }
  if (!good) throw Error("--at '" + text + "': expected three finite numbers, x,y,z");
  return {v[0], v[1], v[2]};
}

int run_query(const std::string& file, const std::string& at) {
  const Vec3 point = parse_point(at);
  const CellPvs cells = bake::read_pvs_file(file);
  const std::uint32_t cell = cells.cell_at(point);
  if (cell == kNoCell) {
    fmt::print("{},{},{}: in no open cell; everything may be seen\n", point.x, point.y, point.z);
    return Exit::done;
  }
  const Box box = cells.cell_bounds(cell);
  const auto seen = cells.seen_from(cell);
  fmt::print("cell {} from {},{},{} to {},{},{}: {} of {} objects\n", cell, box.min.x, box.min.y, box.min.z,
             box.max.x, box.max.y, box.max.z, seen.size(), cells.objects);
  for (const std::uint32_t object : seen) fmt::print("{}\n", object);
  return Exit::done;
}

}  // namespace

void attach_pvs(Scene& scene, const std::string& file) {
  if (file.empty()) return;
  auto cells = std::make_shared<CellPvs>(bake::read_pvs_file(file));
  bake::check_belongs(*cells, file, scene);
  scene.cells = std::move(cells);
}

void add_bake(CLI::App& app, int& exit) {
  CLI::App& command = *app.add_subcommand("bake",
                                          "Bake the visible set of each cell of a grid; goes on where it was "
                                          "killed, with FILE.pvs.part.0 beside it; mpirun shares it out");
  auto options = std::make_shared<BakeOptions>();
  command.add_option("SCENE", options->scene, kSceneHelp)->required();
  command.add_option("-o,--output", options->file, "the file to write")
      ->required()
      ->check(output_file(".pvs"))
      ->type_name("FILE.pvs");
  command.add_option("--cell", options->bake.cell, "metres along each side of a cell")
      ->check(number(0.01, 1e6))
      ->capture_default_str();
  command.add_option("--target", options->bake.target, "share of a view that a cell's set may lack")
      ->check(number(1e-6, 0.5))
      ->capture_default_str();
  command.add_option("--seed", options->bake.seed, "of the viewpoints")
      ->transform(whole(0, kAnySeed))
      ->capture_default_str();
  command.add_option("--rays", options->bake.rays, "from each viewpoint")
      ->transform(whole(1, 1 << 20))
      ->capture_default_str();
  command.add_option("--viewpoints", options->bake.most_viewpoints, "at most, a cell")
      ->transform(whole(1, 1 << 20))
      ->capture_default_str();
  command
      .add_option("--threads", options->threads, "of each process; default: all cores, and under mpirun one")
      ->transform(whole(1, 1024));
  command.add_option("--check", options->check, "afterwards hold N random views against the item buffer")
      ->transform(whole(0, 1000000))
      ->type_name("N");
  command.add_option("--check-seed", options->check_seed, "of those views")
      ->transform(whole(0, kAnySeed))
      ->capture_default_str();
  command
      .add_option("--cells", options->cells, "write the comparison with the level's own PVS, cell by cell")
      ->check(output_file(".csv"))
      ->type_name("FILE.csv");
  on_run(command, exit, [options] { return run_bake(*options); });
}

void add_query(CLI::App& app, int& exit) {
  CLI::App& command = *app.add_subcommand("query", "Print what a baked file says can be seen from a point");
  auto file = std::make_shared<std::string>(), at = std::make_shared<std::string>();
  command.add_option("FILE", *file, "a file that bake wrote")->required();
  command.add_option("--at", *at, "the point, in metres")->required()->type_name("x,y,z");
  on_run(command, exit, [file, at] { return run_query(*file, *at); });
}

}  // namespace sightline::app
