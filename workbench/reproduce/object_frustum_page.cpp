// The reproduction of Le Hoang Minh et al. 2022: tables, sentences and the page.
#include <fmt/format.h>

#include <array>
#include <filesystem>

#include <sightline/workbench/error.hpp>

#include "workbench/device/renderer.hpp"
#include "workbench/io/text_file.hpp"
#include "workbench/report/page.hpp"
#include "workbench/reproduce/object_frustum.hpp"
#include "workbench/reproduce/object_frustum_sections.hpp"
#include "workbench/reproduce/published.hpp"

namespace sightline::reproduce {

namespace {

constexpr const char* kTrees = "object_frustum";

std::optional<double> frame_value(const DrawnFrame& frame, std::string_view what) {
  if (what == "gpu_ms") return frame.gpu;
  if (frame.cpu <= 0) return std::nullopt;
  return what == "cpu_ms" ? frame.cpu : 1000 / frame.cpu;
}

// Of a run, or their mean: frames/s are the mean of the runs' frames/s, as the paper's average is.
std::optional<double> our_value(const ObjectFrustumResult& result, std::size_t run, std::string_view column) {
  const bool grid = column.starts_with("unity_");
  const std::string_view what = column.substr(column.find('_') + 1);
  const auto of = [&](const ObjectFrustumRun& r) {
    return frame_value(grid ? r.grid_cell : r.object_frustum, what);
  };
  if (run < result.runs.size()) return of(result.runs[run]);
  if (result.runs.empty() || run < kPublishedRuns) return std::nullopt;
  double sum = 0;
  for (const ObjectFrustumRun& r : result.runs) {
    const std::optional<double> value = of(r);
    if (!value) return std::nullopt;
    sum += *value;
  }
  return sum / static_cast<double>(result.runs.size());
}

std::string spaced(std::string column) {
  std::ranges::replace(column, '_', ' ');
  return column;
}

PaperTable table_2(const ObjectFrustumResult& result) {
  const Published& csv = published(kTrees);
  PaperTable table;
  table.name = "table 2";
  table.title =
      "ten runs of one straight view over 30,000 trees on terrain: \"unity\" is Unity 2020.3.32 in the paper "
      "and grid-cell here, \"ours\" the paper's method and object-frustum";
  table.keys = {"run"};
  const std::vector<std::string> columns(csv.header().begin() + 1, csv.header().end());
  for (const std::string& column : columns) table.columns.push_back(spaced(column));
  for (std::size_t run = 0; run < csv.rows().size(); ++run) {
    const std::string& name = csv.rows()[run].front();
    PaperTable::Row row{{name}, {}};
    for (const std::string& column : columns)
      row.cells.push_back({csv.text({{"run", name}}, column), our_value(result, run, column), {}});
    table.rows.push_back(std::move(row));
  }
  table.base = PaperTable::Base::row;
  table.base_row = table.rows.size() - 1;
  table.note = fmt::format(
      "Ratios are to the average, so they show how the runs scatter. CPU: from the beginning of culling to "
      "the finished picture, which the CPU waits for; GPU: the frame's passes; frames/s: 1000 / CPU. Both "
      "methods sort 5 x 5 cells, draw a call an object, and see {} m far.",
      kSightLimit);
  return table;
}

PaperTable averages_table(const ObjectFrustumResult& result) {
  PaperTable table;
  table.name = "table 2, averages";
  table.title = "unity / ours: what testing objects instead of cells saves";
  table.keys = {"average of"};
  table.columns = {"unity / ours"};
  for (const auto& [name, what] :
       {std::pair{"CPU time", "cpu_ms"}, {"GPU time", "gpu_ms"}, {"frames/s", "fps"}}) {
    const PublishedAverages ratio = averages_of(result, what);
    table.rows.push_back(
        {{name}, {{ratio.published ? fmt::format("{:.2f}", *ratio.published) : "", ratio.ours, {}}}});
  }
  return table;
}

const ObjectFrustumForm* form_of(const ObjectFrustumResult& result, std::string_view method) {
  for (const ObjectFrustumForm& form : result.forms) {
    if (form.method.starts_with(method) && form.method.ends_with("submission=objects")) return &form;
  }
  return nullptr;
}

std::vector<std::string> tree_sentences(const ObjectFrustumResult& result) {
  const PublishedAverages cpu = averages_of(result, "cpu_ms"), gpu = averages_of(result, "gpu_ms");
  std::vector<std::string> out{fmt::format(
      "The paper claims that testing the objects of crossing cells, instead of drawing all of them, takes "
      "1/{:.2f} of Unity's CPU time and 1/{:.2f} of its GPU time over 30,000 trees on terrain.",
      cpu.published.value_or(0), gpu.published.value_or(0))};
  const ObjectFrustumForm *grid = form_of(result, "grid-cell"), *fine = form_of(result, "object-frustum");
  if (!grid || !fine) {
    out.emplace_back("Nothing was measured here.");
    out.emplace_back("There is nothing of ours to differ from it.");
    return out;
  }
  const double kept = static_cast<double>(grid->kept) / static_cast<double>(fine->kept);
  std::string here = fmt::format(
      "Here object-frustum keeps {} objects where grid-cell keeps {}, {:.2f} times as many, and loses {}",
      fine->kept, grid->kept, kept, fine->lost_objects);
  if (cpu.ours) here += fmt::format("; its frames take 1/{:.2f} of the CPU time", *cpu.ours);
  if (gpu.ours) here += fmt::format(" and 1/{:.2f} of the GPU time", *gpu.ours);
  out.push_back(here + ".");
  out.push_back(difference_sentence(result, kept));
  return out;
}

}  // namespace

PublishedAverages averages_of(const ObjectFrustumResult& result, std::string_view what) {
  const Published& csv = published(kTrees);
  const auto column = [&](const char* whose) { return fmt::format("{}_{}", whose, what); };
  const auto printed = [&](const char* whose) {
    return number_of(csv.text({{"run", "average"}}, column(whose)));
  };
  PublishedAverages out;
  const auto theirs_unity = printed("unity"), theirs = printed("ours");
  if (theirs_unity && theirs && *theirs > 0) out.published = *theirs_unity / *theirs;
  const auto grid = our_value(result, kPublishedRuns, column("unity")),
             fine = our_value(result, kPublishedRuns, column("ours"));
  if (grid && fine && *fine > 0) out.ours = *grid / *fine;
  return out;
}

Reproduction object_frustum_reproduction(const ObjectFrustumResult& result) {
  Reproduction out;
  out.paper = "object-frustum";
  out.title = "Le Hoang Minh et al. 2022: object-level frustum culling";
  out.machine = result.machine.empty() ? "nothing was measured" : result.machine;
  out.sentences = tree_sentences(result);
  out.tables = {table_2(result), averages_table(result)};
  out.sections = object_frustum_sections(result);
  return out;
}

void write_object_frustum_pictures(const std::string& folder, const ObjectFrustumResult& result) {
  for (const FigureFile& file : result.files) {
    const std::filesystem::path path = std::filesystem::path(folder) / file.name;
    if (file.svg.empty()) {
      device::save_png(file.pixels, path.string());
    } else {
      io::write_file(path, file.svg);
    }
  }
}

}  // namespace sightline::reproduce
