// Instances of worlds, and their culling.
#include <sightline/instances.hpp>

#include "bindings/c/calls.hpp"

struct sightline_instances {
  sightline::Instances instances;
};
struct sightline_instance_culler {
  sightline::InstanceCuller culler;
};

using namespace sightline;
using namespace sightline::c_api;

namespace {

static_assert(sizeof(sightline_instance_placement) == sizeof(InstancePlacement) &&
              offsetof(sightline_instance_placement, transform) == offsetof(InstancePlacement, transform) &&
              offsetof(sightline_instance_placement, origin) == offsetof(InstancePlacement, origin));
static_assert(sizeof(sightline_instance_range) == sizeof(InstanceRange) &&
              offsetof(sightline_instance_range, count) == offsetof(InstanceRange, count));

Strided<const InstancePlacement> placements_of(const sightline_placements& placements) {
  return {placements.first, placements.count, placements.stride};
}

Status take(const sightline_instance_options* given, InstanceCullOptions& options) {
  sightline_instance_options o = sightline_instance_options_default();
  if (given && (!take_struct(given, SIGHTLINE_FIRST_SIZE(sightline_instance_options, zones), o) ||
                o.values_for_ids > 1 || o.masks > 1 || o.levels > 1)) {
    return {
        StatusCode::bad_argument,
        "instances: struct_size, values_for_ids, masks or levels of the options are unknown, expected those "
        "of sightline_instance_options_default"};
  }
  options.values_for_ids = o.values_for_ids == 1, options.masks = o.masks == 1,
  options.levels = o.levels == 1;
  const sightline_level_options& l = o.level_options;
  options.level_options = {l.view, l.key, l.hysteresis, l.fade, l.scale, l.cut != 0};
  options.most_objects = o.most_objects;
  options.zones = zones_of(o.zones);
  return c_api::take(o.jobs, options.jobs);
}

// Calls write(instances, handle) where both are there and the handle's instance stands.
template <class Write>
sightline_status read_instance(const sightline_instances* instances, sightline_handle handle, const void* out,
                               Write write) {
  if (!instances || !out) return refuse("instances: they, or what to write to, are NULL");
  const Handle h = handle_of(handle);
  if (!instances->instances.contains(h))
    return keep({StatusCode::stale_handle, "instances: the handle names no instance that stands"});
  write(instances->instances, h);
  return SIGHTLINE_OK;
}

}  // namespace

extern "C" {

sightline_instances* sightline_instances_create(void) {
  return new sightline_instances;
}
void sightline_instances_destroy(sightline_instances* instances) {
  delete instances;
}

sightline_status sightline_instances_add_world(sightline_instances* instances, const sightline_world* world,
                                               uint32_t* name) {
  if (!instances || !world || !name) return refuse("instances: they, the world or its name are NULL");
  const Result<PlacedWorldId> added = instances->instances.add_world(world->world);
  if (!added) return keep(added.error());
  *name = *added;
  return SIGHTLINE_OK;
}
sightline_status sightline_instances_remove_world(sightline_instances* instances, uint32_t name) {
  if (!instances) return refuse("instances: they are NULL");
  return keep(instances->instances.remove_world(name));
}
sightline_status sightline_instances_update(sightline_instances* instances) {
  if (!instances) return refuse("instances: they are NULL");
  return keep(instances->instances.update());
}

sightline_status sightline_instances_insert(sightline_instances* instances,
                                            const sightline_placements* placements,
                                            const sightline_handles* handles,
                                            const sightline_column* layers) {
  if (!instances || !placements || !handles)
    return refuse("instances: they, the placements or the handles are NULL");
  return keep(instances->instances.insert(placements_of(*placements),
                                          {handles->first, handles->count, handles->stride},
                                          layers ? read(*layers) : Strided<const std::uint32_t>()));
}
sightline_status sightline_instances_move(sightline_instances* instances, const sightline_handles* handles,
                                          const sightline_placements* placements) {
  if (!instances || !placements || !handles)
    return refuse("instances: they, the handles or the placements are NULL");
  return keep(instances->instances.move(read(*handles), placements_of(*placements)));
}
sightline_status sightline_instances_remove(sightline_instances* instances,
                                            const sightline_handles* handles) {
  if (!instances || !handles) return refuse("instances: they or the handles are NULL");
  return keep(instances->instances.remove(read(*handles)));
}
sightline_status sightline_instances_set_layers(sightline_instances* instances,
                                                const sightline_handles* handles,
                                                const sightline_column* layers) {
  if (!instances || !handles || !layers) return refuse("instances: they, the handles or the layers are NULL");
  return keep(instances->instances.set_layers(read(*handles), read(*layers)));
}

size_t sightline_instances_size(const sightline_instances* instances) {
  return instances ? instances->instances.size() : 0;
}
size_t sightline_instances_id_limit(const sightline_instances* instances) {
  return instances ? instances->instances.id_limit() : 0;
}
uint64_t sightline_instances_objects(const sightline_instances* instances) {
  return instances ? instances->instances.objects() : 0;
}
int sightline_instances_contains(const sightline_instances* instances, sightline_handle handle) {
  return instances && instances->instances.contains(handle_of(handle));
}
sightline_handle sightline_instances_handle(const sightline_instances* instances, uint32_t id) {
  const Handle handle = instances ? instances->instances.handle(id) : Handle{};
  return {handle.index, handle.generation};
}

sightline_status sightline_instances_placement(const sightline_instances* instances, sightline_handle handle,
                                               sightline_instance_placement* placement) {
  return read_instance(instances, handle, placement, [&](const Instances& all, Handle h) {
    const InstancePlacement p = all.placement(h);
    std::memcpy(placement, &p, sizeof p);
    placement->reserved = 0;
  });
}
sightline_status sightline_instances_box(const sightline_instances* instances, sightline_handle handle,
                                         sightline_box* box) {
  return read_instance(instances, handle, box, [&](const Instances& all, Handle h) {
    const WorldBox b = all.box(h);
    *box = {{b.min.x, b.min.y, b.min.z}, {b.max.x, b.max.y, b.max.z}};
  });
}

sightline_instance_culler* sightline_instance_culler_create(void) {
  return new sightline_instance_culler;
}
void sightline_instance_culler_destroy(sightline_instance_culler* culler) {
  delete culler;
}

sightline_status sightline_cull_instances(sightline_instance_culler* culler,
                                          const sightline_instances* instances,
                                          const sightline_cull_view* views, size_t view_count,
                                          const sightline_instance_options* options,
                                          sightline_instance_result* result) {
  if (!culler || !instances || !views || !result)
    return refuse("cull: the culler, the instances, the views or the result are NULL");
  Views given;
  InstanceCullOptions how;
  if (const Status ok = c_api::take(views, view_count, given); !ok) return keep(ok);
  if (const Status ok = take(options, how); !ok) return keep(ok);
  const Result<InstanceCullResult> done =
      culler->culler.cull(instances->instances, {given.data(), view_count}, how);
  if (!done) return keep(done.error());
  *result = {reinterpret_cast<const sightline_instance_range*>(done->ranges.data()),
             done->ranges.size(),
             done->ids.data(),
             first_of(done->masks),
             first_of(done->levels),
             first_of(done->fades),
             done->ids.size(),
             done->objects,
             done->tested,
             done->nodes_visited,
             done->culled_occlusion};
  return SIGHTLINE_OK;
}

}  // extern "C"
