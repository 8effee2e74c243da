// Our own hierarchy for rays: binned SAH (Wald 2007) collapsed to nodes of eight boxes that SIMD tests at
// once, leaves of up to eight boxes in the same layout.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <sightline/boxes.hpp>

#include "library/geometry/aligned_vector.hpp"

namespace sightline::rays {

inline constexpr std::uint32_t kWide = 8;

/// Eight boxes in structure of arrays, and what stands behind each. Lanes without a box hold one that no ray
/// hits (min = +infinity, max = -infinity).
struct alignas(64) WideNode {
  std::array<float, kWide> min_x, min_y, min_z, max_x, max_y, max_z;
  /// In an inner node: an object, or a node | kInner or kLeaf. In a leaf: objects.
  std::array<std::uint32_t, kWide> child;

  static constexpr std::uint32_t kInner = 0x40000000u, kLeaf = 0x80000000u, kIndex = 0x3fffffffu;

  void set(std::uint32_t lane, const Box& box) noexcept;
  void clear(std::uint32_t lane) noexcept;
  [[nodiscard]] Box bounds() const noexcept;  ///< union of all lanes
};

/// For at most 2^30 boxes, finite with min <= max.
class WideBvh {
public:
  void build(const Boxes& boxes);
  /// Takes over moved boxes, as many as were built with.
  void refit(const Boxes& boxes) noexcept;

  /// Nodes, children after their parents. The root is nodes()[0] and always an inner node; empty for no
  /// boxes.
  [[nodiscard]] std::span<const WideNode> nodes() const noexcept { return nodes_; }
  [[nodiscard]] std::size_t size() const noexcept { return objects_; }  ///< boxes
  /// The most entries that a depth-first walk ever has waiting, itself pushing every child.
  [[nodiscard]] std::uint32_t stack_size() const noexcept { return (kWide - 1) * depth_ + kWide; }

private:
  struct Builder;
  geometry::LargeVector<WideNode> nodes_;
  std::size_t objects_ = 0;
  std::uint32_t depth_ = 0;
};

}  // namespace sightline::rays
