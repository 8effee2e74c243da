// The paper's tables 1 to 5 beside ours, figure 7, its chunks, and where it contradicts itself.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "workbench/report/summary.hpp"
#include "workbench/reproduce/published.hpp"
#include "workbench/reproduce/vertex_chunk/vertex_chunk.hpp"

namespace sightline::reproduce {

namespace {

using Summaries = std::vector<report::MethodSummary>;

constexpr std::array kWorlds{"regular", "irregular"};
// In the paper's order; ours have no number of the paper's beside them.
constexpr std::array kPapers{"vertex-chunk", "hroc", "roc", "vfc-vc", "none"};
constexpr std::array kOurs{"hroc?leaf=boxes", "ioc", "ihzb", "vertex-chunk?faces=facing",
                           "resident-chunk",  "hiz"};
constexpr std::size_t kRows = kPapers.size() + kOurs.size();

std::string_view name_of(std::size_t row) {
  return row < kPapers.size() ? kPapers[row] : kOurs[row - kPapers.size()];
}

// Without the contribution test and the counting, which all have or nobody times.
std::string without_parameters(std::string specification) {
  for (const std::string_view common : {"contribution=area", "count=on"}) {
    const std::size_t at = specification.find(common);
    if (at == std::string::npos) continue;
    const bool last = at + common.size() == specification.size();
    specification.erase(last ? at - 1 : at, common.size() + 1);
  }
  return specification;
}

const report::MethodSummary* find(const Summaries& all, std::string_view method) {
  const auto found = std::ranges::find_if(
      all, [&](const report::MethodSummary& s) { return without_parameters(s.method) == method; });
  return found == all.end() ? nullptr : &*found;
}

const VertexChunkWorld* find(const std::vector<VertexChunkWorld>& worlds, std::string_view name) {
  const auto found = std::ranges::find(worlds, name, &VertexChunkWorld::name);
  return found == worlds.end() ? nullptr : &*found;
}

std::optional<double> objects_of(const VertexChunkWorld* world) {
  if (!world) return std::nullopt;
  return static_cast<double>(world->chunks.objects);
}

// A column: the CSV's name for it, and ours out of a method's summary.
struct Column {
  const char* published;
  double (*ours)(const report::MethodSummary&, double objects);
};

constexpr auto kVerticesOf = [](const report::MethodSummary& s, double) { return s.cull_vertices; };
constexpr auto kCullingOf = [](const report::MethodSummary& s, double) { return s.cpu_ms + s.gpu_ms; };
constexpr auto kOccludersOf = [](const report::MethodSummary& s, double) { return s.occluders_ms; };
constexpr auto kCulledOf = [](const report::MethodSummary& s, double objects) { return objects - s.kept; };
constexpr auto kSeenOf = [](const report::MethodSummary& s, double) { return s.truly_visible; };
constexpr auto kExcessOf = [](const report::MethodSummary& s, double) { return s.excess; };
constexpr auto kLostOf = [](const report::MethodSummary& s, double) {
  return static_cast<double>(s.lost_pixels);
};
constexpr auto kFramesOf = [](const report::MethodSummary& s, double) { return s.fps(); };

std::string heading(std::string column) {
  std::ranges::replace(column, '_', ' ');
  return column;
}

// Rows of all methods in one world and view; `first_keys` stand before the method.
void add_rows(PaperTable& table, const VertexChunkWorld* world, const Summaries& ours,
              const std::vector<Published::Key>& about, std::span<const Column> columns,
              const std::vector<std::string>& first_keys) {
  const Published& paper = published("vertex_chunk");
  for (std::size_t r = 0; r < kRows; ++r) {
    const std::string_view method = name_of(r);
    const report::MethodSummary* mine = find(ours, method);
    const bool printed = std::ranges::any_of(paper.rows(), [&](const auto& row) {
      return row[paper.column("method")] == method && std::ranges::all_of(about, [&](const auto& key) {
               return row[paper.column(key.first)] == key.second;
             });
    });
    if (!printed && method == "none") continue;  // it has no culling pass
    PaperTable::Row row;
    row.keys = first_keys;
    row.keys.emplace_back(method);
    std::vector<Published::Key> keys = about;
    keys.emplace_back("method", method);
    const auto text = [&](const char* column) { return printed ? paper.text(keys, column) : std::string(); };
    row.cells.push_back({text("objects"), objects_of(world), {}});
    for (const Column& column : columns) {
      Cell cell{column.published[0] == '+' ? std::string() : text(column.published), {}, {}};
      if (mine) cell.ours = column.ours(*mine, objects_of(world).value_or(0));
      row.cells.push_back(std::move(cell));
    }
    table.rows.push_back(std::move(row));
  }
}

PaperTable table_of(std::string name, std::string title, std::vector<std::string> keys,
                    std::span<const Column> columns) {
  PaperTable table;
  table.name = std::move(name), table.title = std::move(title), table.keys = std::move(keys);
  table.columns = {"objects"};
  for (const Column& column : columns)
    table.columns.push_back(heading(column.published[0] == '+' ? column.published + 1 : column.published));
  table.base = PaperTable::Base::row;
  return table;
}

// A name that begins with '+' is a column of ours alone.
constexpr std::array kCullingColumns{Column{"vertices", kVerticesOf}, Column{"culling_ms", kCullingOf},
                                     Column{"+occluders' depth ms", kOccludersOf}};
constexpr std::array kDrawnColumns{Column{"culled_objects", kCulledOf}, Column{"fps", kFramesOf},
                                   Column{"+visible", kSeenOf}, Column{"+kept in excess", kExcessOf},
                                   Column{"+pixels lost", kLostOf}};
constexpr std::array kFrameColumns{Column{"fps", kFramesOf}, Column{"+kept in excess", kExcessOf},
                                   Column{"+pixels lost", kLostOf}};

void add_world_tables(Reproduction& out, const std::vector<VertexChunkWorld>& worlds) {
  for (const bool drawn : {false, true}) {
    for (std::size_t w = 0; w < kWorlds.size(); ++w) {
      const VertexChunkWorld* world = find(worlds, kWorlds[w]);
      const std::string number = std::to_string(1 + w + (drawn ? 2 : 0));
      const std::span<const Column> columns =
          drawn ? std::span<const Column>(kDrawnColumns) : std::span<const Column>(kCullingColumns);
      PaperTable table = table_of("table " + number,
                                  fmt::format("the {} world, {}", kWorlds[w],
                                              drawn ? "objects culled and frames/s of one view"
                                                    : "vertices into the culling pass and its time"),
                                  {"world", "method"}, columns);
      add_rows(table, world, world ? report::summarise(world->near) : Summaries{},
               {{"table", number}, {"world", kWorlds[w]}}, columns, {kWorlds[w]});
      out.tables.push_back(std::move(table));
    }
  }
}

// Far and near are told by their own vertex-chunk each, so a table a world and view.
void add_view_tables(Reproduction& out, const std::vector<VertexChunkWorld>& worlds) {
  for (const char* name : kWorlds) {
    const VertexChunkWorld* world = find(worlds, name);
    for (const char* view : {"far", "near"}) {
      PaperTable table = table_of("table 5",
                                  fmt::format("the {} world, frames/s of the {} view, means over "
                                              "several views",
                                              name, view),
                                  {"world", "view", "method"}, kFrameColumns);
      Summaries ours;
      if (world) ours = report::summarise(view[0] == 'f' ? world->far_views : world->near_views);
      add_rows(table, world, ours, {{"table", "5"}, {"world", name}, {"view", view}}, kFrameColumns,
               {name, view});
      out.tables.push_back(std::move(table));
    }
  }
}

PaperSection rising_section(const VertexChunkWorld& world) {
  PaperSection section{
      "figure 7", fmt::format("frames/s while the camera rises, {} world", world.name), {}, {}, {}};
  Chart lines{"rising-" + world.name, "height of the camera, m", "frames/s", {}, {}, false, true};
  report::Table table{{"height, m"}, {}, 1};
  for (const Camera& camera : world.rising.cameras) {
    lines.labels.push_back(report::format_count(static_cast<double>(camera.eye.y)));
    table.rows.push_back({lines.labels.back()});
  }
  for (const std::string& method : world.rising.methods) {
    Series series{without_parameters(method), {}};
    table.header.push_back(series.name);
    for (const measure::Row& row : world.rising.rows) {
      if (row.method != method) continue;
      const double fps = row.frame && row.frame->median > 0 ? 1000 / row.frame->median : 0;
      table.rows[row.view].push_back(report::format_ms(fps));
      series.values.push_back(fps);
    }
    lines.series.push_back(std::move(series));
  }
  section.html = chart(lines);
  section.tables.push_back(std::move(table));
  return section;
}

PaperSection pass_section(const std::vector<VertexChunkWorld>& worlds) {
  PaperSection section{"figure 2", "the steps of a frame of vertex-chunk, in its order", {}, {}, {}};
  report::Table table{{"world", "step", "ms"}, {}, 2};
  for (const VertexChunkWorld& world : worlds) {
    for (const device::PassTime& pass : world.passes)
      table.rows.push_back({world.name, pass.name, report::format_ms(pass.milliseconds)});
  }
  section.tables.push_back(std::move(table));
  section.note = "Before the first step the CPU drops chunks and assembles the vertices of the rest.";
  return section;
}

const measure::Row* find(const measure::Comparison& all, std::string_view method) {
  const auto found = std::ranges::find_if(
      all.rows, [&](const auto& row) { return without_parameters(row.method) == method; });
  return found == all.rows.end() ? nullptr : &*found;
}

// Rays and the nodes they look at are those of a run of their own, as counting takes time.
PaperSection culling_section(const std::vector<VertexChunkWorld>& worlds) {
  PaperSection section{
      "culling",
      "what the culling pass of the near view tests: boxes that are rasterised or, by hiz and "
      "resident-chunk, looked up; rays cast inside; nodes of a tree or chunks looked at",
      {},
      {},
      {}};
  report::Table table{{"world", "method", "boxes", "rays", "nodes", "culling, ms"}, {}, 2};
  for (const VertexChunkWorld& world : worlds) {
    for (const report::MethodSummary& timed : report::summarise(world.near)) {
      const std::string name = without_parameters(timed.method);
      const measure::Row* row = find(world.counted, name);
      if (!row) row = find(world.near, name);
      if (!row || name == "none") continue;
      const auto number = [](std::uint64_t n) { return report::format_count(static_cast<double>(n)); };
      table.rows.push_back({world.name, name, number(row->stats.tested), number(row->stats.rays),
                            number(row->stats.nodes_visited), report::format_ms(kCullingOf(timed, 0))});
    }
  }
  section.tables.push_back(std::move(table));
  return section;
}

PaperSection chunk_section(const std::vector<VertexChunkWorld>& worlds) {
  PaperSection section{"section 3.3", "the chunks: how many, how full, how many shared", {}, {}, {}};
  report::Table table;
  table.header = {"world",           "chunks",         "shared",
                  "objects a chunk", "in the fullest", "objects in shared chunks"};
  for (const VertexChunkWorld& world : worlds) {
    const ChunkCounts& c = world.chunks;
    const double chunks = static_cast<double>(std::max<std::size_t>(1, c.chunks));
    table.rows.push_back({world.name, std::to_string(c.chunks), std::to_string(c.shared_chunks),
                          fmt::format("{:.1f}", static_cast<double>(c.objects) / chunks),
                          std::to_string(c.fullest),
                          fmt::format("{} ({:.0f} %)", c.shared_objects,
                                      100 * static_cast<double>(c.shared_objects) /
                                          static_cast<double>(std::max<std::size_t>(1, c.objects)))});
  }
  section.tables.push_back(std::move(table));
  for (const VertexChunkWorld& world : worlds) {
    for (const auto& [file, caption, pixels] : world.pictures) {
      if (file.ends_with("-aside.png")) continue;  // stands beneath the slider
      section.html += file.ends_with("-kept.png") ? before_after(world.name + "-aside.png", file, caption)
                                                  : picture(file, caption);
    }
  }
  return section;
}

double number(std::string_view table, std::string_view method, const char* column,
              std::string_view near_in = {}) {
  std::vector<Published::Key> keys{{"table", table}, {"method", method}};
  if (!near_in.empty()) keys.insert(keys.end(), {{"view", "near"}, {"world", near_in}});
  return number_of(published("vertex_chunk").text(keys, column)).value_or(0);
}

// What the paper's own figures say against each other, computed from them.
PaperSection contradictions() {
  PaperSection section{
      "text", "where the paper's figures contradict each other, and what its percentages are", {}, {}, {}};
  const double culling = number("1", "vertex-chunk", "culling_ms"), fps = number("3", "vertex-chunk", "fps");
  const double vertices = number("1", "vertex-chunk", "vertices"),
               objects = number("1", "vertex-chunk", "objects"),
               culled = number("3", "vfc-vc", "culled_objects");
  const double hroc = number("2", "hroc", "vertices");
  section.note += fmt::format(
      "Culling takes {:.0f} ms (table 1) of frames of {:.1f} ms (table 3: {:.0f} frames/s): more than the "
      "whole. ",
      culling, 1000 / fps, fps);
  section.note += fmt::format(
      "Chunks pass {:.0f} vertices where testing every object keeps {:.0f} ({:.0f} less {:.0f}): no "
      "conservative chunk "
      "can, so tables 1 and 3 are of different views or tests. ",
      vertices, objects - culled, objects, culled);
  section.note +=
      fmt::format("{:.0f} vertices of boxes (table 2, hroc) are {:.2f} boxes of 36. ", hroc, hroc / 36);
  const auto less = [](const char* table) {
    return 100 * (1 - number(table, "vertex-chunk", "culling_ms") / number(table, "hroc", "culling_ms"));
  };
  const auto more = [](const char* table, std::string_view near_in = {}) {
    return 100 * (number(table, "vertex-chunk", "fps", near_in) / number(table, "hroc", "fps", near_in) - 1);
  };
  section.note += fmt::format(
      "Against hroc, culling takes {:.0f} and {:.0f} % less time in the two worlds (the text says about 23), "
      "frames/s "
      "are {:.0f} and {:.0f} % more (15), and in the near view of table 5 {:.0f} and {:.0f} % more (over "
      "20).",
      less("1"), less("2"), more("3"), more("4"), more("5", "regular"), more("5", "irregular"));
  return section;
}

// The paper's order of culling times, and ours beside the quickest that descends a tree.
std::string order_of_culling(const VertexChunkWorld& world) {
  const Summaries ours = report::summarise(world.near);
  const auto ms = [&](std::string_view name) {
    const report::MethodSummary* found = find(ours, name);
    return found ? kCullingOf(*found, 0) : 0;
  };
  const double chunk = ms("vertex-chunk"), hroc = ms("hroc"), roc = ms("roc");
  const double quickest = std::min({hroc, ms("ioc"), ms("ihzb")});
  return fmt::format(
      "The paper's order of culling times, vertex-chunk < hroc < roc, is {} in the {} world: {:.2f}, {:.2f}, "
      "{:.2f} ms; hroc with every box {:.2f} ms. resident-chunk culls in {:.2f} of the time of the quickest "
      "of "
      "hroc, ioc and ihzb.",
      chunk < hroc && hroc < roc ? "shown" : "refuted", world.name, chunk, hroc, roc, ms("hroc?leaf=boxes"),
      ms("resident-chunk") / quickest);
}

// vertex-chunk against hroc, and which order all five have, of ours.
std::vector<std::string> findings(const std::vector<VertexChunkWorld>& worlds) {
  std::vector<std::string> out{
      "The paper claims that one vertex an object, in chunks of the ground plane, culls in less time than "
      "hroc and roc "
      "with the same objects culled, and so draws more frames: vertex-chunk, hroc, roc, vfc-vc, none in that "
      "order "
      "near the ground."};
  std::string came, differ;
  for (const VertexChunkWorld& world : worlds) {
    const Summaries ours = report::summarise(world.near);
    const auto *chunk = find(ours, "vertex-chunk"), *hroc = find(ours, "hroc"), *roc = find(ours, "roc");
    if (!chunk || !hroc || !roc) continue;
    came += fmt::format(
        "{}In the {} world vertex-chunk culls in {:.2f} of hroc's time and {:.2f} of roc's, with {:.2f} "
        "times hroc's and "
        "{:.2f} times roc's frames/s.",
        came.empty() ? "" : " ", world.name, kCullingOf(*chunk, 0) / kCullingOf(*hroc, 0),
        kCullingOf(*chunk, 0) / kCullingOf(*roc, 0), chunk->fps() / hroc->fps(), chunk->fps() / roc->fps());
    std::vector<const report::MethodSummary*> order;
    for (const char* name : kPapers) {
      if (const auto* s = find(ours, name)) order.push_back(s);
    }
    std::ranges::sort(order, std::ranges::greater{}, [](const auto* s) { return s->fps(); });
    std::string names;
    for (const auto* s : order) names.append(names.empty() ? "" : ", ").append(without_parameters(s->method));
    differ += fmt::format("{}By frames/s the order in the {} world is {}.", differ.empty() ? "" : " ",
                          world.name, names);
  }
  if (came.empty()) return out;
  out.push_back(came);
  for (const VertexChunkWorld& world : worlds) out.push_back(order_of_culling(world));
  out.push_back(differ +
                " Ours differs where the paper's hroc tests every object's box and ours rasterises groups "
                "and casts rays "
                "inside (hroc?leaf=boxes has every box), where a rasteriser of another kind makes vertices "
                "and pixels cost otherwise, and by the triangles of a "
                "sphere, "
                "which the paper does not tell.");
  return out;
}

}  // namespace

Reproduction vertex_chunk_reproduction(const std::vector<VertexChunkWorld>& worlds) {
  Reproduction out;
  out.paper = "vertex-chunk";
  out.title = "Lee & Shin 2023: vertex chunks";
  if (!worlds.empty()) {
    const measure::Comparison& near = worlds.front().near;
    out.machine = fmt::format(
        "{}, {} x {}; the paper: Iris Plus. All methods drop what covers less than a pixel by "
        "its area.",
        near.device, near.width, near.height);
  }
  out.sentences = findings(worlds);
  add_world_tables(out, worlds);
  add_view_tables(out, worlds);
  out.sections.push_back(culling_section(worlds));
  out.sections.push_back(pass_section(worlds));
  for (const char* name : kWorlds) {
    VertexChunkWorld unmeasured;
    unmeasured.name = name;
    const VertexChunkWorld* world = find(worlds, name);
    out.sections.push_back(rising_section(world ? *world : unmeasured));
  }
  out.sections.push_back(chunk_section(worlds));
  out.sections.push_back(contradictions());
  out.sections.push_back(
      {"missing: the other figures",
       "what cannot be had",
       {},
       {},
       "The program in Direct3D and the Iris Plus that the paper measured; and its other figures, "
       "which tell no number that its tables do not."});
  return out;
}

}  // namespace sightline::reproduce
