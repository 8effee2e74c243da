// Random operations on instances of a world.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "calls.hpp"

namespace sightline::fuzz {

class InstancesPlay {
public:
  explicit InstancesPlay(CallBytes& in) : in_(in) {}

  /// `world` is the same every time.
  void step(const sightline_world* world, const sightline_view& view, const sightline_occlusion* occlusion) {
    if (world_ == ~0u) require(done(sightline_instances_add_world(instances_.get(), world, &world_)));
    if (in_.rarely()) (void)done(sightline_instances_remove_world(instances_.get(), in_.byte() % 3u));
    if (in_.rarely()) (void)done(sightline_instances_add_world(instances_.get(), world, &world_));
    if (in_.byte() & 1) (void)done(sightline_instances_update(instances_.get()));
    change();
    require(sightline_instances_size(instances_.get()) == standing_);
    cull(world, view, occlusion);
  }

private:
  sightline_instance_placement placement() {
    sightline_instance_placement p{in_.rarely() ? in_.byte() : world_, {}, 0, {}};
    const double turn = in_.byte(), scale = in_.byte() & 1 ? 1 : in_.number(0.1);
    p.transform[0] = p.transform[10] = static_cast<float>(scale * std::cos(turn));
    p.transform[8] = static_cast<float>(scale * std::sin(turn)), p.transform[2] = -p.transform[8];
    p.transform[5] = static_cast<float>(scale), p.transform[15] = 1;
    for (int a = 0; a < 3; ++a)
      p.transform[12 + a] = in_.single(1), p.origin[a] = in_.rarely() ? in_.number(1) : 0;
    if (in_.rarely()) p.transform[in_.byte() % 16] = in_.take<float>();
    return p;
  }

  void change() {
    for (std::size_t i = 0; i < placements_.size(); ++i) {
      placements_[i] = placement();
      if (!all_.empty()) handles_[i] = all_[in_.take<std::uint16_t>() % all_.size()];
    }
    sightline_placements placements = sightline_placements_of(placements_.data(), sizeof placements_[0], 4);
    sightline_handles handles = sightline_handles_of(handles_.data(), sizeof handles_[0], 4);
    const sightline_column layers = sightline_column_of(layers_.data(), sizeof layers_[0], 4);
    for (std::uint32_t& layer : layers_) layer = in_.byte();
    if (in_.rarely()) placements.stride = in_.byte();
    if (in_.rarely()) placements.count = kTooMuch;
    if (in_.rarely()) handles.first = nullptr;
    switch (in_.byte() % 4) {
      case 0:
        if (!done(sightline_instances_insert(instances_.get(), &placements, &handles,
                                             in_.byte() & 1 ? &layers : nullptr)))
          break;
        all_.insert(all_.end(), handles_.begin(), handles_.end());
        standing_ += 4;
        break;
      case 1:
        (void)done(sightline_instances_move(instances_.get(), &handles, &placements));
        break;
      case 2:
        if (done(sightline_instances_remove(instances_.get(), &handles))) standing_ -= 4;
        break;
      default:
        (void)done(sightline_instances_set_layers(instances_.get(), &handles, &layers));
    }
  }

  void cull(const sightline_world* world, const sightline_view& view, const sightline_occlusion* occlusion) {
    const std::vector<sightline_cull_view> views = views_of(in_, view, occlusion);
    sightline_instance_options options = sightline_instance_options_default();
    options.jobs = {run_here, nullptr, in_.byte() % 70u, 0};
    options.masks = in_.byte() & 1, options.levels = in_.byte() & 1, options.values_for_ids = in_.rarely();
    if (in_.byte() & 1) options.level_options.fade = in_.single(0.01);
    if (in_.rarely()) options.level_options.view = in_.byte(), options.level_options.scale = in_.single(1);
    if (in_.rarely()) options.most_objects = in_.byte();
    if (in_.rarely()) options.struct_size = in_.byte();
    sightline_instance_result result;
    if (!done(sightline_cull_instances(culler_.get(), instances_.get(), views.data(), views.size(), &options,
                                       &result)))
      return;
    std::uint64_t objects = 0;
    for (const sightline_instance_range& range : std::span(result.ranges, result.range_count)) {
      require(range.count > 0 && range.first + std::size_t{range.count} <= result.id_count);
      require(range.instance < sightline_instances_id_limit(instances_.get()));
      objects += range.count;
    }
    require(objects == result.objects && objects <= sightline_instances_objects(instances_.get()));
    for (std::size_t i = 0; i < result.id_count; ++i) {
      require(options.values_for_ids || result.ids[i] < sightline_world_id_limit(world));
      require(!options.masks || result.masks[i] != 0);
      require(!options.levels || result.levels[i] < SIGHTLINE_MAX_LEVELS);
    }
  }

  CallBytes& in_;
  Owned<sightline_instances, sightline_instances_destroy> instances_{sightline_instances_create()};
  Owned<sightline_instance_culler, sightline_instance_culler_destroy> culler_{
      sightline_instance_culler_create()};
  std::uint32_t world_ = ~0u;
  std::size_t standing_ = 0;
  std::array<sightline_instance_placement, 4> placements_{};
  std::array<sightline_handle, 4> handles_{};
  std::array<std::uint32_t, 4> layers_{};
  std::vector<sightline_handle> all_;
};

}  // namespace sightline::fuzz
