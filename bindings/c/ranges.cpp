// Ranges of an order, and their culling.
#include <sightline/ranges.hpp>

#include "bindings/c/calls.hpp"

struct sightline_order {
  sightline::ObjectOrder order;
};
struct sightline_range_culler {
  sightline::RangeCuller culler;
};

using namespace sightline;
using namespace sightline::c_api;

namespace {

static_assert(sizeof(sightline_slot_change) == sizeof(SlotChange) &&
              offsetof(sightline_slot_change, object) == offsetof(SlotChange, object));
static_assert(sizeof(sightline_slot_range) == sizeof(SlotRange) &&
              offsetof(sightline_slot_range, count) == offsetof(SlotRange, count));
static_assert(SIGHTLINE_NO_SLOT == kNoSlot);

sightline_status keep_report(const Result<std::span<const SlotChange>>& changes,
                             sightline_order_report* report) {
  if (!changes) return keep(changes.error());
  *report = {reinterpret_cast<const sightline_slot_change*>(changes->data()), changes->size()};
  return SIGHTLINE_OK;
}

Status take(const sightline_range_options* given, RangeOptions& options) {
  sightline_range_options o = sightline_range_options_default();
  if (given && (!take_struct(given, SIGHTLINE_FIRST_SIZE(sightline_range_options, zones), o) || o.masks > 1 ||
                o.whole_chunks > 1)) {
    return {StatusCode::bad_argument,
            "ranges: struct_size, masks or whole_chunks of the options are unknown, expected those of "
            "sightline_range_options_default"};
  }
  options.masks = o.masks == 1, options.whole_chunks = o.whole_chunks == 1;
  options.zones = zones_of(o.zones);
  return c_api::take(o.jobs, options.jobs);
}

}  // namespace

extern "C" {

sightline_order* sightline_order_create(void) {
  return new sightline_order;
}
void sightline_order_destroy(sightline_order* order) {
  delete order;
}

sightline_status sightline_order_update(sightline_order* order, sightline_world* world,
                                        sightline_order_report* report) {
  if (!order || !world || !report) return refuse("order: it, the world or the report are NULL");
  return keep_report(order->order.update(world->world), report);
}
sightline_status sightline_order_renumber(sightline_order* order, sightline_world* world,
                                          sightline_order_report* report) {
  if (!order || !world || !report) return refuse("order: it, the world or the report are NULL");
  return keep_report(order->order.renumber(world->world), report);
}

size_t sightline_order_slot_limit(const sightline_order* order) {
  return order ? order->order.slot_limit() : 0;
}
const uint32_t* sightline_order_objects(const sightline_order* order) {
  return order ? order->order.objects().data() : nullptr;
}
uint32_t sightline_order_slot(const sightline_order* order, const sightline_world* world,
                              sightline_handle handle) {
  return order && world ? order->order.slot(world->world, handle_of(handle)) : SIGHTLINE_NO_SLOT;
}

sightline_range_culler* sightline_range_culler_create(void) {
  return new sightline_range_culler;
}
void sightline_range_culler_destroy(sightline_range_culler* culler) {
  delete culler;
}

sightline_status sightline_cull_ranges(sightline_range_culler* culler, const sightline_world* world,
                                       const sightline_order* order, const sightline_cull_view* views,
                                       size_t view_count, const sightline_range_options* options,
                                       sightline_range_result* result) {
  if (!culler || !world || !order || !views || !result)
    return refuse("ranges: the culler, the world, the order, the views or the result are NULL");
  Views given;
  RangeOptions how;
  if (const Status ok = c_api::take(views, view_count, given); !ok) return keep(ok);
  if (const Status ok = take(options, how); !ok) return keep(ok);
  const Result<RangeResult> done =
      culler->culler.cull(world->world, order->order, {given.data(), view_count}, how);
  if (!done) return keep(done.error());
  *result = {reinterpret_cast<const sightline_slot_range*>(done->ranges.data()),
             first_of(done->masks),
             done->ranges.size(),
             done->objects,
             done->tested,
             done->nodes_visited,
             done->culled_occlusion};
  return SIGHTLINE_OK;
}

}  // extern "C"
