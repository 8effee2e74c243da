#include "workbench/methods/draw_calls/adaptive.hpp"

#include <algorithm>

namespace sightline::methods {

Adaptive::Adaptive(const Scene& scene, const std::vector<DrawCallPlan>& plans, std::vector<Way> ways,
                   std::uint32_t first)
    : CpuMethod(scene), ways_(std::move(ways)), trials_(static_cast<std::uint32_t>(ways_.size()), first) {
  for (const DrawCallPlan& plan : plans)
    candidates_.push_back({std::make_unique<DrawCallMethod>(scene, plan), 0});
  gather();
}

void Adaptive::do_update(std::span<const ObjectId> moved) {
  if (moved.empty()) return;
  for (Candidate& candidate : candidates_) candidate.method->update(moved);
  gather();
}

void Adaptive::gather() {
  for (auto* list : {&indices_, &sources_, &objects_}) list->clear();
  std::uint64_t bytes = 0;
  for (Candidate& candidate : candidates_) {
    candidate.first_triangle = static_cast<std::uint32_t>(objects_.size());
    bytes += candidate.method->geometry()->bytes;
    TriangleLists lists = candidate.method->give_lists();
    positions_ = std::move(lists.positions);  // all plans have the same
    texture_coordinates_ = std::move(lists.texture_coordinates);
    indices_.insert(indices_.end(), lists.indices.begin(), lists.indices.end());
    sources_.insert(sources_.end(), lists.sources.begin(), lists.sources.end());
    objects_.insert(objects_.end(), lists.objects.begin(), lists.objects.end());
  }
  bytes -= (candidates_.size() - 1) *
           (positions_.size() * sizeof(Vec3) + texture_coordinates_.size() * sizeof(TextureCoordinate));
  geometry_ = {
      positions_, indices_, objects_, sources_, texture_coordinates_, ways_[trials_.current()].submission,
      bytes};
}

void Adaptive::cull(const View& view, Frame& frame) noexcept {
  const Way& way = ways_[trials_.current()];
  const Candidate& candidate = candidates_[way.plan];
  candidate.method->submit_by(way.submission);
  geometry_.submission = way.submission;
  candidate.method->cull(view, frame);
  for (DrawCommand& draw : frame.draws) {
    draw.first_index += 3 * candidate.first_triangle;
    draw.first_instance += candidate.first_triangle;
  }
}

std::string Adaptive::in_use() const {
  const Way& way = ways_[trials_.current()];
  const DrawCallPlan& plan = candidates_[way.plan].method->plan();
  constexpr std::array<std::string_view, 3> kStrategies{"simple-", "drawcall-wise-", "zhang-"},
      kStructures{"grid", "octree", "kd-tree"};
  std::string name;
  if (plan.clusters) {
    name = "cluster-cone?size=" + std::to_string(plan.cluster_size);
  } else {
    name.append(kStrategies[static_cast<std::size_t>(plan.strategy)])
        .append(kStructures[static_cast<std::size_t>(plan.structure)])
        .append("?height=" + std::to_string(plan.height))
        .append("&least=" + std::to_string(plan.cells.least) + "&cells=tight");
  }
  return name.append("&submission=").append(to_string(way.submission));
}

}  // namespace sightline::methods
