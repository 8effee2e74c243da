// A view as shaders read it.
#pragma once

#include <sightline/view.hpp>

#include "workbench/device/shared.h"

namespace sightline::device {

/// `extent` bounds all coordinates, as in make_projector. Contribution is off.
shared::ViewData view_data(const View& view, const Box& extent) noexcept;

/// Whether the near plane lies at depth 1.
bool has_reversed_depth(const View& view) noexcept;

}  // namespace sightline::device
