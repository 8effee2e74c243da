// A view as shaders read it.
#pragma once

#include <optional>

#include <sightline/view.hpp>

#include "workbench/device/shared.h"

namespace sightline::device {

/// `extent` bounds all coordinates, as in make_projector. Contribution is off.
shared::ViewData view_data(const View& view, const Box& extent) noexcept;

/// Whether the near plane lies at depth 1.
bool has_reversed_depth(const View& view) noexcept;
/// The same perspective with depth that falls from 1 at the near plane to 0 at no end, where floats lie
/// dense: it tells surfaces apart that standard depth rounds to one, 6 m a kilometre away where the near
/// plane is at 1 cm. Nothing of a view that has reversed depth, whose depth is even, or depends on more than
/// the distance.
std::optional<View> with_denser_depth(const View& view) noexcept;

}  // namespace sightline::device
