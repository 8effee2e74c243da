#include "scalar_cull.hpp"

namespace sightline::benchmarks {

std::size_t cull_boxes_scalar(const Frustum& frustum, const Boxes& boxes,
                              std::span<ObjectId> visible) noexcept {
  struct Corner {
    const float *x, *y, *z;
  };
  std::array<Corner, Frustum::sides> nearest;
  for (std::size_t p = 0; p < Frustum::sides; ++p) {
    const Vec3& n = frustum.planes[p].normal;
    nearest[p] = {n.x >= 0 ? boxes.max_x.data() : boxes.min_x.data(),
                  n.y >= 0 ? boxes.max_y.data() : boxes.min_y.data(),
                  n.z >= 0 ? boxes.max_z.data() : boxes.min_z.data()};
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
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
