#include "workbench/methods/ray_pvs/break_time.hpp"

#include <limits>

#include "workbench/methods/ray_pvs/nearest_box.hpp"

namespace sightline::methods {

BreakTimeSets::BreakTimeSets(const Scene& scene, std::uint32_t side) : targets_(scene), side_(side) {
  bvh_.build(targets_.solid());
}

void BreakTimeSets::cast(const View& view, std::vector<ObjectId>& visible) {
  grid_.make(view, side_, side_);
  cast_down_bvh(bvh_, grid_.prepared, hits_);
  targets_.collect(grid_.prepared, hits_, seen_, visible);
}

void BreakTimeSets::add(const View& view) {
  cast(view, visible_);
  kept_.push_back({eye_position(view), view_direction(view), objects_.size(), visible_.size()});
  objects_.insert(objects_.end(), visible_.begin(), visible_.end());
}

std::span<const ObjectId> BreakTimeSets::look_up(const View& view) const noexcept {
  const Vec3 eye = eye_position(view), direction = view_direction(view);
  const Kept* nearest = nullptr;
  float least = std::numeric_limits<float>::infinity(), most_alike = -2;
  for (const Kept& kept : kept_) {
    const float x = kept.eye.x - eye.x, y = kept.eye.y - eye.y, z = kept.eye.z - eye.z;
    const float squared = x * x + y * y + z * z;
    const float alike =
        kept.direction.x * direction.x + kept.direction.y * direction.y + kept.direction.z * direction.z;
    if (squared > least || (squared == least && alike <= most_alike)) continue;
    nearest = &kept, least = squared, most_alike = alike;
  }
  if (!nearest) return {};
  return std::span(objects_).subspan(nearest->first, nearest->count);
}

}  // namespace sightline::methods
