// The order of transparent triangles. Copies in cells will not do for them: one that crosses cells would be
// blended over itself, and cells are in no order of depth.
#pragma once

#include <vector>

#include <sightline/view.hpp>

#include "workbench/methods/draw_calls/draw_batches.hpp"

namespace sightline::methods {

class BlendOrder {
public:
  BlendOrder() = default;
  /// `triangles` are numbers of flat triangles, ascending; positions[i] is where triangles[i] stands in the
  /// list that is drawn from, an object's side by side.
  BlendOrder(const FlatTriangles& flat, std::span<const std::uint32_t> triangles,
             std::span<const std::uint32_t> positions);

  /// An object's triangles in the list; none where it has none.
  [[nodiscard]] TriangleRange range_of(ObjectId object) const noexcept;

  /// Puts ranges of the list, in any order and overlapping or not, in the order in which whole objects are
  /// blended: objects far to near by their boxes' centres, equal ones by number, each one's triangles in
  /// theirs; every triangle once. Allocates nothing once it has grown.
  void arrange(const Scene& scene, const View& view, std::vector<TriangleRange>& ranges) noexcept;

private:
  struct Object {
    ObjectId object;
    std::uint32_t first, end;  ///< in the list
  };
  struct Piece {
    std::uint64_t key;  ///< far to near, then the object
    TriangleRange range;
  };

  std::vector<Object> objects_;  ///< ascending
  std::vector<Piece> pieces_;
};

/// Makes each range that touches the one before part of it. Ranges ascend, and may overlap.
void merge_neighbours(std::vector<TriangleRange>& ranges) noexcept;

}  // namespace sightline::methods
