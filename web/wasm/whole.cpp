// What the whole module has beside `core`: occlusion and rays.
#include <algorithm>

#include <hwy/highway.h>

#include <sightline/occlusion.hpp>
#include <sightline/rays.hpp>

#include "web/wasm/glue.hpp"

namespace sightline::web {

namespace hn = hwy::HWY_NAMESPACE;

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

/// Takes over to `known` which of `count` matrices, of 16 numbers, are others bit for bit; writes their
/// indices to `moved` and returns how many.
SIGHTLINE_WEB(moved_matrices)
std::size_t moved_matrices(const std::uint32_t* now, std::uint32_t* known, std::size_t count,
                           std::uint32_t* moved) {
  constexpr std::size_t kNumbers = 16;
  const hn::Full128<std::uint32_t> d;
  const auto differ = [&](std::size_t k) { return hn::Xor(hn::Load(d, now + k), hn::Load(d, known + k)); };
  std::size_t found = 0;
  for (std::size_t i = 0; i < count; ++i, now += kNumbers, known += kNumbers) {
    const auto other = hn::Or(hn::Or(differ(0), differ(4)), hn::Or(differ(8), differ(12)));
    if (hn::AllFalse(d, hn::Ne(other, hn::Zero(d)))) continue;
    std::copy(now, now + kNumbers, known);
    moved[found++] = static_cast<std::uint32_t>(i);
  }
  return found;
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
