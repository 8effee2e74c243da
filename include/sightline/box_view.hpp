// Boxes, spheres and whatever else stands in the caller's own arrays: read where they lie, in any layout,
// without copies.
//
//   struct Thing { float position[3]; float half[3]; … };
//   std::vector<Thing> things;
//   const auto boxes = sightline::BoxView::centre_half(things[0].position, things[0].half,
//                                                      sizeof(Thing), things.size());
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include <sightline/types.hpp>

namespace sightline {

/// `size` elements of type T, `stride` bytes from one to the next, anywhere in the caller's memory: a member
/// of a struct, a column of a table. Elements need no alignment. T is a plain type; const T is for
/// reading only.
///
/// Unless a function of it says otherwise: Errors: none. Cost: constant. Threads: as the memory behind it.
/// Allocates: nothing.
template <class T>
class Strided {
  using Bytes = std::conditional_t<std::is_const_v<T>, const std::byte, std::byte>;
  using Pointer = std::conditional_t<std::is_const_v<T>, const void, void>;
  static_assert(std::is_trivially_copyable_v<T>);

public:
  /// An element as it is read and written.
  using Value = std::remove_const_t<T>;

  constexpr Strided() noexcept = default;
  /// `size` elements from `first` on; `stride` in bytes.
  constexpr Strided(Pointer* first, std::size_t size, std::size_t stride = sizeof(T)) noexcept
      : first_(static_cast<Bytes*>(first)), size_(size), stride_(stride) {}
  /// A whole span, vector or array.
  template <class Range>
  requires std::is_constructible_v<std::span<T>, Range&> constexpr Strided(Range&& range) noexcept
      : Strided(std::span<T>(range).data(), std::span<T>(range).size()) {}

  /// How many elements there are.
  [[nodiscard]] constexpr std::size_t size() const noexcept { return size_; }
  /// Where the first element stands, or null.
  [[nodiscard]] constexpr Pointer* data() const noexcept { return first_; }
  /// Bytes from an element to the next.
  [[nodiscard]] constexpr std::size_t stride() const noexcept { return stride_; }
  /// Whether there is memory, and elements do not overlap. What is not sound is refused by whoever is given
  /// it.
  [[nodiscard]] constexpr bool sound() const noexcept {
    return size_ == 0 || (first_ != nullptr && stride_ >= sizeof(T) && size_ <= kMostBytes / stride_);
  }

  /// Element i < size().
  [[nodiscard]] Value operator[](std::size_t i) const noexcept {
    Value value;
    std::memcpy(&value, first_ + i * stride_, sizeof value);
    return value;
  }
  /// Writes element i < size().
  void set(std::size_t i, const Value& value) const noexcept requires(!std::is_const_v<T>) {
    std::memcpy(first_ + i * stride_, &value, sizeof value);
  }

  /// The same, for reading.
  constexpr operator Strided<const T>() const noexcept requires(!std::is_const_v<T>) {
    return {first_, size_, stride_};
  }

private:
  static constexpr std::size_t kMostBytes = static_cast<std::size_t>(-1) / 2;

  Bytes* first_ = nullptr;
  std::size_t size_ = 0, stride_ = sizeof(T);
};

/// Axis-aligned boxes in the caller's own arrays, in metres, whatever they look like: minimum and maximum or
/// centre and half size, single or double precision, structs or arrays. What does not fit what the library
/// keeps is rounded outwards, so that a box is never smaller than it was given. Single precision may be
/// relative to an `origin`.
///
/// Memory is read while a function that was given the view runs, not later. Numbers need no alignment.
/// Strides are in bytes, from a box to the next. A view whose pointers are null or whose strides are shorter
/// than what they step over is not sound(), and refused.
///
/// Unless a function of it says otherwise: Errors: none. Cost: constant. Threads: as the memory behind it.
/// Allocates: nothing.
class BoxView {
public:
  BoxView() noexcept = default;
  /// A whole span, vector or array of Box, about an origin.
  template <class Range>
  requires std::is_constructible_v < std::span<const Box>,
  const Range& > BoxView(const Range& boxes, const WorldPoint& origin = {}) noexcept
      : BoxView(whole(std::span<const Box>(boxes), origin)) {}
  /// A whole span, vector or array of WorldBox.
  template <class Range>
  requires std::is_constructible_v < std::span<const WorldBox>,
  const Range& > BoxView(const Range& boxes) noexcept : BoxView(whole(std::span<const WorldBox>(boxes))) {}

  /// Six numbers a box, one after another: minimum x, y, z, maximum x, y, z.
  static BoxView min_max(const float* first, std::size_t stride, std::size_t count,
                         const WorldPoint& origin = {}) noexcept {
    return {corners, first, first ? first + 3 : nullptr, stride, count, 6 * sizeof(float), origin};
  }
  /// The same in double precision.
  static BoxView min_max(const double* first, std::size_t stride, std::size_t count) noexcept {
    return {corners, first, first ? first + 3 : nullptr, stride, count, 6 * sizeof(double)};
  }
  /// Minimum and maximum apart, three numbers each.
  static BoxView min_max(const float* minimum, const float* maximum, std::size_t stride, std::size_t count,
                         const WorldPoint& origin = {}) noexcept {
    return {corners, minimum, maximum, stride, count, 3 * sizeof(float), origin};
  }
  /// The same in double precision.
  static BoxView min_max(const double* minimum, const double* maximum, std::size_t stride,
                         std::size_t count) noexcept {
    return {corners, minimum, maximum, stride, count, 3 * sizeof(double)};
  }
  /// Centre and half size, three numbers each; half sizes are not negative.
  static BoxView centre_half(const float* centre, const float* half, std::size_t stride, std::size_t count,
                             const WorldPoint& origin = {}) noexcept {
    return {centre_and_half, centre, half, stride, count, 3 * sizeof(float), origin};
  }
  /// The same in double precision.
  static BoxView centre_half(const double* centre, const double* half, std::size_t stride,
                             std::size_t count) noexcept {
    return {centre_and_half, centre, half, stride, count, 3 * sizeof(double)};
  }
  /// An array a coordinate, `count` numbers each: the fastest to cull flat.
  static BoxView arrays(const float* min_x, const float* min_y, const float* min_z, const float* max_x,
                        const float* max_y, const float* max_z, std::size_t count,
                        const WorldPoint& origin = {}) noexcept {
    BoxView view(corners, min_x, max_x, sizeof(float), count, sizeof(float), origin);
    view.coordinates_[1] = min_y, view.coordinates_[2] = min_z;
    view.coordinates_[4] = max_y, view.coordinates_[5] = max_z;
    return view;
  }

  /// How many boxes there are.
  [[nodiscard]] std::size_t size() const noexcept { return count_; }
  /// Added to single-precision coordinates.
  [[nodiscard]] const WorldPoint& origin() const noexcept { return origin_; }
  /// Whether all pointers are there and strides step over what they should.
  [[nodiscard]] bool sound() const noexcept;
  /// Box i < size() of a sound view, rounded outwards; it may be as invalid as what it was read from.
  [[nodiscard]] WorldBox operator[](std::size_t i) const noexcept;
  /// Boxes first … first + count - 1, all below size().
  [[nodiscard]] BoxView part(std::size_t first, std::size_t count) const noexcept;

private:
  friend struct BoxReader;
  enum Form : std::uint8_t { corners, centre_and_half };

  static BoxView whole(std::span<const Box> boxes, const WorldPoint& origin) noexcept {
    return min_max(boxes.empty() ? nullptr : &boxes[0].min.x, sizeof(Box), boxes.size(), origin);
  }
  static BoxView whole(std::span<const WorldBox> boxes) noexcept {
    return min_max(boxes.empty() ? nullptr : &boxes[0].min.x, sizeof(WorldBox), boxes.size());
  }
  template <class Number>
  BoxView(Form form, const Number* a, const Number* b, std::size_t stride, std::size_t count,
          std::size_t least_stride, const WorldPoint& origin = {}) noexcept
      : stride_(stride),
        count_(count),
        origin_(origin),
        least_stride_(static_cast<std::uint8_t>(least_stride)),
        form_(form),
        doubles_(sizeof(Number) == sizeof(double)) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      coordinates_[axis] = a ? a + axis : nullptr;
      coordinates_[3 + axis] = b ? b + axis : nullptr;
    }
  }

  const void* coordinates_[6] = {};  // of box 0: minimum or centre x, y, z, then maximum or half
  std::size_t stride_ = sizeof(Box), count_ = 0;
  WorldPoint origin_;
  std::uint8_t least_stride_ = 0;
  Form form_ = corners;
  bool doubles_ = false;
};

/// Spheres in the caller's own arrays, in metres and single precision.
///
/// Unless a function of it says otherwise: Errors: none. Cost: constant. Threads: as the memory behind it.
/// Allocates: nothing.
class SphereView {
public:
  SphereView() noexcept = default;
  /// A whole span, vector or array.
  template <class Range>
  requires std::is_constructible_v < std::span<const Sphere>,
  const Range& > SphereView(const Range& range) noexcept {
    const std::span<const Sphere> spheres(range);
    if (!spheres.empty())
      *this = SphereView(&spheres[0].centre.x, &spheres[0].radius, sizeof(Sphere), spheres.size());
  }
  /// Three numbers a centre, one a radius; `stride` bytes from a sphere to the next.
  SphereView(const float* centre, const float* radius, std::size_t stride, std::size_t count) noexcept
      : coordinates_{centre, centre ? centre + 1 : nullptr, centre ? centre + 2 : nullptr, radius},
        stride_(stride),
        count_(count),
        least_stride_(3 * sizeof(float)) {}
  /// An array a coordinate, `count` numbers each: the fastest to cull flat.
  static SphereView arrays(const float* x, const float* y, const float* z, const float* radius,
                           std::size_t count) noexcept {
    SphereView view(x, radius, sizeof(float), count);
    view.coordinates_[1] = y, view.coordinates_[2] = z;
    view.least_stride_ = sizeof(float);
    return view;
  }

  /// How many spheres there are.
  [[nodiscard]] std::size_t size() const noexcept { return count_; }
  /// Whether all pointers are there and strides step over what they should.
  [[nodiscard]] bool sound() const noexcept;
  /// Sphere i < size() of a sound view.
  [[nodiscard]] Sphere operator[](std::size_t i) const noexcept;

private:
  friend struct BoxReader;

  const float* coordinates_[4] = {};  // of sphere 0: x, y, z, radius
  std::size_t stride_ = sizeof(Sphere), count_ = 0;
  std::size_t least_stride_ = 0;
};

}  // namespace sightline
