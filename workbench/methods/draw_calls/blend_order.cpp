#include "workbench/methods/draw_calls/blend_order.hpp"

#include <algorithm>

#include "library/geometry/view_depth.hpp"

namespace sightline::methods {

BlendOrder::BlendOrder(const FlatTriangles& flat, std::span<const std::uint32_t> triangles,
                       std::span<const std::uint32_t> positions) {
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const ObjectId object = flat.objects[triangles[i]];
    if (objects_.empty() || objects_.back().object != object)
      objects_.push_back({object, positions[i], positions[i]});
    objects_.back().end = positions[i] + 1;
  }
}

TriangleRange BlendOrder::range_of(ObjectId object) const noexcept {
  const auto at = std::ranges::lower_bound(objects_, object, {}, &Object::object);
  if (at == objects_.end() || at->object != object) return {};
  return {at->first, at->end - at->first};
}

void BlendOrder::arrange(const Scene& scene, const View& view, std::vector<TriangleRange>& ranges) noexcept {
  if (ranges.empty()) return;
  std::ranges::sort(ranges, {}, &TriangleRange::first);
  merge_neighbours(ranges);
  const Vec3 eye = eye_position(view), forward = view_direction(view);
  pieces_.clear();
  auto object = objects_.begin();
  for (const TriangleRange& range : ranges) {
    for (std::uint32_t first = range.first; first < range.first + range.count;) {
      while (object->end <= first) ++object;
      const std::uint32_t end = std::min(object->end, range.first + range.count);
      const float depth = geometry::view_depth(scene.bounds[object->object], eye, forward);
      pieces_.push_back(
          {std::uint64_t{~geometry::sortable(depth)} << 32 | object->object, {first, end - first}});
      first = end;
    }
  }
  std::ranges::sort(pieces_, [](const Piece& a, const Piece& b) {
    return a.key != b.key ? a.key < b.key : a.range.first < b.range.first;
  });
  ranges.clear();
  for (const Piece& piece : pieces_) {
    if (!ranges.empty() && ranges.back().first + ranges.back().count == piece.range.first) {
      ranges.back().count += piece.range.count;
    } else {
      ranges.push_back(piece.range);
    }
  }
}

void merge_neighbours(std::vector<TriangleRange>& ranges) noexcept {
  if (ranges.empty()) return;
  std::size_t last = 0;
  for (std::size_t i = 1; i < ranges.size(); ++i) {
    TriangleRange& open = ranges[last];
    if (ranges[i].first <= open.first + open.count) {
      open.count = std::max(open.count, ranges[i].first + ranges[i].count - open.first);
    } else {
      ranges[++last] = ranges[i];
    }
  }
  ranges.resize(last + 1);
}

}  // namespace sightline::methods
