#include "library/rays/wide_bvh.hpp"

#include <algorithm>
#include <limits>

#include "library/geometry/box_math.hpp"

namespace sightline::rays {

using namespace geometry;

namespace {

constexpr std::uint32_t kBins = 16;

void include(Box& box, const Box& other) {
  box = united(box, other);
}

struct Reference {
  Box box;
  std::array<float, 3> centre;
  ObjectId object;
};

struct Range {
  std::uint32_t first, last;
  Box box;
  double area;

  [[nodiscard]] std::uint32_t count() const { return last - first; }
};

}  // namespace

void WideNode::set(std::uint32_t lane, const Box& box) noexcept {
  min_x[lane] = box.min.x, min_y[lane] = box.min.y, min_z[lane] = box.min.z;
  max_x[lane] = box.max.x, max_y[lane] = box.max.y, max_z[lane] = box.max.z;
}

void WideNode::clear(std::uint32_t lane) noexcept {
  set(lane, kEmptyBox);
  child[lane] = kNoObject;
}

Box WideNode::bounds() const noexcept {
  const auto low = [](const auto& a) { return *std::min_element(a.begin(), a.end()); };
  const auto high = [](const auto& a) { return *std::max_element(a.begin(), a.end()); };
  return {{low(min_x), low(min_y), low(min_z)}, {high(max_x), high(max_y), high(max_z)}};
}

struct WideBvh::Builder {
  std::vector<Reference> references;
  geometry::LargeVector<WideNode>& nodes;
  std::uint32_t depth = 0;

  [[nodiscard]] Range range(std::uint32_t first, std::uint32_t last) const {
    Range made{first, last, kEmptyBox, 0};
    for (std::uint32_t i = first; i < last; ++i) include(made.box, references[i].box);
    made.area = half_area(made.box);
    return made;
  }

  // Where the surface area heuristic cuts a range of more than one box, after moving its boxes to their
  // sides.
  std::uint32_t split(const Range& r) {
    std::array<float, 3> low, high;
    low.fill(kInfinity), high.fill(-kInfinity);
    for (std::uint32_t i = r.first; i < r.last; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], references[i].centre[axis]);
        high[axis] = std::max(high[axis], references[i].centre[axis]);
      }
    }
    double best = std::numeric_limits<double>::infinity();
    int best_axis = -1;
    std::uint32_t best_bin = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(low[axis] < high[axis])) continue;
      std::array<Box, kBins> boxes;
      std::array<std::uint32_t, kBins> counts{};
      boxes.fill(kEmptyBox);
      for (std::uint32_t i = r.first; i < r.last; ++i) {
        const std::uint32_t bin = bin_of(references[i].centre[axis], low[axis], high[axis]);
        include(boxes[bin], references[i].box);
        ++counts[bin];
      }
      std::array<double, kBins> right{};
      Box sum = kEmptyBox;
      std::uint32_t count = 0;
      for (std::uint32_t bin = kBins; bin-- > 1;) {
        include(sum, boxes[bin]);
        count += counts[bin];
        right[bin] = half_area(sum) * count;
      }
      sum = kEmptyBox, count = 0;
      for (std::uint32_t bin = 1; bin < kBins; ++bin) {
        include(sum, boxes[bin - 1]);
        count += counts[bin - 1];
        const double cost = half_area(sum) * count + right[bin];
        if (count > 0 && count < r.count() && cost < best) best = cost, best_axis = axis, best_bin = bin;
      }
    }
    const auto begin = references.begin() + r.first, end = references.begin() + r.last;
    if (best_axis < 0) return r.first + r.count() / 2;  // all centres in one place
    const auto middle = std::partition(begin, end, [&](const Reference& reference) {
      return bin_of(reference.centre[best_axis], low[best_axis], high[best_axis]) < best_bin;
    });
    return static_cast<std::uint32_t>(middle - references.begin());
  }

  static std::uint32_t bin_of(float centre, float low, float high) {
    const double share = (double{centre} - low) / (double{high} - low);
    return std::min(kBins - 1, static_cast<std::uint32_t>(share * kBins));
  }

  std::uint32_t add_leaf(const Range& r) {
    const auto index = static_cast<std::uint32_t>(nodes.size());
    WideNode& node = nodes.emplace_back();
    for (std::uint32_t lane = 0; lane < kWide; ++lane) {
      if (lane >= r.count()) {
        node.clear(lane);
        continue;
      }
      node.set(lane, references[r.first + lane].box);
      node.child[lane] = references[r.first + lane].object;
    }
    return index;
  }

  std::uint32_t add_inner(const Range& whole, std::uint32_t level) {
    depth = std::max(depth, level);
    const auto index = static_cast<std::uint32_t>(nodes.size());
    nodes.emplace_back();
    std::array<Range, kWide> children{whole};
    std::uint32_t count = 1;
    // The widest goes on being cut while it is more than a leaf can hold.
    while (count < kWide) {
      std::uint32_t widest = kWide;
      for (std::uint32_t i = 0; i < count; ++i) {
        if (children[i].count() > kWide && (widest == kWide || children[i].area > children[widest].area))
          widest = i;
      }
      if (widest == kWide) break;
      const Range r = children[widest];
      const std::uint32_t middle = split(r);
      children[widest] = range(r.first, middle);
      children[count++] = range(middle, r.last);
    }
    for (std::uint32_t lane = 0; lane < kWide; ++lane) {
      if (lane >= count) {
        nodes[index].clear(lane);
        continue;
      }
      const Range& r = children[lane];
      std::uint32_t child;
      if (r.count() == 1) {
        child = references[r.first].object;
      } else if (r.count() <= kWide) {
        child = add_leaf(r) | WideNode::kLeaf;
      } else {
        child = add_inner(r, level + 1) | WideNode::kInner;
      }
      nodes[index].set(lane, r.box);
      nodes[index].child[lane] = child;
    }
    return index;
  }
};

void WideBvh::build(const Boxes& boxes) {
  nodes_.clear();
  depth_ = 0;
  objects_ = boxes.size();
  if (boxes.size() == 0) return;
  Builder builder{{}, nodes_};
  builder.references.reserve(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Vec3 centre = centre_of(boxes[i]);
    builder.references.push_back({boxes[i], {centre.x, centre.y, centre.z}, static_cast<ObjectId>(i)});
  }
  builder.add_inner(builder.range(0, static_cast<std::uint32_t>(boxes.size())), 1);
  depth_ = builder.depth;
}

void WideBvh::refit(const Boxes& boxes) noexcept {
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    WideNode& node = nodes_[i];
    for (std::uint32_t lane = 0; lane < kWide; ++lane) {
      const std::uint32_t child = node.child[lane];
      if (child == kNoObject) continue;
      const bool below = (child & (WideNode::kInner | WideNode::kLeaf)) != 0;
      node.set(lane, below ? nodes_[child & WideNode::kIndex].bounds() : boxes[child]);
    }
  }
}

}  // namespace sightline::rays
