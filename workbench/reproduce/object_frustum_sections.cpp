#include "workbench/reproduce/object_frustum_sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "workbench/report/page.hpp"
#include "workbench/reproduce/object_frustum_walks.hpp"

namespace sightline::reproduce {

namespace {

using report::format_count;
using report::format_ms;

std::string whole_number(std::uint64_t number) {
  return format_count(static_cast<double>(number));
}

// What a clock's reading alone takes is no time of a step's.
std::string step_ms(double milliseconds) {
  return milliseconds < 0.001 ? "< 0.001" : format_ms(milliseconds);
}

PaperSection life_cycle(const ObjectFrustumResult& result) {
  PaperSection section{"figures 1 and 2", "the life cycle of a frame on the CPU and the GPU", {}, "", ""};
  if (result.steps.empty()) return section;
  report::Table table{{"step", "what", "grid-cell, ms", "object-frustum, ms"}, {}, 2};
  for (const FrameStep& step : result.steps) {
    table.rows.push_back({step.name, step.what, step.ms ? step_ms(step.ms->grid_cell) : "–",
                          step.ms ? step_ms(step.ms->object_frustum) : "–"});
  }
  section.tables.push_back(std::move(table));
  section.html = "<figure>" + draw_life_cycle(result.steps) +
                 "<figcaption>The paper's steps with their times in table 2's view, ms: grid-cell / "
                 "object-frustum.</figcaption></figure>\n";
  section.note =
      "The steps bear the paper's numbers. Where two of them are one here, the later bears the time of both.";
  return section;
}

std::string lists_text(const std::vector<NumberedCell>& cells) {
  std::string out;
  for (const auto& [row, column] : cells) out += fmt::format("{}{}.{}", out.empty() ? "" : " ", row, column);
  return out.empty() ? "–" : out;
}

std::size_t lost_cells(const WalkFigure& figure) {
  std::size_t lost = 0;
  for (const DrawnCell& cell : walk_cells(figure, figure.printed)) lost += cell.kind == DrawnCell::Kind::lost;
  return lost;
}

PaperSection walk_section(const char* name, const char* title, const std::optional<WalkFigure>& figure,
                          std::string note) {
  PaperSection section{name, title, {}, "", std::move(note)};
  if (!figure) return section;
  section.tables.push_back(
      {{"walk", "BLi, inside", "BLc, crossing"},
       {{"as printed", lists_text(figure->printed.inside), lists_text(figure->printed.crossing)},
        {"repaired", lists_text(figure->repaired.inside), lists_text(figure->repaired.crossing)}},
       3});
  const Camera camera = walk_camera(*figure);
  section.html = "<div class=\"charts\">";
  for (const auto& [lists, caption] :
       {std::pair{&figure->printed, "As printed: red cells are in sight and deleted."},
        {&figure->repaired, "Repaired: blue cells are taken whole, crossed ones object by object."}}) {
    section.html += "<figure style=\"margin:0\">" +
                    draw_cells(walk_cells(*figure, *lists), camera, 1, {}, {}, 440) +
                    fmt::format("<figcaption>{}</figcaption></figure>\n", report::escape(caption));
  }
  section.html += "</div>\n";
  section.note +=
      fmt::format(" The walk as printed deletes {} cells that are in sight.", lost_cells(*figure));
  return section;
}

PaperSection losses_section(const ObjectFrustumResult& result) {
  PaperSection section{
      "section 3, the walk", "what the walk as printed loses over 6 x 7 cells as the eye rises", {}, "", ""};
  report::Table table{{"eye at, m", "kept, repaired", "kept, as printed", "missing", "lost objects",
                       "lost pixels", "lost by the repaired walk"},
                      {},
                      1};
  for (const WalkLoss& loss : result.walk_losses) {
    table.rows.push_back({fmt::format("{:.1f}", loss.height), whole_number(loss.kept),
                          whole_number(loss.kept_as_printed), whole_number(loss.missing),
                          whole_number(loss.lost_objects), whole_number(loss.lost_pixels),
                          whole_number(loss.lost_repaired)});
  }
  if (!table.rows.empty()) section.tables.push_back(std::move(table));
  section.note =
      "Missing is what the repaired walk keeps and the printed one does not, lost what of that shows in the "
      "picture: among the trees the nearest hide most of it, above them nothing does. It keeps objects that "
      "the repaired walk leaves out, too, as the cells straight ahead get no angle test.";
  return section;
}

PaperSection cells_section(const ObjectFrustumResult& result) {
  PaperSection section{"figure 7", "the cells of table 2's view, crossed and numbered", {}, "", ""};
  const auto has = [&](const char* name) {
    return std::ranges::any_of(result.files, [&](const FigureFile& file) { return file.name == name; });
  };
  if (has("figure-7-grid-cell.svg")) {
    section.html +=
        before_after("figure-7-grid-cell.svg", "figure-7-object-frustum.svg",
                     "Left grid-cell, right object-frustum, from above: green dots are trees that "
                     "are drawn, blue cells lie inside, crossed ones on the limits.");
  }
  if (has("frame-grid-cell.png")) {
    section.html +=
        before_after("frame-grid-cell.png", "frame-object-frustum.png",
                     "The frame as drawn after grid-cell, left, and after object-frustum, right.");
  }
  section.note = "Rows are counted from the edge behind the viewpoint, columns from the left.";
  return section;
}

// "object-frustum, walk=printed": a line can break at the blanks; the cells of table 2 go without saying.
std::string spelt(std::string method) {
  const std::string usual = kObjectFrustumCells;
  if (const std::size_t at = method.find(usual); at != std::string::npos) method.erase(at, usual.size());
  std::string out;
  for (const char c : method) {
    if (c != '?' && c != '&') {
      out += c;
    } else if (!out.ends_with(", ")) {
      out += ", ";
    }
  }
  return out.ends_with(", ") ? out.substr(0, out.size() - 2) : out;
}

PaperSection forms_section(const ObjectFrustumResult& result) {
  PaperSection section{"section 3", "the forms of both methods in table 2's view", {}, "", ""};
  report::Table sets{
      {"method", "guarantee", "kept", "tested", "missing", "lost objects", "lost pixels"}, {}, 2};
  report::Table times{{"method", "draw calls", "cull ms", "CPU ms", "GPU ms"}, {}, 1};
  for (const ObjectFrustumForm& form : result.forms) {
    const bool gpu = form.drawn && form.drawn->gpu;
    sets.rows.push_back({spelt(form.method), std::string(to_string(form.guarantee)), whole_number(form.kept),
                         whole_number(form.tested), whole_number(form.missing),
                         whole_number(form.lost_objects), whole_number(form.lost_pixels)});
    times.rows.push_back({spelt(form.method), whole_number(form.draw_calls), format_ms(form.cull_ms),
                          form.drawn ? format_ms(form.drawn->cpu) : "–",
                          gpu ? format_ms(*form.drawn->gpu) : "–"});
  }
  if (!result.forms.empty()) section.tables = {std::move(sets), std::move(times)};
  section.note =
      "submission=objects is a draw an object (steps C7 and G3), else a draw a mesh, instanced. walk=printed "
      "is the walk word for word; missing is what object-frustum keeps and this form does not, lost what of "
      "that "
      "shows in the picture: near trees hide most of the rest. layers=1 asks for opaque trees alone (step "
      "C2), so transparent trees and "
      "the "
      "ground count as lost. occlusion=masked is what the paper names as its future work.";
  return section;
}

PaperSection sizes_section(const ObjectFrustumResult& result) {
  PaperSection section{
      "section 4", "the size of a cell decides: objects kept, grid-cell / object-frustum", {}, "", ""};
  const PublishedAverages gpu = averages_of(result, "gpu_ms");
  report::Table table{{"cells", "m", "grid-cell", "object-frustum", "ratio", "grid-cell within the limit",
                       "object-frustum within the limit", "ratio"},
                      {},
                      1};
  Chart chart_of{"cell-sizes", "cells", "times as many kept", {}, {}, false, false};
  Series whole{"whole map in sight", {}}, limited{"within the sight limit", {}},
      paper{"the paper's GPU times", {}};
  for (const CellSize& size : result.cell_sizes) {
    const std::string cells = fmt::format("{} x {}", size.rows, size.columns);
    const double in_whole = CellSize::ratio(size.whole), in_limit = CellSize::ratio(size.limited);
    table.rows.push_back({cells, fmt::format("{:.0f}", size.metres), format_count(size.whole.grid_cell),
                          format_count(size.whole.object_frustum), fmt::format("{:.2f}", in_whole),
                          format_count(size.limited.grid_cell), format_count(size.limited.object_frustum),
                          fmt::format("{:.2f}", in_limit)});
    if (size.rows != size.columns) continue;  // beside the line of square cells
    chart_of.labels.push_back(fmt::format("{} ({:.0f} m)", cells, size.metres));
    whole.values.push_back(in_whole), limited.values.push_back(in_limit);
    paper.values.push_back(gpu.published.value_or(0));
  }
  if (table.rows.empty()) return section;
  section.tables.push_back(std::move(table));
  chart_of.series = {std::move(whole), std::move(limited), std::move(paper)};
  section.html = chart(chart_of);
  section.note = "The paper does not say how large its cells are; its figures draw 4 x 5 and 6 x 7 of them.";
  return section;
}

constexpr int kStepWidth = 140, kStepHeight = 96, kGap = 14;

// What a step does in lines that fit its box.
std::vector<std::string> wrapped(const std::string& text) {
  constexpr std::size_t kMost = 21;
  std::vector<std::string> lines(1);
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find(' ', from), text.size());
    const std::string word = text.substr(from, end - from);
    if (lines.back().size() + word.size() > kMost) lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + word;
    from = end + 1;
  }
  return lines;
}

std::string draw_step(const FrameStep& step, int x, int y, const char* colour) {
  const std::string times =
      step.ms ? step_ms(step.ms->grid_cell) + " / " + step_ms(step.ms->object_frustum) : "–";
  std::string svg = fmt::format(
      "<rect x=\"{0}\" y=\"{1}\" width=\"{2}\" height=\"{3}\" rx=\"6\" fill=\"{4}\" "
      "fill-opacity=\".14\" stroke=\"{4}\"/><text x=\"{5}\" y=\"{6}\" font-size=\"15\" "
      "font-weight=\"700\" fill=\"#1e2228\">{7}</text><text x=\"{5}\" y=\"{8}\" font-size=\"12\" "
      "fill=\"#1e2228\">{9}</text>",
      x, y, kStepWidth, kStepHeight, colour, x + 10, y + 22, step.name, y + kStepHeight - 10, times);
  int line_y = y + 38;
  for (const std::string& line : wrapped(step.what)) {
    svg += fmt::format("<text x=\"{}\" y=\"{}\" font-size=\"10.5\" fill=\"#5d6673\">{}</text>", x + 10,
                       line_y, report::escape(line));
    line_y += 13;
  }
  return svg + "\n";
}

}  // namespace

std::string difference_sentence(const ObjectFrustumResult& result, double kept) {
  const PublishedAverages cpu = averages_of(result, "cpu_ms"), gpu = averages_of(result, "gpu_ms");
  if (!cpu.ours || !cpu.published) {
    return "No frame was drawn, so only what is kept can be compared: the paper prints times alone.";
  }
  const double apart = *cpu.ours / *cpu.published;
  std::string out = fmt::format("The CPU's ratio is {:.2f} of the published one", apart);
  if (gpu.ours && gpu.published)
    out += fmt::format(" and the GPU's {:.2f} of it", *gpu.ours / *gpu.published);
  out += fmt::format(": {:.2f} times as many objects are drawn, which the cells' size decides", kept);
  // What a frame costs when next to nothing but what shows is drawn, both methods pay for.
  const auto unhidden = std::ranges::find_if(result.forms, [](const ObjectFrustumForm& form) {
    return form.method.ends_with("occlusion=masked") && form.drawn;
  });
  if (unhidden != result.forms.end()) {
    out +=
        fmt::format(", but a frame of the {} objects that are not hidden takes {:.0f} % of grid-cell's, too",
                    unhidden->kept, 100 * unhidden->drawn->cpu / result.forms.front().drawn->cpu);
  }
  if (result.drawn_by_cpu) out += "; here the CPU draws, so that its time holds the GPU's";
  return out + "; and Unity's frame holds work that no culling shortens.";
}

std::vector<PaperSection> object_frustum_sections(const ObjectFrustumResult& result) {
  return {life_cycle(result),
          walk_section("figure 4", "the distance limit over 4 x 5 cells, by both walks", result.figure_4,
                       "Rows are sorted by the cell straight ahead; the first that the limit crosses ends "
                       "the walk."),
          walk_section("figure 6", "the angle limits over 6 x 7 cells, by both walks", result.figure_6,
                       "The paper's numbers are misprinted: what its text deletes at the left is numbered "
                       "\"1.1 and 1.6\" and \"2.7\", at the right \"1.2 and 1.1\" and \"2.1\"; by its own "
                       "numbering the left has 1.2, 1.1 and 2.1, the right 1.6, 1.7 and 2.7."),
          losses_section(result),
          cells_section(result),
          forms_section(result),
          sizes_section(result),
          {"missing: table 1, figures 3 and 5",
           "not reproduced",
           {},
           "",
           "All that the paper measured stands in table 2."},
          {"missing: Unity",
           "what the paper compares with",
           {},
           "",
           "Unity 2020.3.32, an i7-7800X and a GTX 1080 Ti cannot be had here: grid-cell stands for Unity's "
           "culling, and all times are this machine's, to be read as ratios."}};
}

std::string draw_life_cycle(const std::vector<FrameStep>& steps) {
  constexpr int kMost = 4;  // a row, so that a narrow page holds it
  std::string drawn;
  int row = 0, column = 0;
  bool on_gpu = false;
  for (const FrameStep& step : steps) {
    const bool gpu = step.name.starts_with("G");
    if (column == kMost || gpu != on_gpu) ++row, column = 0;
    on_gpu = gpu;
    drawn += draw_step(step, kGap + column++ * (kStepWidth + kGap), kGap + row * (kStepHeight + kGap),
                       gpu ? "#2a9d6e" : "#2084d0");
  }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "style=\"max-width:100%;height:auto\" font-family=\"sans-serif\"><rect width=\"100%\" "
      "height=\"100%\" fill=\"#fff\"/>\n{2}</svg>\n",
      kMost * (kStepWidth + kGap) + kGap, (row + 1) * (kStepHeight + kGap) + kGap, drawn);
}

}  // namespace sightline::reproduce
