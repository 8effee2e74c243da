// The module `core`: boxes that move and their cull, and flat culling.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <vector>

#include <sightline/frustum.hpp>

#include "web/wasm/glue.hpp"
#include "web/wasm/web_world.hpp"

namespace sightline::web {

namespace {

Status last;

// Takes out what may come again, and hides what may not. Nothing changes where a handle is stale or stands
// twice.
Status remove(WebWorld& web, const double* numbers, std::size_t count) {
  std::vector<Handle> all = web.read(numbers, count), spent;
  const auto is_spent = [](const Handle& handle) { return handle.generation >= kLastGeneration; };
  if (std::none_of(all.begin(), all.end(), is_spent)) return web.world.remove(all);

  std::unordered_set<ObjectId> named;
  for (std::size_t i = 0; i < count; ++i) {
    if (!web.world.contains(all[i]) || !named.insert(all[i].index).second)
      return {StatusCode::stale_handle, "handles: names no object of this world", i};
  }
  std::copy_if(all.begin(), all.end(), std::back_inserter(spent), is_spent);
  std::erase_if(all, is_spent);
  const std::vector<std::uint32_t> none(spent.size());
  if (const Status status = web.world.set_layers(spent, none); !status) return status;
  if (take_occluders) take_occluders(web.world, spent);
  for (const Handle& handle : spent) web.retired.insert(handle.index);
  return web.world.remove(all);
}

}  // namespace

TakeOccluders take_occluders = nullptr;

std::uint32_t keep(const Status& status) noexcept {
  last = status;
  return static_cast<std::uint32_t>(status.code());
}

extern "C" {

SIGHTLINE_WEB(allocate) void* allocate(std::size_t bytes) {
  return std::aligned_alloc(64, (bytes + 63) / 64 * 64);
}
SIGHTLINE_WEB(release) void release(void* memory) {
  std::free(memory);
}
SIGHTLINE_WEB(message) const char* message() {
  return last.message();
}
/// Of a call that returns no code.
SIGHTLINE_WEB(last_code) std::uint32_t last_code() {
  return static_cast<std::uint32_t>(last.code());
}
/// Which element was refused, or -1.
SIGHTLINE_WEB(refused_index) double refused_index() {
  return last.index() == Status::kNoIndex ? -1 : static_cast<double>(last.index());
}

// --- the world ---

SIGHTLINE_WEB(world_create) WebWorld* world_create() {
  return new WebWorld;
}
SIGHTLINE_WEB(world_destroy) void world_destroy(WebWorld* web) {
  delete web;
}

SIGHTLINE_WEB(world_insert)
std::uint32_t world_insert(WebWorld* web, Layout layout, const void* first, std::size_t stride,
                           std::size_t count, double x, double y, double z, const std::uint32_t* layers,
                           const std::uint32_t* values, double* numbers) {
  web->handles.resize(count);
  Status status = web->world.insert(boxes_of(layout, first, stride, count, {x, y, z}), web->handles);
  // Column by column, so that those that nobody has here are not linked.
  if (status && layers) status = web->world.set_layers(web->handles, {layers, count});
  if (status && values) status = web->world.set_values(web->handles, {values, count});
  if (status) std::transform(web->handles.begin(), web->handles.end(), numbers, number_of);
  return keep(status);
}

SIGHTLINE_WEB(world_move)
std::uint32_t world_move(WebWorld* web, const double* numbers, Layout layout, const void* first,
                         std::size_t stride, std::size_t count, double x, double y, double z) {
  return keep(web->world.move(web->read(numbers, count), boxes_of(layout, first, stride, count, {x, y, z})));
}

SIGHTLINE_WEB(world_remove)
std::uint32_t world_remove(WebWorld* web, const double* numbers, std::size_t count) {
  return keep(remove(*web, numbers, count));
}

SIGHTLINE_WEB(world_set_layers)
std::uint32_t world_set_layers(WebWorld* web, const double* numbers, const std::uint32_t* layers,
                               std::size_t count) {
  return keep(web->world.set_layers(web->read(numbers, count), {layers, count}));
}

SIGHTLINE_WEB(world_set_values)
std::uint32_t world_set_values(WebWorld* web, const double* numbers, const std::uint32_t* values,
                               std::size_t count) {
  return keep(web->world.set_values(web->read(numbers, count), {values, count}));
}

SIGHTLINE_WEB(world_size) std::size_t world_size(const WebWorld* web) {
  return web->world.size() - web->retired.size();
}
SIGHTLINE_WEB(world_id_limit) std::size_t world_id_limit(const WebWorld* web) {
  return web->world.id_limit();
}
SIGHTLINE_WEB(world_contains) bool world_contains(WebWorld* web, double number) {
  return web->world.contains(web->read(&number, 1)[0]);
}
/// -1 where no object has the id.
SIGHTLINE_WEB(world_handle) double world_handle(const WebWorld* web, ObjectId id) {
  const Handle handle = web->world.handle(id);
  return web->retired.contains(id) || !web->world.contains(handle) ? -1 : number_of(handle);
}
/// Writes minimum and maximum; 0 for a stale handle.
SIGHTLINE_WEB(world_box) bool world_box(WebWorld* web, double number, double* box) {
  const Handle handle = web->read(&number, 1)[0];
  if (!web->world.contains(handle)) return false;
  const WorldBox stored = web->world.box(handle);
  const double numbers[] = {stored.min.x, stored.min.y, stored.min.z,
                            stored.max.x, stored.max.y, stored.max.z};
  std::copy(std::begin(numbers), std::end(numbers), box);
  return true;
}
SIGHTLINE_WEB(world_layers) std::uint32_t world_layers(WebWorld* web, double number) {
  return web->world.layers(web->read(&number, 1)[0]);
}
SIGHTLINE_WEB(world_value) std::uint32_t world_value(WebWorld* web, double number) {
  return web->world.value(web->read(&number, 1)[0]);
}

// --- culling ---

// web/src/views.ts writes these as they lie.
static_assert(sizeof(WorldView) == 160 && offsetof(WorldView, origin) == 136);
static_assert(sizeof(CullView) == 184 && offsetof(CullView, occlusion) == 160);
static_assert(offsetof(CullView, layers) == 164 && offsetof(CullView, min_area) == 168);
static_assert(offsetof(CullView, distance_scale) == 172 && offsetof(CullView, distance_view) == 176);
static_assert(offsetof(CullView, casters) == 180);
static_assert(sizeof(CullCosts) == 36 && offsetof(CullCosts, occludee) == 32);

SIGHTLINE_WEB(culler_create) WebCuller* culler_create() {
  return new WebCuller;
}
SIGHTLINE_WEB(culler_destroy) void culler_destroy(WebCuller* culler) {
  delete culler;
}
SIGHTLINE_WEB(cull_capacity) std::size_t capacity(const WebWorld* web) {
  return cull_capacity(web->world);
}

/// Writes count, tested, nodes visited, culled by occlusion and the two costs to `result`. Occlusion is
/// automatic where there are costs.
SIGHTLINE_WEB(cull)
std::uint32_t cull(WebCuller* culler, const WebWorld* web, const CullView* views, std::size_t view_count,
                   bool values_for_ids, const CullCosts* costs, std::uint32_t* ids, std::uint8_t* masks,
                   std::size_t capacity, double* result) {
  CullOptions options;
  options.values_for_ids = values_for_ids;
  if (costs) options.occlusion = Occlusion::automatic, options.costs = *costs;
  CullOutput output{{ids, capacity}, {}};
  if (masks) output.masks = {masks, capacity};
  const auto culled = culler->culler.cull(web->world, {views, view_count}, options, output);
  if (culled) {
    const double numbers[] = {static_cast<double>(culled->count),
                              static_cast<double>(culled->tested),
                              static_cast<double>(culled->nodes_visited),
                              static_cast<double>(culled->culled_occlusion),
                              culled->cost,
                              culled->frustum_cost};
    std::copy(std::begin(numbers), std::end(numbers), result);
  }
  return keep(culled.error());
}

SIGHTLINE_WEB(report_frame_time)
std::uint32_t report_frame_time(WebCuller* culler, double nanoseconds) {
  return keep(culler->culler.report_frame_time(nanoseconds));
}

/// Puts numbers below `limit`, all different, and their masks, none 0, in ascending order.
SIGHTLINE_WEB(sort_ids)
void sort_ids(WebCuller* culler, std::uint32_t* ids, std::uint8_t* masks, std::size_t count,
              std::size_t limit) {
  using Eight = std::uint64_t;  // masks looked at together: most are 0
  std::vector<std::uint8_t>& mask_of = culler->mask_of;
  if (mask_of.size() < limit + sizeof(Eight)) mask_of.resize(limit + sizeof(Eight));
  for (std::size_t i = 0; i < count; ++i) mask_of[ids[i]] = masks[i];
  std::size_t out = 0;
  for (std::size_t first = 0; out < count; first += sizeof(Eight)) {
    Eight eight;
    std::memcpy(&eight, &mask_of[first], sizeof(Eight));
    if (eight == 0) continue;
    for (std::size_t id = first; id < first + sizeof(Eight); ++id) {
      if (mask_of[id] == 0) continue;
      ids[out] = static_cast<std::uint32_t>(id), masks[out] = mask_of[id];
      mask_of[id] = 0, ++out;
    }
  }
}

/// The indices of the boxes in view, ascending; their number to `result`.
SIGHTLINE_WEB(flat_boxes)
std::uint32_t flat_boxes(const WorldView* view, Layout layout, const void* first, std::size_t stride,
                         std::size_t count, double x, double y, double z, ObjectId* ids, std::size_t capacity,
                         double* result) {
  if (const Status status = check(*view); !status) return keep(status);
  const auto seen =
      cull_boxes(make_frustum(*view), boxes_of(layout, first, stride, count, {x, y, z}), {ids, capacity});
  if (seen) *result = static_cast<double>(*seen);
  return keep(seen.error());
}

/// The same of spheres: four columns of `count` numbers, about the view's origin.
SIGHTLINE_WEB(flat_spheres)
std::uint32_t flat_spheres(const WorldView* view, const float* first, std::size_t count, ObjectId* ids,
                           std::size_t capacity, double* result) {
  if (const Status status = check(*view); !status) return keep(status);
  const auto seen = cull_spheres(
      make_frustum(*view),
      SphereView::arrays(first, first + count, first + 2 * count, first + 3 * count, count), {ids, capacity});
  if (seen) *result = static_cast<double>(*seen);
  return keep(seen.error());
}

}  // extern "C"

}  // namespace sightline::web
