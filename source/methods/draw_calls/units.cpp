#include "methods/draw_calls/units.hpp"

#include <algorithm>

namespace sightline::methods {

namespace {

using Triangles = std::span<const std::uint32_t>;

void end_unit(Units& units, const FlatTriangles& flat, Triangles triangles) {
  units.range_start.push_back(static_cast<std::uint32_t>(units.ranges.size()));
  // Triangles ascend, and a scene's triangles stand object by object, so equal objects are neighbours.
  const std::size_t first = units.objects.size();
  for (const std::uint32_t triangle : triangles) {
    const ObjectId object = flat.objects[triangle];
    if (units.objects.size() == first || units.objects.back() != object) units.objects.push_back(object);
  }
  units.object_start.push_back(static_cast<std::uint32_t>(units.objects.size()));
}

void add_runs(Units& units, const FlatTriangles& flat, Triangles triangles) {
  for (std::size_t i = 0; i < triangles.size();) {
    std::size_t end = i + 1;
    while (end < triangles.size() && triangles[end] == triangles[end - 1] + 1) ++end;
    units.ranges.push_back({triangles[i], static_cast<std::uint32_t>(end - i)});
    i = end;
  }
  end_unit(units, flat, triangles);
}

void add_copy(Units& units, const FlatTriangles& flat, Triangles triangles, TriangleOrder& order) {
  units.ranges.push_back(
      {static_cast<std::uint32_t>(order.size()), static_cast<std::uint32_t>(triangles.size())});
  order.insert(order.end(), triangles.begin(), triangles.end());
  end_unit(units, flat, triangles);
}

}  // namespace

std::uint64_t Units::bytes() const noexcept {
  return 4 * (cell_start.size() + range_start.size() + object_start.size() + objects.size()) +
         ranges.size() * sizeof(TriangleRange) + cones.size() * sizeof(FacingCone);
}

Units make_units(Strategy strategy, const FlatTriangles& flat, const partition::TrianglePartition& cells,
                 TriangleOrder& order, bool with_cones) {
  Units units;
  const partition::TriangleSpan all = flat.span();
  std::array<std::vector<std::uint32_t>, kParts> parts;
  for (std::uint32_t cell = 0; cell < cells.cells(); ++cell) {
    const Triangles triangles = cells.triangles(cell);
    if (strategy == Strategy::simple) {
      add_runs(units, flat, triangles);
    } else if (strategy == Strategy::drawcall_wise) {
      add_copy(units, flat, triangles, order);
      if (with_cones) units.cones.push_back(cone_of(all, triangles, cells.region(cell)));
    } else {
      for (auto& part : parts) part.clear();
      for (const std::uint32_t triangle : triangles)
        parts[part_of(unit_normal(all[triangle]))].push_back(triangle);
      for (const auto& part : parts) {
        if (part.empty()) continue;
        add_copy(units, flat, part, order);
        units.cones.push_back(cone_of(all, part, cells.region(cell)));
      }
    }
    units.cell_start.push_back(static_cast<std::uint32_t>(units.range_start.size() - 1));
  }
  return units;
}

}  // namespace sightline::methods
