#include "workbench/methods/object_frustum/grid_objects.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace sightline::methods {

namespace {

constexpr float kObjectsPerCell = 64;

float chosen_cell(const Box& all, std::size_t objects) {
  const float area =
      std::max((all.max.x - all.min.x) * (all.max.z - all.min.z), std::numeric_limits<float>::min());
  return std::sqrt(area * kObjectsPerCell / static_cast<float>(objects));
}

}  // namespace

GridObjects::GridObjects(const Scene& of, const Parameters& parameters)
    : scene(of),
      bounds(submission::volume_from(parameters)),
      cell_(static_cast<float>(parameters.number("cell"))) {
  rebuild();
}

void GridObjects::rebuild() {
  const Box extent = submission::volume_extent(scene);
  std::vector<ObjectId> order(scene.size());
  std::iota(order.begin(), order.end(), ObjectId{0});
  bounds.assign(scene, order);
  // A sphere's box and the sphere itself round differently: a little more room keeps "cell outside" certain.
  const float slack = 4 * std::numeric_limits<float>::epsilon() *
                      std::max({std::fabs(extent.min.x), std::fabs(extent.min.y), std::fabs(extent.min.z),
                                std::fabs(extent.max.x), std::fabs(extent.max.y), std::fabs(extent.max.z)});
  Boxes volumes;
  volumes.resize(scene.size());
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const Box b = bounds.box(i);
    volumes.set(i, {{b.min.x - slack, b.min.y - slack, b.min.z - slack},
                    {b.max.x + slack, b.max.y + slack, b.max.z + slack}});
  }
  grid.build(volumes, cell_ > 0 ? cell_ : chosen_cell(extent, scene.size()));
  bounds.assign(scene, grid.order());
}

}  // namespace sightline::methods
