// Occluders, occludees, and the depth of one view.
#include <sightline/occlusion.hpp>

#include <algorithm>
#include <vector>

#include "bindings/c/calls.hpp"

struct sightline_occluder_mesh {
  sightline::OccluderMesh mesh;
};
struct sightline_occludees {
  sightline::OccludeeTriangles triangles;
};

using namespace sightline;
using namespace sightline::c_api;

namespace {

// What boxes and spheres have in common: View is BoxView or SphereView, Given the C struct for it.
template <class View, class Given>
sightline_status draw(sightline_occlusion* occlusion, const Given* volumes,
                      Status (OcclusionBuffer::*draw_them)(const View&) noexcept) {
  if (!occlusion || !volumes) return refuse("occlusion: the occlusion or what to draw is NULL");
  View view;
  if (const Status ok = take(*volumes, view); !ok) return keep(ok);
  return keep((occlusion->buffer.*draw_them)(view));
}

template <class View, class Given>
sightline_status may_see(const sightline_occlusion* occlusion, const Given* volumes, uint8_t* visible,
                         size_t capacity) {
  if (!occlusion || !volumes || !can_hold(visible, capacity))
    return refuse("occlusion: a pointer is NULL, or the capacity more than memory holds");
  View view;
  if (const Status ok = take(*volumes, view); !ok) return keep(ok);
  return keep(occlusion->buffer.may_see(view, {visible, capacity}));
}

}  // namespace

extern "C" {

sightline_status sightline_occluder_mesh_create(const float* positions, size_t position_count,
                                                const uint32_t* indices, size_t index_count,
                                                const uint8_t* sides, size_t side_count,
                                                sightline_occluder_mesh** mesh) {
  if (!mesh) return refuse("occluder mesh: what to write to is NULL");
  const auto points = points_of(positions, position_count);
  if (!can_hold(points.data(), position_count) || !can_hold(indices, index_count) ||
      !can_hold(sides, side_count))
    return refuse("occluder mesh: positions, indices or sides are NULL, or more than memory holds");
  std::vector<Sides> drawn(side_count);
  for (std::size_t i = 0; i < side_count; ++i) {
    if (sides[i] > SIGHTLINE_FRONT_SIDE)
      return keep({StatusCode::bad_argument, "occluder mesh: expected both sides or the front", i});
    drawn[i] = static_cast<Sides>(sides[i]);
  }
  Result<OccluderMesh> made = OccluderMesh::make(points, {indices, index_count}, drawn);
  if (!made) return keep(made.error());
  *mesh = new sightline_occluder_mesh{*std::move(made)};
  return SIGHTLINE_OK;
}
void sightline_occluder_mesh_destroy(sightline_occluder_mesh* mesh) {
  delete mesh;
}
size_t sightline_occluder_mesh_triangles(const sightline_occluder_mesh* mesh) {
  return mesh ? mesh->mesh.triangles() : 0;
}

sightline_occludees* sightline_occludees_create(void) {
  return new sightline_occludees;
}
void sightline_occludees_destroy(sightline_occludees* occludees) {
  delete occludees;
}

sightline_status sightline_occludees_assign(sightline_occludees* occludees, const float* corners,
                                            size_t corner_count, const uint32_t* triangles_per_object,
                                            size_t object_count) {
  const auto points = points_of(corners, corner_count);
  if (!occludees || !can_hold(points.data(), corner_count) || !can_hold(triangles_per_object, object_count))
    return refuse("occludees: a pointer is NULL, or a count more than memory holds");
  return keep(occludees->triangles.assign(points, {triangles_per_object, object_count}));
}

sightline_status sightline_occludees_set(sightline_occludees* occludees, uint32_t object,
                                         const float* corners, size_t corner_count) {
  const auto points = points_of(corners, corner_count);
  if (!occludees || !can_hold(points.data(), corner_count))
    return refuse("occludees: a pointer is NULL, or a count more than memory holds");
  return keep(occludees->triangles.set(object, points));
}

uint32_t sightline_occludees_objects(const sightline_occludees* occludees) {
  return occludees ? occludees->triangles.objects() : 0;
}
uint32_t sightline_occludees_triangles(const sightline_occludees* occludees, uint32_t object) {
  return occludees ? occludees->triangles.triangles(object) : 0;
}

sightline_occlusion* sightline_occlusion_create(void) {
  return new sightline_occlusion;
}
void sightline_occlusion_destroy(sightline_occlusion* occlusion) {
  delete occlusion;
}

sightline_status sightline_occlusion_begin(sightline_occlusion* occlusion, const sightline_view* view) {
  if (!occlusion || !view) return refuse("occlusion: the occlusion or the view is NULL");
  return keep(occlusion->buffer.begin(view_of(*view)));
}

sightline_status sightline_occlusion_view(const sightline_occlusion* occlusion, sightline_view* view) {
  if (!occlusion || !view) return refuse("occlusion: the occlusion or the view is NULL");
  if (!occlusion->buffer.begun())
    return keep({StatusCode::stale_buffer, "occlusion: it has no view, expected a begin before"});
  *view = view_of(occlusion->buffer.view());
  return SIGHTLINE_OK;
}

sightline_status sightline_occlusion_draw_boxes(sightline_occlusion* occlusion,
                                                const sightline_box_view* boxes) {
  return draw<BoxView>(occlusion, boxes, &OcclusionBuffer::draw_boxes);
}

sightline_status sightline_occlusion_draw_spheres(sightline_occlusion* occlusion,
                                                  const sightline_sphere_view* spheres) {
  return draw<SphereView>(occlusion, spheres, &OcclusionBuffer::draw_spheres);
}

sightline_status sightline_occlusion_draw_mesh(sightline_occlusion* occlusion,
                                               const sightline_occluder_mesh* mesh,
                                               const float transform[16]) {
  if (!occlusion || !mesh) return refuse("occlusion: the occlusion or the mesh is NULL");
  Mat4 matrix;
  if (transform) std::copy_n(transform, 16, matrix.m.begin());
  return keep(occlusion->buffer.draw_mesh(mesh->mesh, matrix));
}

sightline_status sightline_occlusion_may_see_boxes(const sightline_occlusion* occlusion,
                                                   const sightline_box_view* boxes, uint8_t* visible,
                                                   size_t capacity) {
  return may_see<BoxView>(occlusion, boxes, visible, capacity);
}

sightline_status sightline_occlusion_may_see_spheres(const sightline_occlusion* occlusion,
                                                     const sightline_sphere_view* spheres, uint8_t* visible,
                                                     size_t capacity) {
  return may_see<SphereView>(occlusion, spheres, visible, capacity);
}

sightline_status sightline_occlusion_may_see_triangles(const sightline_occlusion* occlusion,
                                                       const float* corners, size_t corner_count,
                                                       int* visible) {
  const auto points = points_of(corners, corner_count);
  if (!occlusion || !can_hold(points.data(), corner_count) || !visible)
    return refuse("occlusion: a pointer is NULL, or the corners more than memory holds");
  *visible = occlusion->buffer.may_see(points) ? 1 : 0;
  return SIGHTLINE_OK;
}

sightline_status sightline_occlusion_keep_seen(const sightline_occlusion* occlusion,
                                               const sightline_occludees* occludees, uint32_t* objects,
                                               size_t count, size_t* kept) {
  if (!occlusion || !occludees || !can_hold(objects, count) || !kept)
    return refuse("occlusion: a pointer is NULL, or the objects more than memory holds");
  *kept = occlusion->buffer.keep_seen(occludees->triangles, {objects, count});
  return SIGHTLINE_OK;
}

sightline_status sightline_occlusion_read_nearness(const sightline_occlusion* occlusion, float* pixels,
                                                   size_t capacity) {
  if (!occlusion || !can_hold(pixels, capacity))
    return refuse("occlusion: a pointer is NULL, or the pixels more than memory holds");
  return keep(occlusion->buffer.read_nearness({pixels, capacity}));
}

}  // extern "C"
