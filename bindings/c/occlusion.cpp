// Occluders, occludees, and the depth of one view.
#include <sightline/occlusion.hpp>

#include <algorithm>
#include <cstddef>
#include <cstring>
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

// What boxes and spheres have in common: Taken is BoxView or GivenSpheres, Given the C struct for it.
template <class Taken, class View, class Given>
sightline_status draw(sightline_occlusion* occlusion, const Given* volumes,
                      Status (OcclusionBuffer::*draw_them)(const View&) noexcept) {
  if (!occlusion || !volumes) return refuse("occlusion: the occlusion or what to draw is NULL");
  Taken view;
  if (const Status ok = take(*volumes, view); !ok) return keep(ok);
  return keep((occlusion->buffer.*draw_them)(view));
}

template <class Taken, class Given>
sightline_status may_see(const sightline_occlusion* occlusion, const Given* volumes, uint8_t* visible,
                         size_t capacity) {
  if (!occlusion || !volumes || !can_hold(visible, capacity))
    return refuse("occlusion: a pointer is NULL, or the capacity more than memory holds");
  Taken view;
  if (const Status ok = take(*volumes, view); !ok) return keep(ok);
  return keep(occlusion->buffer.may_see(view, {visible, capacity}));
}

// What the library refuses by counts alone: here before anything is copied for it.
Status check_counts(std::size_t positions, std::size_t indices, std::size_t sides) {
  constexpr std::size_t kMostTriangles = std::size_t{1} << 30, kMostPositions = 0xfffffffe;
  if (indices % 3 != 0) return {StatusCode::bad_mesh, "occluder: expected three indices a triangle", indices};
  if (indices / 3 > kMostTriangles || positions > kMostPositions)
    return {StatusCode::too_many, "occluder: expected at most 2^30 triangles and 2^32 - 2 positions"};
  if (sides > 1 && sides != indices / 3)
    return {StatusCode::bad_mesh, "occluder: expected as many sides as triangles, one, or none", sides};
  return {};
}

}  // namespace

Status c_api::take_mesh(const float* positions, size_t position_count, const uint32_t* indices,
                        size_t index_count, const uint8_t* sides, size_t side_count,
                        std::vector<Sides>& drawn) {
  if (!can_hold(points_of(positions, position_count).data(), position_count) ||
      !can_hold(indices, index_count) || !can_hold(sides, side_count))
    return {StatusCode::bad_argument,
            "occluder: positions, indices or sides are NULL, or more than memory holds"};
  if (const Status ok = check_counts(position_count, index_count, side_count); !ok) return ok;
  drawn.resize(side_count);
  for (std::size_t i = 0; i < side_count; ++i) {
    if (sides[i] > SIGHTLINE_FRONT_SIDE)
      return {StatusCode::bad_argument, "occluder: expected both sides or the front", i};
    drawn[i] = static_cast<Sides>(sides[i]);
  }
  return {};
}

extern "C" {

sightline_status sightline_occluder_mesh_create(const float* positions, size_t position_count,
                                                const uint32_t* indices, size_t index_count,
                                                const uint8_t* sides, size_t side_count,
                                                sightline_occluder_mesh** mesh) {
  if (!mesh) return refuse("occluder mesh: what to write to is NULL");
  const auto points = points_of(positions, position_count);
  std::vector<Sides> drawn;
  if (const Status ok = take_mesh(positions, position_count, indices, index_count, sides, side_count, drawn);
      !ok)
    return keep(ok);
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

sightline_status sightline_occluder_create(const float* positions, size_t position_count,
                                           const uint32_t* indices, size_t index_count, const uint8_t* sides,
                                           size_t side_count, uint32_t most_triangles, uint32_t most_boxes,
                                           sightline_occluder** occluder) {
  if (!occluder) return refuse("occluder: what to write to is NULL");
  std::vector<Sides> drawn;
  if (const Status ok = take_mesh(positions, position_count, indices, index_count, sides, side_count, drawn);
      !ok)
    return keep(ok);
  Result<Occluder> made = make_occluder(points_of(positions, position_count), {indices, index_count}, drawn,
                                        {most_triangles, most_boxes});
  if (!made) return keep(made.error());
  *occluder = new sightline_occluder{*std::move(made)};
  return SIGHTLINE_OK;
}
void sightline_occluder_destroy(sightline_occluder* occluder) {
  delete occluder;
}
sightline_status sightline_occluder_contents(const sightline_occluder* occluder,
                                             sightline_occluder_parts* parts) {
  if (!occluder || !parts) return refuse("occluder: it or the parts are NULL");
  sightline_occluder_parts p = sightline_occluder_parts_default();
  constexpr std::size_t kFirstSize = SIGHTLINE_FIRST_SIZE(sightline_occluder_parts, box_count);
  if (!knows<sightline_occluder_parts>(parts->struct_size, kFirstSize))
    return refuse("occluder: a struct_size is unknown, expected that of sightline_occluder_parts_default");
  const Occluder& of = occluder->occluder;
  static_assert(sizeof(Vec3) == 3 * sizeof(float) && sizeof(Box) == 6 * sizeof(float) && sizeof(Sides) == 1);
  p.struct_size = parts->struct_size, p.yield = static_cast<std::uint32_t>(of.yield);
  p.positions = reinterpret_cast<const float*>(of.positions.data()), p.position_count = of.positions.size();
  p.indices = of.indices.data(), p.index_count = of.indices.size();
  p.sides = reinterpret_cast<const std::uint8_t*>(of.sides.data()), p.solid_triangles = of.solid_triangles;
  p.boxes = reinterpret_cast<const float*>(of.boxes.data()), p.box_count = of.boxes.size();
  std::memcpy(parts, &p, p.struct_size);
  return SIGHTLINE_OK;
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

sightline_status sightline_occlusion_begin_with(sightline_occlusion* occlusion, const sightline_view* view,
                                                uint32_t coverage, uint32_t scale) {
  if (!occlusion || !view) return refuse("occlusion: the occlusion or the view is NULL");
  if (coverage > SIGHTLINE_COVERAGE_AREA)
    return refuse("occlusion: the coverage is none, expected centres or area");
  return keep(occlusion->buffer.begin(view_of(*view), {static_cast<Coverage>(coverage), scale}));
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
  return draw<GivenSpheres>(occlusion, spheres, &OcclusionBuffer::draw_spheres);
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
  return may_see<GivenSpheres>(occlusion, spheres, visible, capacity);
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
