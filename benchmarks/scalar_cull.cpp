#include "scalar_cull.hpp"

namespace sightline::benchmarks {

std::size_t cull_boxes_scalar(const Frustum& frustum, const BoxSpan& boxes,
                              std::span<ObjectId> visible) noexcept {
  struct Corner {
    const float *x, *y, *z;
  };
  std::array<Corner, Frustum::sides> nearest;
  for (std::size_t p = 0; p < Frustum::sides; ++p) {
    const Vec3& n = frustum.planes[p].normal;
    nearest[p] = {n.x >= 0 ? boxes.max_x : boxes.min_x, n.y >= 0 ? boxes.max_y : boxes.min_y,
                  n.z >= 0 ? boxes.max_z : boxes.min_z};
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < boxes.count; ++i) {
    bool inside = true;
    for (std::size_t p = 0; p < Frustum::sides; ++p) {
      inside &= signed_distance(frustum.planes[p], nearest[p].x[i], nearest[p].y[i], nearest[p].z[i]) >= 0;
    }
    visible[kept] = static_cast<ObjectId>(i);
    kept += inside;
  }
  return kept;
}

}  // namespace sightline::benchmarks
