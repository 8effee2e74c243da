// Cells and calls of structures by ours and by the paper's rules, counted without drawing.
#include <fmt/format.h>

#include <cmath>

#include "workbench/methods/draw_calls/draw_call_method.hpp"
#include "workbench/reproduce/draw_calls/draw_calls.hpp"

namespace sightline::reproduce {

namespace {

constexpr std::array kCellRules{kPrintedCells, kSplitCells, methods::kTightCells};

StructureCount count_one(const Scene& scene, std::string_view structure, std::uint32_t height,
                         const std::string& rules, const std::vector<View>& views) {
  StructureCount out{std::string(structure), height, rules, possible_cells(structure, height)};
  const std::string parameters = fmt::format("?height={}{}{}", height, rules.empty() ? "" : "&", rules);
  const auto wise = create_method(fmt::format("drawcall-wise-{}{}", structure, parameters), scene),
             simple = create_method(fmt::format("simple-{}{}", structure, parameters), scene);
  out.made = static_cast<double>(static_cast<const methods::DrawCallMethod&>(*wise).cells().size());
  const auto all = static_cast<double>(views.size());
  Frame frame;
  for (const View& view : views) {
    cull(*wise, view, frame);
    out.visited += static_cast<double>(frame.stats.nodes_visited) / all;
    out.wise_calls += static_cast<double>(frame.stats.draw_calls) / all;
    out.wise_triangles += static_cast<double>(frame.stats.triangles) / all;
    cull(*simple, view, frame);
    out.simple_calls += static_cast<double>(frame.stats.draw_calls) / all;
  }
  return out;
}

}  // namespace

double possible_cells(std::string_view structure, std::uint32_t height) {
  const double children = structure == "grid" ? 4 : structure == "octree" ? 8 : 2;
  return std::pow(children, height);
}

std::vector<StructureCount> count_structures(const Scene& scene, const std::vector<View>& views) {
  std::vector<StructureCount> out;
  for (const std::string_view structure : kWalkStructures) {
    for (std::uint32_t height = 1; height <= kHighest; ++height) {
      for (const std::string_view rules : kCellRules)
        out.push_back(count_one(scene, structure, height, std::string(rules), views));
    }
  }
  return out;
}

}  // namespace sightline::reproduce
