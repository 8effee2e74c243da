#ifndef __wasm__  // whose vectors have no doubles, and where not every form is quick
#include "library/geometry/box_blocks.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "library/geometry/box_blocks.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include <limits>

#include "library/geometry/mutant.h"

HWY_BEFORE_NAMESPACE();
namespace sightline::geometry::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<float, 16>;
using D = hn::CappedTag<double, 8>;

// --- the twins of rounding.hpp ---

template <class T, class V = hn::Vec<T>>
HWY_INLINE V next_below(T t, V v) {
  const hn::RebindToSigned<T> i;
  const auto bits = hn::BitCast(i, v), one = hn::Set(i, 1);
  const auto positive = hn::RebindMask(i, hn::Gt(v, hn::Zero(t)));
  const auto below = hn::IfThenElse(positive, hn::Sub(bits, one), hn::Add(bits, one));
  const auto below_zero = hn::Set(i, std::numeric_limits<hn::TFromD<decltype(i)>>::min() + 1);
  return hn::BitCast(t, hn::IfThenElse(hn::RebindMask(i, hn::Eq(v, hn::Zero(t))), below_zero, below));
}

template <class T, class V = hn::Vec<T>>
HWY_INLINE V next_above(T t, V v) {
  return hn::Neg(next_below(t, hn::Neg(v)));
}

template <class V>
HWY_INLINE V sum_error(V a, V b, V sum) {
  const V b_part = hn::Sub(sum, a);
  return hn::Add(hn::Sub(a, hn::Sub(sum, b_part)), hn::Sub(b, b_part));
}

template <class T, class V = hn::Vec<T>>
HWY_INLINE V sum_down(T t, V a, V b) {
  const V sum = hn::Add(a, b);
  return hn::IfThenElse(hn::Lt(sum_error(a, b, sum), hn::Zero(t)), next_below(t, sum), sum);
}

template <class T, class V = hn::Vec<T>>
HWY_INLINE V sum_up(T t, V a, V b) {
  const V sum = hn::Add(a, b);
  return hn::IfThenElse(hn::Gt(sum_error(a, b, sum), hn::Zero(t)), next_above(t, sum), sum);
}

// --- blocks ---

// A half size that is none makes no box, rather than one turned inside out.
template <class T, class V = hn::Vec<T>>
HWY_INLINE V half_size(T t, V half) {
  return hn::IfThenElse(hn::Ge(half, hn::Zero(t)), half, hn::NaN(t));
}

void lay_out_floats(const GivenBlock<float>& given, std::size_t count, BoxBlock& out) {
  const F f;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < count; i += hn::Lanes(f)) {
      const auto centre = hn::Load(f, &given.values[axis][i]),
                 half = half_size(f, hn::Load(f, &given.values[axis + 3][i]));
      hn::Store(sum_down(f, centre, hn::Neg(half)), f, &out.values[axis][i]);
      hn::Store(sum_up(f, centre, half), f, &out.values[axis + 3][i]);
    }
  }
}

HWY_INLINE hn::Vec<D> load(const float* from) {
  return hn::PromoteTo(D(), hn::Load(hn::Rebind<float, D>(), from));
}
HWY_INLINE hn::Vec<D> load(const double* from) {
  return hn::Load(D(), from);
}

// The nearest floats that are not above.
HWY_INLINE hn::Vec<hn::Rebind<float, D>> floats_down(hn::Vec<D> x) {
  const hn::Rebind<float, D> f;
  const auto near = hn::DemoteTo(f, x);
  if (SIGHTLINE_MUTANT(boxes_rounded_to_nearest)) return near;
  const auto wide = hn::PromoteTo(D(), near), below = hn::PromoteTo(D(), next_below(f, near));
  return hn::DemoteTo(f, hn::IfThenElse(hn::Gt(wide, x), below, wide));
}

template <class Number>
void lay_out_moved(const GivenBlock<Number>& given, const BlockForm& form, std::size_t count, BoxBlock& out) {
  const D d;
  const hn::Rebind<float, D> f;
  const std::array<double, 3> from{form.from.x, form.from.y, form.from.z},
      to{form.to.x, form.to.y, form.to.z};
  const bool moved = form.from != WorldPoint{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto origin = hn::Set(d, from[axis]), back = hn::Set(d, -to[axis]);
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
      auto low = load(&given.values[axis][i]), high = load(&given.values[axis + 3][i]);
      if (form.centred) {
        const auto centre = low, half = half_size(d, high);
        low = sum_down(d, centre, hn::Neg(half)), high = sum_up(d, centre, half);
      }
      if (moved) low = sum_down(d, origin, low), high = sum_up(d, origin, high);
      hn::Store(floats_down(sum_down(d, low, back)), f, &out.values[axis][i]);
      hn::Store(hn::Neg(floats_down(hn::Neg(sum_up(d, high, back)))), f, &out.values[axis + 3][i]);
    }
  }
}

void lay_out_moved_floats(const GivenBlock<float>& given, const BlockForm& form, std::size_t count,
                          BoxBlock& out) {
  lay_out_moved(given, form, count, out);
}
void lay_out_moved_doubles(const GivenBlock<double>& given, const BlockForm& form, std::size_t count,
                           BoxBlock& out) {
  lay_out_moved(given, form, count, out);
}

}  // namespace sightline::geometry::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::geometry {
HWY_EXPORT(lay_out_floats);
HWY_EXPORT(lay_out_moved_floats);
HWY_EXPORT(lay_out_moved_doubles);

void lay_out(const GivenBlock<float>& given, const BlockForm& form, std::size_t count,
             BoxBlock& out) noexcept {
  if (form.centred && form.from == form.to) return HWY_DYNAMIC_DISPATCH(lay_out_floats)(given, count, out);
  HWY_DYNAMIC_DISPATCH(lay_out_moved_floats)(given, form, count, out);
}

void lay_out(const GivenBlock<double>& given, const BlockForm& form, std::size_t count,
             BoxBlock& out) noexcept {
  HWY_DYNAMIC_DISPATCH(lay_out_moved_doubles)(given, form, count, out);
}

}  // namespace sightline::geometry
#endif
#endif
