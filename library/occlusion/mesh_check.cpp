#include "library/occlusion/mesh_check.hpp"

#include "library/geometry/linear.hpp"
#include "library/occlusion/occluder_topology.hpp"

namespace sightline::occlusion {

Status check_mesh(std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
                  std::span<const Sides> sides) noexcept {
  constexpr std::size_t kMostTriangles = std::size_t{1} << 30;
  if (indices.size() % 3 != 0)
    return {StatusCode::bad_mesh, "occluder: expected three indices a triangle", indices.size()};
  if (indices.size() / 3 > kMostTriangles || positions.size() >= OccluderTopology::kNone)
    return {StatusCode::too_many, "occluder: expected at most 2^30 triangles and 2^32 - 2 positions"};
  if (sides.size() > 1 && sides.size() != indices.size() / 3)
    return {StatusCode::bad_mesh, "occluder: expected as many sides as triangles, one, or none",
            sides.size()};
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (!is_known(sides[i]))
      return {StatusCode::bad_argument, "occluder: sides are none, expected both or front", i};
  }
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!geometry::is_finite(positions[i]))
      return {StatusCode::bad_mesh, "occluder: a position is not finite", i};
  }
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] >= positions.size())
      return {StatusCode::bad_mesh, "occluder: an index names no position", i};
  }
  return {};
}

}  // namespace sightline::occlusion
