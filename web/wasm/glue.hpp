// What the module's two parts share: how JavaScript's flat arguments become the library's. All stands on
// public headers. Pointers are the module's own; web/src checks lengths before a call, the library all else.
#pragma once

#include <cstddef>
#include <cstdint>

#include <sightline/box_view.hpp>
#include <sightline/status.hpp>
#include <sightline/view.hpp>

#define SIGHTLINE_WEB(name) __attribute__((export_name(#name), visibility("default")))

namespace sightline::web {

/// How boxes lie in an array, as web/src/boxes.ts numbers it.
enum class Layout : std::uint32_t { min_max_f32, min_max_f64, centre_half_f32, centre_half_f64, columns_f32 };

/// Boxes as JavaScript gives them: six numbers each from `first` on, or six columns of `count` numbers.
inline BoxView boxes_of(Layout layout, const void* first, std::size_t stride, std::size_t count,
                        const WorldPoint& origin) noexcept {
  const auto* f32 = static_cast<const float*>(first);
  const auto* f64 = static_cast<const double*>(first);
  switch (layout) {
    case Layout::min_max_f32:
      return BoxView::min_max(f32, stride, count, origin);
    case Layout::min_max_f64:
      return BoxView::min_max(f64, stride, count);
    case Layout::centre_half_f32:
      return BoxView::centre_half(f32, f32 + 3, stride, count, origin);
    case Layout::centre_half_f64:
      return BoxView::centre_half(f64, f64 + 3, stride, count);
    case Layout::columns_f32:
      break;
  }
  return BoxView::arrays(f32, f32 + count, f32 + 2 * count, f32 + 3 * count, f32 + 4 * count, f32 + 5 * count,
                         count, origin);
}

/// Keeps a refusal for message() and refused_index(), and returns its code either way.
std::uint32_t keep(const Status& status) noexcept;

}  // namespace sightline::web
