// Random reports of an order, culls into its ranges, and looks into culls.
#pragma once

#include <span>
#include <vector>

#include "calls.hpp"

namespace sightline::fuzz {

class RangesPlay {
public:
  explicit RangesPlay(CallBytes& in) : in_(in) {}

  void step(sightline_world* world, const sightline_view& view, const sightline_occlusion* occlusion,
            const sightline_culler* culler) {
    if (in_.byte() < 192) follow(world);
    const std::vector<sightline_cull_view> views = views_of(in_, view, occlusion);
    cull(world, views);
    inspect(world, views, culler);
  }

private:
  void follow(sightline_world* world) {
    sightline_order_report report;
    require(done(in_.rarely() ? sightline_order_renumber(order_.get(), world, &report)
                              : sightline_order_update(order_.get(), world, &report)));
    for (const sightline_slot_change& change : std::span(report.changes, report.count)) {
      if (change.slot >= buffer_.size()) buffer_.resize(change.slot + std::size_t{1}, SIGHTLINE_NO_OBJECT);
      buffer_[change.slot] = change.object;
    }
    const std::size_t slots = sightline_order_slot_limit(order_.get());
    const std::uint32_t* objects = sightline_order_objects(order_.get());
    std::size_t live = 0;
    for (std::size_t slot = 0; slot < buffer_.size(); ++slot) {
      require(buffer_[slot] == (slot < slots ? objects[slot] : SIGHTLINE_NO_OBJECT));
      if (buffer_[slot] == SIGHTLINE_NO_OBJECT) continue;
      const sightline_handle handle = sightline_world_handle(world, buffer_[slot]);
      require(sightline_order_slot(order_.get(), world, handle) == slot);
      ++live;
    }
    require(live == sightline_world_size(world));
  }

  void inspect(const sightline_world* world, const std::vector<sightline_cull_view>& views,
               const sightline_culler* culler) {
    sightline_inspection looked;
    if (!done(sightline_inspect(inspector_.get(), world, views.data(), views.size(),
                                in_.byte() & 1 ? culler : nullptr, &looked)))
      return;
    require(looked.view_count == views.size());
    for (const sightline_view_stats& s : std::span(looked.views, looked.view_count)) {
      require(s.objects ==
              s.outside + s.by_layers + s.by_distances + s.by_casters + s.by_area + s.hidden + s.visible);
      require(s.chunks ==
              s.chunks_outside + s.chunks_dropped + s.chunks_hidden + s.chunks_whole + s.chunks_opened);
      require(s.objects <= sightline_world_size(world));
    }
  }

  void cull(const sightline_world* world, const std::vector<sightline_cull_view>& views) {
    sightline_range_options options = sightline_range_options_default();
    options.jobs = {run_here, nullptr, in_.byte() % 70u, 0};
    options.masks = in_.byte() & 1, options.whole_chunks = in_.byte() & 1;
    if (in_.rarely()) options.struct_size = in_.byte();
    sightline_range_result result;
    if (!done(sightline_cull_ranges(culler_.get(), world, order_.get(), views.data(), views.size(), &options,
                                    &result)))
      return;
    std::vector<bool> taken(sightline_order_slot_limit(order_.get()));
    std::uint64_t objects = 0;
    for (std::size_t r = 0; r < result.count; ++r) {
      const auto [first, count] = result.ranges[r];
      require(count > 0 && first + std::size_t{count} <= taken.size());
      require(!options.masks || result.masks[r] != 0);
      for (std::uint32_t slot = first; slot < first + count; ++slot) {
        require(!taken[slot] && sightline_order_objects(order_.get())[slot] != SIGHTLINE_NO_OBJECT);
        taken[slot] = true;
      }
      objects += count;
    }
    require(objects == result.objects);
  }

  CallBytes& in_;
  Owned<sightline_order, sightline_order_destroy> order_{sightline_order_create()};
  Owned<sightline_range_culler, sightline_range_culler_destroy> culler_{sightline_range_culler_create()};
  Owned<sightline_inspector, sightline_inspector_destroy> inspector_{sightline_inspector_create()};
  std::vector<std::uint32_t> buffer_;
};

}  // namespace sightline::fuzz
