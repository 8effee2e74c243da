// Worlds, and their culling.
#include <sightline/world.hpp>

#include <array>

#include "bindings/c/calls.hpp"

struct sightline_culler {
  sightline::Culler culler;
};

using namespace sightline;
using namespace sightline::c_api;

namespace {

static_assert(sizeof(sightline_handle) == sizeof(Handle) &&
              offsetof(sightline_handle, generation) == offsetof(Handle, generation));
static_assert(SIGHTLINE_NO_OBJECT == kNoObject && SIGHTLINE_ALL_LAYERS == kAllLayers &&
              SIGHTLINE_MAX_VIEWS == kMaxViews);

Strided<const Handle> read(const sightline_handles& handles) {
  return {handles.first, handles.count, handles.stride};
}
Strided<const std::uint32_t> read(const sightline_column& column) {
  return {column.first, column.count, column.stride};
}
Handle handle_of(sightline_handle handle) {
  return {handle.index, handle.generation};
}

Status take(const sightline_object_columns& given, ObjectColumns& columns) {
  sightline_object_columns c = sightline_object_columns_default();
  if (!take_struct(&given, SIGHTLINE_FIRST_SIZE(sightline_object_columns, values), c) || c.reserved != 0) {
    return {StatusCode::bad_argument,
            "columns: a struct_size is unknown, expected that of sightline_object_columns_default"};
  }
  columns = {read(c.layers), read(c.values)};
  return {};
}

Status take(const sightline_cull_options* given, CullOptions& options) {
  sightline_cull_options o = sightline_cull_options_default();
  if (given &&
      (!take_struct(given, SIGHTLINE_FIRST_SIZE(sightline_cull_options, jobs), o) || o.values_for_ids > 1)) {
    return {StatusCode::bad_argument,
            "cull: struct_size or values_for_ids of the options are unknown, "
            "expected those of sightline_cull_options_default"};
  }
  options.values_for_ids = o.values_for_ids == 1;
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
  return {};
}

using Views = std::array<CullView, kMaxViews>;

// The views stand as far apart as the caller's header has them.
Status take(const sightline_cull_view* given, std::size_t count, Views& views) {
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
  }
  return {};
}

Status stale() {
  return {StatusCode::stale_handle, "world: the handle names no object that stands"};
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
  if (const Status ok = take(views, view_count, given); !ok) return keep(ok);
  if (const Status ok = take(options, how); !ok) return keep(ok);
  if (const Status ok = take(*output, out); !ok) return keep(ok);
  const Result<CullResult> done = culler->culler.cull(world->world, {given.data(), view_count}, how, out);
  if (!done) return keep(done.error());
  *result = {done->count, done->tested, done->nodes_visited, done->culled_occlusion, {}};
  return SIGHTLINE_OK;
}

}  // extern "C"
