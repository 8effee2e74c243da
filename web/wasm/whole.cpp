// What the whole module has beside `core`: occlusion and rays.
#include <algorithm>
#include <cmath>
#include <vector>

#include <sightline/occlusion.hpp>
#include <sightline/rays.hpp>

#include "web/wasm/glue.hpp"

namespace sightline::web {

namespace {

// How far from a pixel's centre a sample of it can lie, in metres, at a depth along the view.
class PixelReach {
public:
  explicit PixelReach(const WorldView& view) noexcept
      : view_(view.view), constant_(is_orthographic(view.view)) {
    const float wide = 1 / (std::fabs(view_.eye_to_clip.m[0]) * static_cast<float>(view_.width));
    const float high = 1 / (std::fabs(view_.eye_to_clip.m[5]) * static_cast<float>(view_.height));
    per_metre_ = std::sqrt(wide * wide + high * high) * 1.001f;  // which rounding does not eat up
  }

  /// Anywhere in a box, in metres about the view's origin.
  [[nodiscard]] double of(const WorldBox& box) const noexcept {
    if (constant_) return per_metre_;
    const auto& m = view_.world_to_eye.m;
    const double depth = -(farthest(m[2], box.min.x, box.max.x) + farthest(m[6], box.min.y, box.max.y) +
                           farthest(m[10], box.min.z, box.max.z) + m[14]);
    return std::max(depth, 0.0) * per_metre_;
  }

private:
  static double farthest(float row, double low, double high) noexcept {
    return std::min(row * low, row * high);
  }

  View view_;
  bool constant_;
  float per_metre_;
};

}  // namespace

extern "C" {

// --- occluders made of meshes ---

/// Null where it is refused.
SIGHTLINE_WEB(mesh_create)
OccluderMesh* mesh_create(const Vec3* positions, std::size_t position_count, const std::uint32_t* indices,
                          std::size_t index_count, std::uint32_t sides) {
  auto mesh =
      OccluderMesh::make({positions, position_count}, {indices, index_count}, static_cast<Sides>(sides));
  keep(mesh.error());
  return mesh ? new OccluderMesh(std::move(*mesh)) : nullptr;
}
SIGHTLINE_WEB(mesh_destroy) void mesh_destroy(OccluderMesh* mesh) {
  delete mesh;
}
SIGHTLINE_WEB(mesh_triangles) std::size_t mesh_triangles(const OccluderMesh* mesh) {
  return mesh->triangles();
}

// --- the depth buffer ---

SIGHTLINE_WEB(occlusion_create) OcclusionBuffer* occlusion_create() {
  return new OcclusionBuffer;
}
SIGHTLINE_WEB(occlusion_destroy) void occlusion_destroy(OcclusionBuffer* buffer) {
  delete buffer;
}
SIGHTLINE_WEB(occlusion_begin)
std::uint32_t occlusion_begin(OcclusionBuffer* buffer, const WorldView* view, std::uint32_t coverage,
                              std::uint32_t scale) {
  return keep(buffer->begin(*view, {static_cast<Coverage>(coverage), scale}));
}
SIGHTLINE_WEB(occlusion_draw_boxes)
std::uint32_t occlusion_draw_boxes(OcclusionBuffer* buffer, Layout layout, const void* first,
                                   std::size_t stride, std::size_t count, double x, double y, double z) {
  return keep(buffer->draw_boxes(boxes_of(layout, first, stride, count, {x, y, z})));
}
/// Four columns of `count` numbers.
SIGHTLINE_WEB(occlusion_draw_spheres)
std::uint32_t occlusion_draw_spheres(OcclusionBuffer* buffer, const float* first, std::size_t count) {
  return keep(buffer->draw_spheres(
      SphereView::arrays(first, first + count, first + 2 * count, first + 3 * count, count)));
}
SIGHTLINE_WEB(occlusion_draw_mesh)
std::uint32_t occlusion_draw_mesh(OcclusionBuffer* buffer, const OccluderMesh* mesh, const Mat4* transform) {
  return keep(buffer->draw_mesh(*mesh, *transform));
}
SIGHTLINE_WEB(occlusion_may_see)
std::uint32_t occlusion_may_see(const OcclusionBuffer* buffer, Layout layout, const void* first,
                                std::size_t stride, std::size_t count, double x, double y, double z,
                                std::uint8_t* visible) {
  return keep(buffer->may_see(boxes_of(layout, first, stride, count, {x, y, z}), {visible, count}));
}
SIGHTLINE_WEB(occlusion_read_nearness)
std::uint32_t occlusion_read_nearness(const OcclusionBuffer* buffer, float* pixels, std::size_t count) {
  return keep(buffer->read_nearness({pixels, count}));
}

/// Takes `bit` out of the masks of what no sample anywhere in a pixel can see, given that occluders were
/// drawn smaller by a sample's reach: the box of ids[i], minimum and maximum at 6 · ids[i], grows by it, so
/// that it holds, for each point of it that a sample might see, one at the same depth before the pixel's
/// centre. Returns how many were hidden.
SIGHTLINE_WEB(occlusion_hide)
std::size_t occlusion_hide(const OcclusionBuffer* buffer, const double* boxes, const std::uint32_t* ids,
                           std::uint8_t* masks, std::size_t count, std::uint32_t bit) {
  constexpr std::size_t kBatch = 256;
  const PixelReach reach(buffer->view());
  const WorldPoint& origin = buffer->view().origin;
  WorldBox batch[kBatch];
  std::size_t at[kBatch];
  std::uint8_t seen[kBatch];
  std::size_t waiting = 0, hidden = 0;
  const auto ask = [&] {
    if (!buffer->may_see(BoxView(std::span(batch, waiting)), {seen, waiting})) return;
    for (std::size_t k = 0; k < waiting; ++k) {
      if (seen[k]) continue;
      masks[at[k]] &= static_cast<std::uint8_t>(~bit);
      ++hidden;
    }
  };
  for (std::size_t i = 0; i < count; ++i) {
    if (!(masks[i] & bit)) continue;
    const double* b = boxes + std::size_t{6} * ids[i];
    const WorldBox box{{b[0] - origin.x, b[1] - origin.y, b[2] - origin.z},
                       {b[3] - origin.x, b[4] - origin.y, b[5] - origin.z}};
    const double by = reach.of(box);
    batch[waiting] = {{b[0] - by, b[1] - by, b[2] - by}, {b[3] + by, b[4] + by, b[5] + by}};
    at[waiting++] = i;
    if (waiting == kBatch) ask(), waiting = 0;
  }
  ask();
  return hidden;
}

// --- rays ---

SIGHTLINE_WEB(bvh_create) BoxBvh* bvh_create() {
  return new BoxBvh;
}
SIGHTLINE_WEB(bvh_destroy) void bvh_destroy(BoxBvh* bvh) {
  delete bvh;
}
SIGHTLINE_WEB(bvh_build)
std::uint32_t bvh_build(BoxBvh* bvh, Layout layout, const void* first, std::size_t stride, std::size_t count,
                        double x, double y, double z) {
  return keep(bvh->build(boxes_of(layout, first, stride, count, {x, y, z}), {x, y, z}));
}
SIGHTLINE_WEB(bvh_refit)
std::uint32_t bvh_refit(BoxBvh* bvh, Layout layout, const void* first, std::size_t stride, std::size_t count,
                        double x, double y, double z) {
  return keep(bvh->refit(boxes_of(layout, first, stride, count, {x, y, z})));
}
SIGHTLINE_WEB(bvh_size) std::size_t bvh_size(const BoxBvh* bvh) {
  return bvh->size();
}
SIGHTLINE_WEB(bvh_cast)
std::uint32_t bvh_cast(BoxBvh* bvh, const Ray* rays, std::size_t count, ObjectId* objects, float* distances) {
  static_assert(sizeof(Ray) == 28);
  return keep(bvh->cast({rays, count}, {objects, count}, {distances, count}));
}
SIGHTLINE_WEB(bvh_visible_set)
std::uint32_t bvh_visible_set(BoxBvh* bvh, const WorldView* view, std::uint32_t columns, std::uint32_t rows,
                              ObjectId* visible, double* result) {
  const auto seen = bvh->visible_set(*view, columns, rows, {visible, bvh->size()});
  if (seen) *result = static_cast<double>(*seen);
  return keep(seen.error());
}

}  // extern "C"

}  // namespace sightline::web
