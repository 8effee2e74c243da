// Boxes as a structure of arrays, for callers who have no arrays of their own yet.
#pragma once

#include <cstddef>
#include <vector>

#include <sightline/box_view.hpp>
#include <sightline/cache_aligned.hpp>
#include <sightline/types.hpp>

namespace sightline {

/// Many boxes in metres, one array a coordinate, all of one length: the layout that flat culling reads
/// fastest.
///
/// Unless a function of it says otherwise: Errors: none. Cost: constant. Threads: many may read at once, or
/// one write. Allocates: nothing.
struct Boxes {
  /// Begins with a cache line.
  using Array = std::vector<float, CacheAligned<float>>;
  Array min_x, min_y, min_z, max_x, max_y, max_z;  ///< metres

  /// How many boxes there are.
  [[nodiscard]] std::size_t size() const noexcept { return min_x.size(); }
  /// Box i < size().
  [[nodiscard]] Box operator[](std::size_t i) const noexcept {
    return {{min_x[i], min_y[i], min_z[i]}, {max_x[i], max_y[i], max_z[i]}};
  }
  /// All of them, as long as they stand where they are.
  [[nodiscard]] BoxView view() const noexcept {
    return BoxView::arrays(min_x.data(), min_y.data(), min_z.data(), max_x.data(), max_y.data(), max_z.data(),
                           size());
  }
  /// Replaces box i < size().
  void set(std::size_t i, const Box& box) noexcept;
  /// Cost: constant, amortised. Allocates: as std::vector does.
  void push_back(const Box& box);
  /// Cost: linear. Allocates: as std::vector does.
  void resize(std::size_t count);
  /// Cost: linear. Allocates: as std::vector does.
  void reserve(std::size_t count);
};

}  // namespace sightline
