// Many boxes or spheres in structure of arrays, as the tests of whole batches want them.
#pragma once

#include <cstddef>
#include <vector>

#include <sightline/types.hpp>

namespace sightline {

/// Many boxes, one array a coordinate, all of one length.
struct Boxes {
  std::vector<float> min_x, min_y, min_z, max_x, max_y, max_z;

  [[nodiscard]] std::size_t size() const noexcept { return min_x.size(); }
  [[nodiscard]] Box operator[](std::size_t i) const noexcept {
    return {{min_x[i], min_y[i], min_z[i]}, {max_x[i], max_y[i], max_z[i]}};
  }
  void set(std::size_t i, const Box& box) noexcept;
  void push_back(const Box& box);
  void resize(std::size_t count);
  void reserve(std::size_t count);
};

/// Views on `count` boxes, one array a coordinate.
struct BoxSpan {
  const float *min_x = nullptr, *min_y = nullptr, *min_z = nullptr;
  const float *max_x = nullptr, *max_y = nullptr, *max_z = nullptr;
  std::size_t count = 0;
};

/// Views on `count` spheres, one array a coordinate.
struct SphereSpan {
  const float *x = nullptr, *y = nullptr, *z = nullptr, *radius = nullptr;
  std::size_t count = 0;
};

BoxSpan span_of(const Boxes& boxes) noexcept;

}  // namespace sightline
