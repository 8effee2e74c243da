// Which of a mesh's triangles lie together in a group.
#include <algorithm>
#include <limits>

#include "library/geometry/box_math.hpp"
#include "library/geometry/radix_sort.hpp"
#include "library/geometry/view_depth.hpp"
#include "library/occlusion/occluder_topology.hpp"

namespace sightline::occlusion {

using namespace geometry;

namespace {

// Splits triangles again and again, between whole groups, where the groups' boxes become smallest by the
// surface area heuristic (Goldsmith & Salmon 1987).
class GroupOrder {
public:
  explicit GroupOrder(const OccluderTopology& mesh) {
    for (const auto& triangle : mesh.triangles) {
      Box box = kEmptyBox;
      for (const std::uint32_t i : triangle) box = united(box, {mesh.positions[i], mesh.positions[i]});
      order_.push_back(static_cast<std::uint32_t>(boxes_.size()));
      boxes_.push_back(box);
    }
    split(0, order_.size(), kMostCuts);
  }

  [[nodiscard]] const std::vector<std::uint32_t>& order() const { return order_; }

private:
  static constexpr std::size_t kGroup = OccluderTopology::kGroup;
  // Cuts where it costs least, one within another as often as that; then in the middle.
  static constexpr int kMostCuts = 48;

  void split(std::size_t first, std::size_t end, int cuts) {
    if (end - first <= kGroup) return;
    least_ = std::numeric_limits<double>::infinity();
    std::size_t groups = 0;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      sort_along(axis, first, end);
      if (const std::size_t at = find_better_cut(cuts > 0); at != 0) groups = at, best_.swap(keys_);
    }
    for (std::size_t i = 0; i < best_.size(); ++i) order_[first + i] = static_cast<std::uint32_t>(best_[i]);
    const std::size_t middle = first + groups * kGroup;
    split(first, middle, cuts - 1);
    split(middle, end, cuts - 1);
  }

  void sort_along(std::uint32_t axis, std::size_t first, std::size_t end) {
    keys_.clear();
    for (std::size_t i = first; i < end; ++i) {
      const float middle = coordinate(centre_of(boxes_[order_[i]]), axis);
      keys_.push_back(std::uint64_t{sortable(middle)} << 32 | order_[i]);
    }
    sort_by_high_bits(keys_, room_, 32);
  }

  [[nodiscard]] Box with(const Box& box, std::uint64_t key) const {
    return united(box, boxes_[static_cast<std::uint32_t>(key)]);
  }

  // After how many groups a cut costs less than all before; 0 where none does.
  std::size_t find_better_cut(bool anywhere) {
    const std::size_t groups = (keys_.size() + kGroup - 1) / kGroup, margin = anywhere ? 1 : groups / 2;
    beyond_.resize(groups);
    Box box = kEmptyBox;
    for (std::size_t i = keys_.size(); i-- > 0;) {
      box = with(box, keys_[i]);
      if (i % kGroup == 0) beyond_[i / kGroup] = half_area(box);
    }
    box = kEmptyBox;
    std::size_t better = 0;
    for (std::size_t at = 1; at <= groups - margin; ++at) {
      for (std::size_t i = (at - 1) * kGroup; i < at * kGroup; ++i) box = with(box, keys_[i]);
      const double cost =
          half_area(box) * static_cast<double>(at) + beyond_[at] * static_cast<double>(groups - at);
      if (at >= margin && cost < least_) least_ = cost, better = at;
    }
    return better;
  }

  std::vector<Box> boxes_;  // by triangle
  std::vector<std::uint32_t> order_;
  std::vector<std::uint64_t> keys_, best_, room_;  // where a triangle's middle lies, and its number
  std::vector<double> beyond_;                     // from each group on, half the surface of what is left
  double least_ = 0;
};

}  // namespace

void sort_into_groups(OccluderTopology& mesh) {
  const GroupOrder groups(mesh);
  const auto triangles = mesh.triangles;
  const auto one_sided = mesh.one_sided;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    mesh.triangles[i] = triangles[groups.order()[i]];
    mesh.one_sided[i] = one_sided[groups.order()[i]];
  }
}

}  // namespace sightline::occlusion
