#include "workbench/methods/draw_calls/units.hpp"

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

/// Runs of triangles that stand side by side; position(t) is where.
template <class Position>
void add_runs(Units& units, const FlatTriangles& flat, Triangles triangles, Position position) {
  for (std::size_t i = 0; i < triangles.size();) {
    const std::uint32_t first = position(triangles[i]);
    std::uint32_t count = 1;
    while (i + count < triangles.size() && position(triangles[i + count]) == first + count) ++count;
    units.ranges.push_back({first, count});
    i += count;
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

namespace {

/// Units of a strategy's kind, their ranges made by add(units, triangles).
template <class Add>
Units units_of(Strategy strategy, const FlatTriangles& flat, const partition::TrianglePartition& cells,
               bool with_cones, Add add) {
  Units units;
  const partition::TriangleSpan all = flat.span();
  std::array<std::vector<std::uint32_t>, kParts> parts;
  for (std::uint32_t cell = 0; cell < cells.cells(); ++cell) {
    const Triangles triangles = cells.triangles(cell);
    if (strategy != Strategy::zhang) {
      add(units, triangles);
      if (with_cones) units.cones.push_back(cone_of(all, triangles, cells.region(cell)));
    } else {
      for (auto& part : parts) part.clear();
      for (const std::uint32_t triangle : triangles)
        parts[part_of(unit_normal(all[triangle]))].push_back(triangle);
      for (const auto& part : parts) {
        if (part.empty()) continue;
        add(units, part);
        units.cones.push_back(cone_of(all, part, cells.region(cell)));
      }
    }
    units.cell_start.push_back(static_cast<std::uint32_t>(units.range_start.size() - 1));
  }
  return units;
}

}  // namespace

Units make_units(Strategy strategy, const FlatTriangles& flat, const partition::TrianglePartition& cells,
                 TriangleOrder& order, bool with_cones) {
  return units_of(strategy, flat, cells, with_cones, [&](Units& units, Triangles triangles) {
    if (strategy == Strategy::simple) {
      add_runs(units, flat, triangles, [](std::uint32_t triangle) { return triangle; });
    } else {
      add_copy(units, flat, triangles, order);
    }
  });
}

Units make_blended_units(Strategy strategy, const FlatTriangles& flat,
                         const partition::TrianglePartition& cells, std::span<const std::uint32_t> triangles,
                         std::span<const std::uint32_t> positions, bool with_cones) {
  const auto position = [&](std::uint32_t triangle) {
    return positions[static_cast<std::size_t>(std::ranges::lower_bound(triangles, triangle) -
                                              triangles.begin())];
  };
  return units_of(strategy, flat, cells, with_cones,
                  [&](Units& units, Triangles some) { add_runs(units, flat, some, position); });
}

}  // namespace sightline::methods
