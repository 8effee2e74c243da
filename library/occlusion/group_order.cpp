// Which of a mesh's triangles lie together in a group.
#include <algorithm>
#include <limits>

#include "library/geometry/linear.hpp"
#include "library/geometry/radix_sort.hpp"
#include "library/geometry/view_depth.hpp"
#include "library/occlusion/occluder_topology.hpp"

namespace sightline::occlusion {

namespace {

struct Extent {
  glm::vec3 low{std::numeric_limits<float>::max()}, high{-std::numeric_limits<float>::max()};

  void add(const Extent& other) { low = glm::min(low, other.low), high = glm::max(high, other.high); }
  [[nodiscard]] double area() const {
    const glm::dvec3 size = glm::dvec3(high) - glm::dvec3(low);
    return size.x * size.y + size.y * size.z + size.z * size.x;
  }
};

// Splits triangles again and again, between whole groups, where the groups' boxes become smallest by the
// surface area heuristic (Goldsmith & Salmon 1987).
class GroupOrder {
public:
  explicit GroupOrder(const OccluderTopology& mesh) {
    for (const auto& triangle : mesh.triangles) {
      Extent extent;
      for (const std::uint32_t i : triangle) {
        const Vec3& p = mesh.positions[i];
        extent.add({{p.x, p.y, p.z}, {p.x, p.y, p.z}});
      }
      order_.push_back(static_cast<std::uint32_t>(extents_.size()));
      extents_.push_back(extent);
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
    for (int axis = 0; axis < 3; ++axis) {
      sort_along(axis, first, end);
      if (const std::size_t at = find_better_cut(cuts > 0); at != 0) groups = at, best_.swap(keys_);
    }
    for (std::size_t i = 0; i < best_.size(); ++i) order_[first + i] = static_cast<std::uint32_t>(best_[i]);
    const std::size_t middle = first + groups * kGroup;
    split(first, middle, cuts - 1);
    split(middle, end, cuts - 1);
  }

  void sort_along(int axis, std::size_t first, std::size_t end) {
    keys_.clear();
    for (std::size_t i = first; i < end; ++i) {
      const Extent& its = extents_[order_[i]];
      const float middle = 0.5f * its.low[axis] + 0.5f * its.high[axis];
      keys_.push_back(std::uint64_t{geometry::sortable(middle)} << 32 | order_[i]);
    }
    geometry::sort_by_high_bits(keys_, room_, 32);
  }

  [[nodiscard]] const Extent& extent_of(std::uint64_t key) const {
    return extents_[static_cast<std::uint32_t>(key)];
  }

  // After how many groups a cut costs less than all before; 0 where none does.
  std::size_t find_better_cut(bool anywhere) {
    const std::size_t groups = (keys_.size() + kGroup - 1) / kGroup, margin = anywhere ? 1 : groups / 2;
    beyond_.resize(groups);
    Extent extent;
    for (std::size_t i = keys_.size(); i-- > 0;) {
      extent.add(extent_of(keys_[i]));
      if (i % kGroup == 0) beyond_[i / kGroup] = extent.area();
    }
    extent = {};
    std::size_t better = 0;
    for (std::size_t at = 1; at <= groups - margin; ++at) {
      for (std::size_t i = (at - 1) * kGroup; i < at * kGroup; ++i) extent.add(extent_of(keys_[i]));
      const double cost =
          extent.area() * static_cast<double>(at) + beyond_[at] * static_cast<double>(groups - at);
      if (at >= margin && cost < least_) least_ = cost, better = at;
    }
    return better;
  }

  std::vector<Extent> extents_;  // by triangle
  std::vector<std::uint32_t> order_;
  std::vector<std::uint64_t> keys_, best_, room_;  // where a triangle's middle lies, and its number
  std::vector<double> beyond_;                     // from each group on, the surface of what is left
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
