#include <sightline/box_view.hpp>

#include <algorithm>
#include <limits>

#include "library/geometry/box_blocks.hpp"
#include "library/geometry/box_reader.hpp"
#include "library/geometry/mutant.h"
#include "library/geometry/rounding.hpp"

namespace sightline {

using namespace geometry;

namespace {

// Elements that a memory of half the address space could hold, `stride` bytes apart.
bool sound_stride(std::size_t count, std::size_t stride, std::size_t least) {
  constexpr std::size_t kMostBytes = static_cast<std::size_t>(-1) / 2;
  return stride >= least && least > 0 && count <= kMostBytes / stride;
}

template <class Number>
Number load(const void* base, std::size_t offset) {
  Number value;
  std::memcpy(&value, static_cast<const std::byte*>(base) + offset, sizeof value);
  return value;
}

// One axis of a box: two numbers of the caller's, and what the library makes of them.
template <class Number, bool centred, bool moved, bool outwards>
void read_axis(const void* a, const void* b, std::size_t offset, double origin, double& low, double& high) {
  constexpr auto low_sum = outwards ? sum_down : sum_up, high_sum = outwards ? sum_up : sum_down;
  const double first = load<Number>(a, offset), second = load<Number>(b, offset);
  low = centred ? low_sum(first, -second) : first;
  high = centred ? high_sum(first, second) : second;
  // No box, rather than one turned inside out and then about.
  if (centred && !(second >= 0)) low = high = std::numeric_limits<double>::quiet_NaN();
  if (moved) low = low_sum(origin, low), high = high_sum(origin, high);
}

template <class T>
bool aligned(const void* at) {
  return reinterpret_cast<std::uintptr_t>(at) % alignof(T) == 0;
}

struct Source {
  const void* const (&coordinates)[6];
  std::size_t offset, stride, count;
  WorldPoint origin;
};

template <class Number, bool centred, bool moved, bool outwards>
void read_boxes(Source from, WorldBox* out) {
  const auto read = read_axis<Number, centred, moved, outwards>;
  for (std::size_t i = 0; i < from.count; ++i, from.offset += from.stride) {
    const auto& c = from.coordinates;
    WorldBox& box = out[i];
    read(c[0], c[3], from.offset, from.origin.x, box.min.x, box.max.x);
    read(c[1], c[4], from.offset, from.origin.y, box.min.y, box.max.y);
    read(c[2], c[5], from.offset, from.origin.z, box.min.z, box.max.z);
  }
}

template <class Number, bool centred>
void read_boxes(const Source& from, bool outwards, WorldBox* out) {
  const bool moved = from.origin != WorldPoint{};
  const auto read =
      moved
          ? (outwards ? read_boxes<Number, centred, true, true> : read_boxes<Number, centred, true, false>)
          : (outwards ? read_boxes<Number, centred, false, true> : read_boxes<Number, centred, false, false>);
  read(from, out);
}

// Whether all boxes are numbers and no less at their maxima, and reach no further than `most` on each axis.
template <class Number, bool centred>
bool are_valid(Source from, const std::array<Number, 3>& most) {
  bool valid = true;
  for (std::size_t i = 0; i < from.count; ++i, from.offset += from.stride) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto a = load<Number>(from.coordinates[axis], from.offset),
                 b = load<Number>(from.coordinates[axis + 3], from.offset);
      const bool ordered = centred ? b >= 0 : a <= b, above = centred || a >= -most[axis],
                 below = (centred ? std::fabs(a) + b : b) <= most[axis];
      valid = valid & ordered & above & below;
    }
  }
  return valid;
}

template <class Number>
bool are_valid(const Source& from, bool centred) {
  // Less than what is allowed by more than rounding can make of it.
  constexpr double kSurely = 0.9 * kWorldReach;
  const auto most = [](double origin) { return static_cast<Number>(kSurely - std::fabs(origin)); };
  const std::array<Number, 3> of{most(from.origin.x), most(from.origin.y), most(from.origin.z)};
  return centred ? are_valid<Number, true>(from, of) : are_valid<Number, false>(from, of);
}

// The numbers as they are.
template <class Number>
void gather(const Source& from, std::array<std::array<Number, kBlock>, 6>& rows) {
  for (std::size_t k = 0; k < 6; ++k) {
    for (std::size_t i = 0; i < from.count; ++i)
      rows[k][i] = load<Number>(from.coordinates[k], from.offset + i * from.stride);
  }
}

}  // namespace

Box geometry::relative_box(const WorldBox& b, const WorldPoint& o) noexcept {
  if (SIGHTLINE_MUTANT(boxes_rounded_to_nearest)) {
    const auto near = [](double x, double from) { return static_cast<float>(x - from); };
    return {{near(b.min.x, o.x), near(b.min.y, o.y), near(b.min.z, o.z)},
            {near(b.max.x, o.x), near(b.max.y, o.y), near(b.max.z, o.z)}};
  }
  return {
      {float_down(sum_down(b.min.x, -o.x)), float_down(sum_down(b.min.y, -o.y)),
       float_down(sum_down(b.min.z, -o.z))},
      {float_up(sum_up(b.max.x, -o.x)), float_up(sum_up(b.max.y, -o.y)), float_up(sum_up(b.max.z, -o.z))}};
}

Box geometry::inner_box(const WorldBox& b, const WorldPoint& o) noexcept {
  return {{float_up(sum_up(b.min.x, -o.x)), float_up(sum_up(b.min.y, -o.y)), float_up(sum_up(b.min.z, -o.z))},
          {float_down(sum_down(b.max.x, -o.x)), float_down(sum_down(b.max.y, -o.y)),
           float_down(sum_down(b.max.z, -o.z))}};
}

bool BoxView::sound() const noexcept {
  if (count_ == 0) return true;
  return sound_stride(count_, stride_, least_stride_) &&
         std::ranges::all_of(coordinates_, [](const void* c) { return c != nullptr; });
}

WorldBox BoxView::operator[](std::size_t i) const noexcept {
  WorldBox box;
  BoxReader::read(*this, i, 1, &box, true);
  return box;
}

BoxView BoxView::part(std::size_t first, std::size_t count) const noexcept {
  BoxView view = *this;
  for (const void*& c : view.coordinates_) c = static_cast<const std::byte*>(c) + first * stride_;
  view.count_ = count;
  return view;
}

bool SphereView::sound() const noexcept {
  if (count_ == 0) return true;
  return sound_stride(count_, stride_, least_stride_) &&
         std::ranges::all_of(coordinates_, [](const float* c) { return c != nullptr; });
}

Sphere SphereView::operator[](std::size_t i) const noexcept {
  const auto value = [&](std::size_t k) { return load<float>(coordinates_[k], i * stride_); };
  return {{value(0), value(1), value(2)}, value(3)};
}

void BoxReader::read(const BoxView& view, std::size_t first, std::size_t count, WorldBox* out,
                     bool outwards) noexcept {
  const Source from{view.coordinates_, first * view.stride_, view.stride_, count, view.origin_};
  const bool centred = view.form_ == BoxView::centre_and_half;
  const auto read = view.doubles_ ? (centred ? read_boxes<double, true> : read_boxes<double, false>)
                                  : (centred ? read_boxes<float, true> : read_boxes<float, false>);
  read(from, outwards, out);
}

bool BoxReader::surely_valid(const BoxView& view, std::size_t first, std::size_t count) noexcept {
  const Source from{view.coordinates_, first * view.stride_, view.stride_, count, view.origin_};
  const bool centred = view.form_ == BoxView::centre_and_half;
  return view.doubles_ ? are_valid<double>(from, centred) : are_valid<float>(from, centred);
}

bool BoxReader::lies_in_arrays(const BoxView& view, const WorldPoint& origin, BoxSpan& out) noexcept {
  if (view.doubles_ || view.form_ != BoxView::corners || view.stride_ != sizeof(float) || view.count_ == 0 ||
      view.origin_ != origin || !std::ranges::all_of(view.coordinates_, aligned<float>))
    return false;
  const auto array = [&](std::size_t k) { return static_cast<const float*>(view.coordinates_[k]); };
  out = {array(0), array(1), array(2), array(3), array(4), array(5), view.count_};
  return true;
}

bool BoxReader::lies_in_arrays(const SphereView& view, SphereSpan& out) noexcept {
  if (view.stride_ != sizeof(float) || view.count_ == 0 ||
      !std::ranges::all_of(view.coordinates_, aligned<float>))
    return false;
  const auto& c = view.coordinates_;
  out = {c[0], c[1], c[2], c[3], view.count_};
  return true;
}

bool BoxReader::lies_as_structs(const BoxView& view, const WorldPoint& origin,
                                std::span<const Box>& out) noexcept {
  const auto* first = static_cast<const std::byte*>(view.coordinates_[0]);
  if (view.doubles_ || view.form_ != BoxView::corners || view.stride_ != sizeof(Box) || view.count_ == 0 ||
      view.origin_ != origin || view.coordinates_[3] != first + offsetof(Box, max) || !aligned<Box>(first))
    return false;
  out = {reinterpret_cast<const Box*>(first), view.count_};
  return true;
}

bool BoxReader::lies_as_structs(const SphereView& view, std::span<const Sphere>& out) noexcept {
  const float* first = view.coordinates_[0];
  if (view.stride_ != sizeof(Sphere) || view.count_ == 0 || view.coordinates_[3] != first + 3 ||
      !aligned<Sphere>(first))
    return false;
  out = {reinterpret_cast<const Sphere*>(first), view.count_};
  return true;
}

BoxSpan BoxReader::lay_out(const BoxView& view, std::size_t first, std::size_t count,
                           const WorldPoint& origin, BoxBlock& out) noexcept {
  const Source from{view.coordinates_, first * view.stride_, view.stride_, count, view.origin_};
  if (are_float_corners(view) && view.origin_ == origin) {
    gather(from, out.values);
    return out.span(count);
  }
  if constexpr (kEveryFormIsQuick) {
    const BlockForm form{view.form_ == BoxView::centre_and_half, view.origin_, origin};
    GivenBlock<float> floats;
    GivenBlock<double> doubles;
    if (view.doubles_) {
      gather(from, doubles.values), geometry::lay_out(doubles, form, count, out);
    } else {
      gather(from, floats.values), geometry::lay_out(floats, form, count, out);
    }
    return out.span(count);
  }
  std::array<WorldBox, kBlock> boxes;
  read(view, first, count, boxes.data(), true);
  for (std::size_t i = 0; i < count; ++i) {
    const Box box = relative_box(boxes[i], origin);
    const std::array<float, 6> values{box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z};
    for (std::size_t k = 0; k < 6; ++k) out.values[k][i] = values[k];
  }
  return out.span(count);
}

SphereSpan BoxReader::lay_out(const SphereView& view, std::size_t first, std::size_t count,
                              SphereBlock& out) noexcept {
  for (std::size_t i = 0; i < count; ++i) {
    const Sphere sphere = view[first + i];
    const std::array<float, 4> values{sphere.centre.x, sphere.centre.y, sphere.centre.z, sphere.radius};
    for (std::size_t k = 0; k < 4; ++k) out.values[k][i] = values[k];
  }
  return out.span(count);
}

}  // namespace sightline
