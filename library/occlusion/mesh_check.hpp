// Whether a mesh can be worked with.
#pragma once

#include <cstdint>
#include <span>

#include <sightline/occluder.hpp>

namespace sightline::occlusion {

/// Whether it is one of them: who casts a byte may bring any.
inline bool is_known(Sides sides) noexcept {
  return sides == Sides::both || sides == Sides::front;
}

/// As OccluderMesh::make says.
Status check_mesh(std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
                  std::span<const Sides> sides) noexcept;

}  // namespace sightline::occlusion
