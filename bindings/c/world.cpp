// Worlds, and their culling.
#include <sightline/world.hpp>

#include <array>
#include <vector>

#include "bindings/c/calls.hpp"

using namespace sightline;
using namespace sightline::c_api;

namespace {

static_assert(sizeof(sightline_handle) == sizeof(Handle) &&
              offsetof(sightline_handle, generation) == offsetof(Handle, generation));
static_assert(SIGHTLINE_MAX_LEVELS == kMaxLevels && SIGHTLINE_NO_LEVELS == kNoLevels);
static_assert(SIGHTLINE_NO_OBJECT == kNoObject && SIGHTLINE_ALL_LAYERS == kAllLayers &&
              SIGHTLINE_MAX_VIEWS == kMaxViews && SIGHTLINE_OWN_VIEW == kOwnView &&
              SIGHTLINE_NO_OCCLUDER == kNoOccluder);
static_assert(sizeof(sightline_occluder_placement) == sizeof(OccluderPlacement) &&
              offsetof(sightline_occluder_placement, transform) == offsetof(OccluderPlacement, transform) &&
              offsetof(sightline_occluder_placement, origin) == offsetof(OccluderPlacement, origin));

Status take(const sightline_object_columns& given, ObjectColumns& columns) {
  sightline_object_columns c = sightline_object_columns_default();
  if (!take_struct(&given, SIGHTLINE_FIRST_SIZE(sightline_object_columns, values), c) || c.reserved != 0) {
    return {StatusCode::bad_argument,
            "columns: a struct_size is unknown, expected that of sightline_object_columns_default"};
  }
  columns = {read(c.layers), read(c.values), read(c.distances)};
  return {};
}

Status take(const sightline_cull_options* given, CullOptions& options) {
  sightline_cull_options o = sightline_cull_options_default();
  if (given && (!take_struct(given, SIGHTLINE_FIRST_SIZE(sightline_cull_options, jobs), o) ||
                o.values_for_ids > 1 || o.occlusion > SIGHTLINE_OCCLUSION_AUTOMATIC ||
                o.coverage > SIGHTLINE_COVERAGE_AREA || o.reserved != 0 || o.costs.reserved != 0)) {
    return {StatusCode::bad_argument,
            "cull: struct_size, values_for_ids, occlusion or coverage of the options are unknown, "
            "expected those of sightline_cull_options_default"};
  }
  options.values_for_ids = o.values_for_ids == 1;
  options.occlusion = static_cast<Occlusion>(o.occlusion);
  options.buffer = {static_cast<Coverage>(o.coverage), o.scale};
  const sightline_cull_costs& c = o.costs;
  options.costs = {c.object, c.node, c.test, c.candidate, c.tile, c.shape, c.triangle, c.query, c.occludee};
  options.zones = zones_of(o.zones);
  const sightline_level_options& l = o.levels;
  options.levels = {l.view, l.key, l.hysteresis, l.fade, l.scale, l.cut != 0};
  return c_api::take(o.jobs, options.jobs);
}

Status take(const sightline_cull_output& given, CullOutput& output) {
  sightline_cull_output o = sightline_cull_output_of(nullptr, nullptr, 0);
  if (!take_struct(&given, SIGHTLINE_FIRST_SIZE(sightline_cull_output, capacity), o) || o.reserved != 0) {
    return {StatusCode::bad_argument,
            "cull: a struct_size of the output is unknown, expected that of sightline_cull_output_of"};
  }
  if (!can_hold(o.ids, o.capacity)) {
    return {StatusCode::bad_argument, "cull: ids are NULL, or a capacity is more than memory holds"};
  }
  output.ids = {o.ids, o.capacity};
  if (o.masks) output.masks = {o.masks, o.capacity};
  if (o.levels) output.levels = {o.levels, o.capacity};
  if (o.fades) output.fades = {o.fades, o.capacity};
  return {};
}

Status stale() {
  return {StatusCode::stale_handle, "world: the handle names no object that stands"};
}

sightline_status add(sightline_world& world, const Occluder& occluder, std::span<const Sphere> spheres,
                     uint32_t* name) {
  const Result<OccluderId> added = world.world.add_occluder(occluder, spheres);
  if (!added) return keep(added.error());
  *name = *added;
  return SIGHTLINE_OK;
}

// Calls write(world, handle) where both are there and the handle's object stands.
template <class Write>
sightline_status read_object(const sightline_world* world, sightline_handle handle, const void* out,
                             Write write) {
  if (!world || !out) return refuse("world: the world, or what to write to, is NULL");
  const Handle h = handle_of(handle);
  if (!world->world.contains(h)) return keep(stale());
  write(world->world, h);
  return SIGHTLINE_OK;
}

}  // namespace

// The views stand as far apart as the caller's header has them.
Status c_api::take(const sightline_cull_view* given, std::size_t count, Views& views) noexcept {
  if (count < 1 || count > kMaxViews) {
    return {StatusCode::bad_argument, "cull: expected 1 to 8 views"};
  }
  const std::size_t stride = given->struct_size;
  const auto* at = reinterpret_cast<const std::byte*>(given);
  for (std::size_t i = 0; i < count; ++i, at += stride) {
    sightline_cull_view v = sightline_cull_view_of(nullptr);
    if (!take_struct(at, SIGHTLINE_FIRST_SIZE(sightline_cull_view, view), v) || v.struct_size != stride ||
        v.reserved != 0) {
      return {StatusCode::bad_argument,
              "cull: a struct_size of a view is unknown, expected that of sightline_cull_view_of", i};
    }
    views[i].view = view_of(v.view);
    views[i].occlusion = v.occlusion ? &v.occlusion->buffer : nullptr;
    views[i].layers = v.layers, views[i].min_area = v.min_area;
    views[i].distance_scale = v.distance_scale, views[i].distance_view = v.distance_view;
    views[i].casters = v.casters ? &v.casters->casters : nullptr;
  }
  return {};
}

extern "C" {

sightline_world* sightline_world_create(void) {
  return new sightline_world;
}
void sightline_world_destroy(sightline_world* world) {
  delete world;
}

sightline_status sightline_world_insert(sightline_world* world, const sightline_box_view* boxes,
                                        const sightline_handles* handles,
                                        const sightline_object_columns* columns) {
  if (!world || !boxes || !handles) return refuse("insert: the world, the boxes or the handles are NULL");
  BoxView view;
  ObjectColumns given;
  if (const Status ok = c_api::take(*boxes, view); !ok) return keep(ok);
  if (columns) {
    if (const Status ok = take(*columns, given); !ok) return keep(ok);
  }
  return keep(world->world.insert(view, {handles->first, handles->count, handles->stride}, given));
}

sightline_status sightline_world_move(sightline_world* world, const sightline_handles* handles,
                                      const sightline_box_view* boxes) {
  if (!world || !handles || !boxes) return refuse("move: the world, the handles or the boxes are NULL");
  BoxView view;
  if (const Status ok = c_api::take(*boxes, view); !ok) return keep(ok);
  return keep(world->world.move(read(*handles), view));
}

sightline_status sightline_world_remove(sightline_world* world, const sightline_handles* handles) {
  if (!world || !handles) return refuse("remove: the world or the handles are NULL");
  return keep(world->world.remove(read(*handles)));
}

sightline_status sightline_world_set_layers(sightline_world* world, const sightline_handles* handles,
                                            const sightline_column* layers) {
  if (!world || !handles || !layers)
    return refuse("set_layers: the world, the handles or the layers are NULL");
  return keep(world->world.set_layers(read(*handles), read(*layers)));
}

sightline_status sightline_world_set_values(sightline_world* world, const sightline_handles* handles,
                                            const sightline_column* values) {
  if (!world || !handles || !values)
    return refuse("set_values: the world, the handles or the values are NULL");
  return keep(world->world.set_values(read(*handles), read(*values)));
}

sightline_status sightline_world_set_distances(sightline_world* world, const sightline_handles* handles,
                                               const sightline_distances* distances) {
  if (!world || !handles || !distances)
    return refuse("set_distances: the world, the handles or the distances are NULL");
  return keep(world->world.set_distances(read(*handles), read(*distances)));
}

sightline_status sightline_world_add_occluder(sightline_world* world, const sightline_occluder* occluder,
                                              uint32_t* name) {
  if (!world || !occluder || !name)
    return refuse("add_occluder: the world, the occluder or the name is NULL");
  return add(*world, occluder->occluder, {}, name);
}

sightline_status sightline_world_add_solids(sightline_world* world, const float* boxes, size_t box_count,
                                            const float* spheres, size_t sphere_count, uint32_t* name) {
  if (!world || !name || !can_hold(boxes, box_count, 6) || !can_hold(spheres, sphere_count, 4))
    return refuse("add_solids: a pointer is NULL, or a count more than memory holds");
  Occluder occluder;
  std::vector<Sphere> balls;
  for (std::size_t i = 0; i < box_count; ++i) occluder.boxes.push_back(box_of(boxes + 6 * i));
  for (std::size_t i = 0; i < sphere_count; ++i) balls.push_back(sphere_of(spheres + 4 * i));
  return add(*world, occluder, balls, name);
}

sightline_status sightline_world_add_surface(sightline_world* world, const float* positions,
                                             size_t position_count, const uint32_t* indices,
                                             size_t index_count, const uint8_t* sides, size_t side_count,
                                             uint32_t* name) {
  if (!world || !name) return refuse("add_surface: the world or the name is NULL");
  Occluder occluder;
  if (const Status ok =
          take_mesh(positions, position_count, indices, index_count, sides, side_count, occluder.sides);
      !ok)
    return keep(ok);
  const auto points = points_of(positions, position_count);
  occluder.positions.assign(points.begin(), points.end());
  occluder.indices.assign(indices, indices + index_count);
  return add(*world, occluder, {}, name);
}

sightline_status sightline_world_remove_occluder(sightline_world* world, uint32_t name) {
  if (!world) return refuse("remove_occluder: the world is NULL");
  return keep(world->world.remove_occluder(name));
}

sightline_status sightline_world_set_occluders(sightline_world* world, const sightline_handles* handles,
                                               const sightline_occluder_placement* placements, size_t count) {
  if (!world || !handles || !can_hold(placements, count))
    return refuse("set_occluders: a pointer is NULL, or a count more than memory holds");
  for (std::size_t i = 0; i < count; ++i) {
    if (placements[i].reserved != 0)
      return keep({StatusCode::bad_argument, "set_occluders: expected 0 where a placement is reserved", i});
  }
  return keep(world->world.set_occluders(read(*handles), {placements, count, sizeof *placements}));
}

sightline_status sightline_world_set_occluding(sightline_world* world, const sightline_handles* handles,
                                               const uint8_t* on, size_t count) {
  if (!world || !handles || !can_hold(on, count))
    return refuse("set_occluding: a pointer is NULL, or a count more than memory holds");
  return keep(world->world.set_occluding(read(*handles), std::span(on, count)));
}

sightline_status sightline_world_set_triangles(sightline_world* world, sightline_handle handle,
                                               const float* corners, size_t corner_count,
                                               const double* origin, uint8_t sides) {
  const auto points = points_of(corners, corner_count);
  if (!world || !can_hold(points.data(), corner_count))
    return refuse("set_triangles: a pointer is NULL, or a count more than memory holds");
  const WorldPoint about = origin ? WorldPoint{origin[0], origin[1], origin[2]} : WorldPoint{};
  return keep(world->world.set_triangles(handle_of(handle), points, about, static_cast<Sides>(sides)));
}

sightline_status sightline_world_add_levels(sightline_world* world, const float* sizes, size_t count,
                                            uint32_t* name) {
  if (!world || !name || !can_hold(sizes, count))
    return refuse("add_levels: a pointer is NULL, or a count more than memory holds");
  const Result<LevelTableId> added = world->world.add_levels({sizes, count});
  if (!added) return keep(added.error());
  *name = *added;
  return SIGHTLINE_OK;
}

sightline_status sightline_world_set_levels(sightline_world* world, const sightline_handles* handles,
                                            const sightline_column* tables) {
  if (!world || !handles || !tables)
    return refuse("set_levels: the world, the handles or the tables are NULL");
  return keep(world->world.set_levels(read(*handles), read(*tables)));
}

size_t sightline_world_size(const sightline_world* world) {
  return world ? world->world.size() : 0;
}
size_t sightline_world_id_limit(const sightline_world* world) {
  return world ? world->world.id_limit() : 0;
}

int sightline_world_contains(const sightline_world* world, sightline_handle handle) {
  return world && world->world.contains(handle_of(handle));
}

sightline_handle sightline_world_handle(const sightline_world* world, uint32_t id) {
  const Handle handle = world ? world->world.handle(id) : Handle{};
  return {handle.index, handle.generation};
}

sightline_status sightline_world_box(const sightline_world* world, sightline_handle handle,
                                     sightline_box* box) {
  return read_object(world, handle, box, [&](const World& w, Handle h) {
    const WorldBox b = w.box(h);
    *box = {{b.min.x, b.min.y, b.min.z}, {b.max.x, b.max.y, b.max.z}};
  });
}
sightline_status sightline_world_layers(const sightline_world* world, sightline_handle handle,
                                        uint32_t* layers) {
  return read_object(world, handle, layers, [&](const World& w, Handle h) { *layers = w.layers(h); });
}
sightline_status sightline_world_value(const sightline_world* world, sightline_handle handle,
                                       uint32_t* value) {
  return read_object(world, handle, value, [&](const World& w, Handle h) { *value = w.value(h); });
}

sightline_status sightline_world_levels(const sightline_world* world, sightline_handle handle,
                                        uint32_t* table) {
  return read_object(world, handle, table, [&](const World& w, Handle h) { *table = w.levels(h); });
}

sightline_status sightline_world_distances(const sightline_world* world, sightline_handle handle,
                                           sightline_distance_range* distances) {
  return read_object(world, handle, distances, [&](const World& w, Handle h) {
    const DistanceRange d = w.distances(h);
    *distances = {d.min, d.max};
  });
}

size_t sightline_cull_capacity(const sightline_world* world, const sightline_cull_options* options) {
  CullOptions given;
  if (const Status ok = take(options, given); !ok) return keep(ok), 0;
  return world ? cull_capacity(world->world, given) : 0;
}

sightline_culler* sightline_culler_create(void) {
  return new sightline_culler;
}
void sightline_culler_destroy(sightline_culler* culler) {
  delete culler;
}

sightline_status sightline_cull(sightline_culler* culler, const sightline_world* world,
                                const sightline_cull_view* views, size_t view_count,
                                const sightline_cull_options* options, const sightline_cull_output* output,
                                sightline_cull_result* result) {
  if (!culler || !world || !views || !output || !result)
    return refuse("cull: the culler, the world, the views, the output or the result is NULL");
  Views given;
  CullOptions how;
  CullOutput out;
  if (const Status ok = c_api::take(views, view_count, given); !ok) return keep(ok);
  if (const Status ok = take(options, how); !ok) return keep(ok);
  if (const Status ok = take(*output, out); !ok) return keep(ok);
  const Result<CullResult> done = culler->culler.cull(world->world, {given.data(), view_count}, how, out);
  if (!done) return keep(done.error());
  *result = {
      done->count, done->tested, done->nodes_visited, done->culled_occlusion, done->cost, done->frustum_cost,
      {}};
  return SIGHTLINE_OK;
}

sightline_status sightline_report_frame_time(sightline_culler* culler, double nanoseconds) {
  if (!culler) return refuse("report_frame_time: the culler is NULL");
  return keep(culler->culler.report_frame_time(nanoseconds));
}

}  // extern "C"
