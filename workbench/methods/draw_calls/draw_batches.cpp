#include "workbench/methods/draw_calls/draw_batches.hpp"

#include <algorithm>

namespace sightline::methods {

namespace {

using Triangles = std::span<const std::uint32_t>;

void end_batch(DrawBatches& batches, const FlatTriangles& flat, Triangles triangles) {
  batches.range_start.push_back(static_cast<std::uint32_t>(batches.ranges.size()));
  // Triangles ascend, and a scene's triangles stand object by object, so equal objects are neighbours.
  const std::size_t first = batches.objects.size();
  for (const std::uint32_t triangle : triangles) {
    const ObjectId object = flat.objects[triangle];
    if (batches.objects.size() == first || batches.objects.back() != object)
      batches.objects.push_back(object);
  }
  batches.object_start.push_back(static_cast<std::uint32_t>(batches.objects.size()));
}

/// Runs of triangles that stand side by side; position(t) is where.
template <class Position>
void add_runs(DrawBatches& batches, const FlatTriangles& flat, Triangles triangles, Position position) {
  for (std::size_t i = 0; i < triangles.size();) {
    const std::uint32_t first = position(triangles[i]);
    std::uint32_t count = 1;
    while (i + count < triangles.size() && position(triangles[i + count]) == first + count) ++count;
    batches.ranges.push_back({first, count});
    i += count;
  }
  end_batch(batches, flat, triangles);
}

void add_copy(DrawBatches& batches, const FlatTriangles& flat, Triangles triangles, TriangleOrder& order) {
  batches.ranges.push_back(
      {static_cast<std::uint32_t>(order.size()), static_cast<std::uint32_t>(triangles.size())});
  order.insert(order.end(), triangles.begin(), triangles.end());
  end_batch(batches, flat, triangles);
}

}  // namespace

std::uint64_t DrawBatches::bytes() const noexcept {
  return 4 * (cell_start.size() + range_start.size() + object_start.size() + objects.size()) +
         ranges.size() * sizeof(TriangleRange) + cones.size() * sizeof(FacingCone);
}

namespace {

/// Batches by the rules, their ranges made by add(batches, triangles).
template <class Add>
DrawBatches batches_of(const BatchRules& rules, const FlatTriangles& flat,
                       const partition::TrianglePartition& cells, Add add) {
  DrawBatches batches;
  const partition::TriangleSpan all = flat.span();
  // What is drawn from both sides may always face the eye, and is a part of its own.
  const auto has_back = [&](std::uint32_t t) { return flat.sides[flat.objects[t]] == Sides::both; };
  const auto cone = [&](Triangles triangles, std::uint32_t cell) {
    return std::ranges::any_of(triangles, has_back)
               ? FacingCone{}
               : cone_of(all, triangles, cells.region(cell), rules.planes);
  };
  std::array<std::vector<std::uint32_t>, kParts + 1> parts;
  for (std::uint32_t cell = 0; cell < cells.cells(); ++cell) {
    const Triangles triangles = cells.triangles(cell);
    if (rules.strategy != Strategy::zhang) {
      add(batches, triangles);
      if (rules.with_cones) batches.cones.push_back(cone(triangles, cell));
    } else {
      for (auto& part : parts) part.clear();
      for (const std::uint32_t triangle : triangles)
        parts[has_back(triangle) ? kParts : part_of(unit_normal(all[triangle]), rules.planes)].push_back(
            triangle);
      for (const auto& part : parts) {
        if (part.empty()) continue;
        add(batches, part);
        batches.cones.push_back(cone(part, cell));
      }
    }
    batches.cell_start.push_back(static_cast<std::uint32_t>(batches.range_start.size() - 1));
  }
  return batches;
}

}  // namespace

DrawBatches make_draw_batches(const BatchRules& rules, const FlatTriangles& flat,
                              const partition::TrianglePartition& cells, TriangleOrder& order) {
  return batches_of(rules, flat, cells, [&](DrawBatches& batches, Triangles triangles) {
    if (rules.strategy == Strategy::simple) {
      add_runs(batches, flat, triangles, [](std::uint32_t triangle) { return triangle; });
    } else {
      add_copy(batches, flat, triangles, order);
    }
  });
}

DrawBatches make_blended_batches(const BatchRules& rules, const FlatTriangles& flat,
                                 const partition::TrianglePartition& cells,
                                 std::span<const std::uint32_t> triangles,
                                 std::span<const std::uint32_t> positions) {
  const auto position = [&](std::uint32_t triangle) {
    return positions[static_cast<std::size_t>(std::ranges::lower_bound(triangles, triangle) -
                                              triangles.begin())];
  };
  return batches_of(rules, flat, cells,
                    [&](DrawBatches& batches, Triangles some) { add_runs(batches, flat, some, position); });
}

}  // namespace sightline::methods
