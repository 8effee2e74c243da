#include "workbench/methods/draw_calls/draw_call_method.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace sightline {

std::string_view to_string(Submission submission) noexcept {
  switch (submission) {
    case Submission::calls:
      return "calls";
    case Submission::multi_draw:
      return "multi-draw";
    case Submission::merged:
      return "merged";
  }
  return "";
}

}  // namespace sightline

namespace sightline::methods {

DrawCallMethod::DrawCallMethod(const Scene& scene, const DrawCallPlan& plan) : CpuMethod(scene), plan_(plan) {
  if (plan_.occlusion) occluders_.emplace(scene);
  rebuild();
}

void DrawCallMethod::rebuild() {
  FlatTriangles flat = flatten(scene_);
  TriangleOrder order;
  if (plan_.strategy == Strategy::simple) {
    order.resize(flat.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  } else {
    order.reserve(flat.size() + flat.size() / 4);
  }
  const BatchRules rules{plan_.strategy, plan_.planes, plan_.facing != FacingRule::none};
  for (const bool blended : {false, true}) {
    std::vector<std::uint32_t> triangles;
    for (std::uint32_t t = 0; t < flat.size(); ++t) {
      if ((scene_.surface[flat.objects[t]] == Surface::transparent) == blended) triangles.push_back(t);
    }
    Layer& layer = layers_[blended];
    if (plan_.clusters) {
      layer.partition.build_clusters(flat.span(), triangles, plan_.cluster_size);
    } else {
      layer.partition.build(plan_.structure, flat.span(), triangles, plan_.height, plan_.cells);
    }
    if (!blended) {
      layer.batches = make_draw_batches(rules, flat, layer.partition, order);
    } else {
      std::vector<std::uint32_t> positions = triangles;  // in the global list of `simple`
      if (plan_.strategy != Strategy::simple) {
        std::iota(positions.begin(), positions.end(), static_cast<std::uint32_t>(order.size()));
        order.insert(order.end(), triangles.begin(), triangles.end());
      }
      layer.batches = make_blended_batches(rules, flat, layer.partition, triangles, positions);
      blend_order_ = BlendOrder(flat, triangles, positions);
    }
    if (plan_.occlusion && !blended) build_occludees(flat, layer);
    layer.partition.drop_triangles();
  }
  movers_.clear();
  is_mover_.assign(scene_.size(), 0);
  if (plan_.strategy == Strategy::simple) {
    lists_.indices = std::move(flat.indices), lists_.objects = std::move(flat.objects);
  } else {
    lists_.indices.resize(3 * order.size()), lists_.objects.resize(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      std::copy_n(flat.indices.begin() + 3 * std::ptrdiff_t{order[i]}, 3,
                  lists_.indices.begin() + 3 * static_cast<std::ptrdiff_t>(i));
      lists_.objects[i] = flat.objects[order[i]];
    }
  }
  lists_.positions = std::move(flat.positions);
  lists_.texture_coordinates = std::move(flat.texture_coordinates);
  lists_.sources = std::move(order);
  seen_.assign(scene_.size(), 0);
  frame_ = 0;
  describe();
}

void DrawCallMethod::describe() {
  std::uint64_t bytes =
      lists_.positions.size() * sizeof(Vec3) + lists_.texture_coordinates.size() * sizeof(TextureCoordinate) +
      4 * (lists_.indices.size() + lists_.objects.size() + lists_.sources.size()) + 9 * scene_.size();
  for (const Layer& layer : layers_) bytes += layer.partition.bytes() + layer.batches.bytes();
  geometry_ = {lists_.positions,           lists_.indices,   lists_.objects, lists_.sources,
               lists_.texture_coordinates, plan_.submission, bytes};
}

TriangleLists DrawCallMethod::give_lists() {
  geometry_ = {};
  geometry_.submission = plan_.submission;
  return std::exchange(lists_, {});
}

void DrawCallMethod::cull(const View& view, Frame& frame) noexcept {
  frame.clear();
  ++frame_;
  in_view_ = not_hidden_ = 0;
  const Frustum frustum = make_frustum(view);
  const Facing facing(view, plan_.facing);
  frame.stats.objects = scene_.size();
  // A view that the buffer refuses is culled by the frustum alone.
  hides_ = plan_.occlusion && draw_occluders(view, frustum);
  for (const Layer& layer : layers_) {
    runs_.clear(), ranges_.clear();
    frame.stats.nodes_visited += layer.partition.walk(frustum, runs_);
    const bool transparent = &layer == &layers_[1];
    if (hides_) leave_out_hidden(layer, frame);
    if (hides_ && !transparent) {
      take_unhidden(layer, frame);
    } else {
      take(layer, facing, frame);
    }
    take_movers(frustum, transparent, frame);
    if (transparent) {
      blend_order_.arrange(scene_, view, ranges_);
    } else if (plan_.submission == Submission::merged) {
      merge();
    }
    submit(frame);
  }
  frame.stats.culled_facing = not_hidden_ - frame.visible.size();
  frame.stats.culled_occlusion = in_view_ - not_hidden_;
  frame.stats.culled_frustum = scene_.size() - in_view_;
}

void DrawCallMethod::reach(ObjectId object, Reached how_far, Frame& frame) noexcept {
  std::uint64_t& seen = seen_[object];
  const std::uint64_t before = std::max(seen, 4 * frame_), now = std::max(before, 4 * frame_ + how_far);
  const auto gets_to = [&](Reached step) { return before < 4 * frame_ + step && now >= 4 * frame_ + step; };
  in_view_ += gets_to(kInView);
  not_hidden_ += gets_to(kNotHidden);
  if (gets_to(kSubmitted)) frame.visible.push_back(object);
  seen = now;
}

void DrawCallMethod::take(const Layer& layer, const Facing& facing, Frame& frame) noexcept {
  const DrawBatches& batches = layer.batches;
  const bool faces = !batches.cones.empty();
  for (const auto& run : runs_) {
    for (std::uint32_t u = batches.cell_start[run.first_cell]; u < batches.cell_start[run.last_cell]; ++u) {
      const bool drawn = !faces || facing.may_face(batches.cones[u]);
      for (std::uint32_t o = batches.object_start[u]; o < batches.object_start[u + 1]; ++o)
        reach(batches.objects[o], drawn ? kSubmitted : kNotHidden, frame);
      if (!drawn) continue;
      ranges_.insert(ranges_.end(), batches.ranges.begin() + batches.range_start[u],
                     batches.ranges.begin() + batches.range_start[u + 1]);
    }
  }
}

void DrawCallMethod::merge() noexcept {
  // In the global list the runs of different cells interleave, and a triangle may stand in several.
  if (plan_.strategy == Strategy::simple) std::ranges::sort(ranges_, {}, &TriangleRange::first);
  merge_neighbours(ranges_);
}

void DrawCallMethod::submit(Frame& frame) const noexcept {
  for (const TriangleRange& range : ranges_) {
    frame.draws.push_back({3 * range.count, 1, 3 * range.first, 0, range.first});
    frame.stats.triangles += range.count;
  }
  frame.stats.draw_calls += plan_.submission == Submission::multi_draw ? !ranges_.empty() : ranges_.size();
}

std::vector<Box> DrawCallMethod::cells() const {
  std::vector<Box> boxes;
  for (const Layer& layer : layers_) {
    for (std::uint32_t cell = 0; cell < layer.partition.cells(); ++cell)
      boxes.push_back(layer.partition.bounds(cell));
  }
  return boxes;
}

}  // namespace sightline::methods
