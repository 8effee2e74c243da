// Objects that move are drawn whole where their boxes are in view. The copies in the cells that they left
// share their corners: what is drawn of those stands where the object does, and does no harm.
#include "workbench/methods/draw_calls/draw_call_method.hpp"
#include "workbench/partition/triangle_partition.hpp"

namespace sightline::methods {

void DrawCallMethod::do_update(std::span<const ObjectId> moved) {
  if (moved.empty()) return;
  if (occluders_) occluders_->update(moved);
  std::size_t fresh = 0;
  for (const ObjectId object : moved) fresh += !is_mover_[object];
  if (lists_.indices.empty() || 4 * (movers_.size() + fresh) > scene_.size()) {
    rebuild();
    return;
  }
  if (first_corner_.empty()) {
    first_corner_.push_back(0), first_source_.push_back(0);
    for (ObjectId object = 0; object < scene_.size(); ++object) {
      const Mesh& mesh = scene_.meshes[scene_.mesh[object]];
      first_corner_.push_back(first_corner_.back() + mesh.vertex_count);
      first_source_.push_back(first_source_.back() + mesh.index_count / 3);
    }
  }
  for (const ObjectId object : moved) {
    place(object);
    if (!is_mover_[object]) add_mover(object);
  }
  describe();
}

void DrawCallMethod::place(ObjectId object) {
  const Mesh& mesh = scene_.meshes[scene_.mesh[object]];
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    lists_.positions[first_corner_[object] + v] =
        transform_point(scene_.transform[object], scene_.positions[mesh.first_vertex + v]);
  }
}

void DrawCallMethod::add_mover(ObjectId object) {
  const Mesh& mesh = scene_.meshes[scene_.mesh[object]];
  TriangleRange range{first_source_[object], mesh.index_count / 3};  // in the global list of `simple`
  if (scene_.surface[object] == Surface::transparent) {
    range = blend_order_.range_of(object);
  } else if (plan_.strategy != Strategy::simple) {
    range.first = static_cast<std::uint32_t>(lists_.objects.size());
    append_indices(scene_, object, first_corner_[object], lists_.indices);
    for (std::uint32_t t = 0; t < range.count; ++t) lists_.sources.push_back(first_source_[object] + t);
    lists_.objects.insert(lists_.objects.end(), range.count, object);
  }
  is_mover_[object] = 1;
  if (range.count > 0) movers_.push_back({object, range});
}

void DrawCallMethod::take_movers(const Frustum& frustum, bool transparent, Frame& frame) noexcept {
  for (const Mover& mover : movers_) {
    if ((scene_.surface[mover.object] == Surface::transparent) != transparent) continue;
    ++frame.stats.tested;
    if (!overlaps(frustum, scene_.bounds[mover.object])) continue;
    const bool hidden = hides_ && !occluders_->buffer().may_see(scene_.bounds[mover.object]);
    reach(mover.object, hidden ? kInView : kSubmitted, frame);
    if (hidden) continue;
    ranges_.push_back(mover.range);
  }
}

}  // namespace sightline::methods
