// What grid-cell and object-frustum share: the objects in a grid on the ground, and their volumes in its
// order.
#pragma once

#include <vector>

#include "workbench/methods/methods.hpp"
#include "workbench/partition/object_grid.hpp"
#include "workbench/submission/draw_list.hpp"
#include "workbench/submission/object_bounds.hpp"

namespace sightline::methods {

inline constexpr ParameterInfo kCellParameter{
    "cell", "metres, the side of a cell; 0 chooses about 64 objects a cell", "0", 0, 1e6};

struct GridObjects {
  const Scene& scene;
  submission::ObjectBounds bounds;  ///< in grid order
  partition::ObjectGrid grid;

  GridObjects(const Scene& scene, const Parameters& parameters);

  /// Buckets everything anew: a moved object may have changed its cell and its neighbours' bounds.
  void rebuild();

private:
  float cell_;
};

}  // namespace sightline::methods
