// Triangles of a method's own, for methods that decide triangle by triangle and draw ranges of an index
// buffer.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include <sightline/workbench/scene.hpp>

namespace sightline {

/// How the ranges that a frame draws are to be submitted.
enum class Submission : std::uint8_t {
  calls,       ///< each range a draw call of its own
  multi_draw,  ///< all ranges by one multi-draw-indirect call
  merged,      ///< ranges that lie side by side made one; each of the rest a call
};

std::string_view to_string(Submission submission) noexcept;

/// World-space triangles, some perhaps several times, counter-clockwise from their front. Triangle t of the
/// arrays has the corners positions[indices[3t]], [3t + 1] and [3t + 2]; triangles share corners only within
/// an object; a draw of
/// Frame::draws has vertex offset 0, one instance, and covers the triangles first_instance … first_instance +
/// index_count / 3.
struct TriangleGeometry {
  std::span<const Vec3> positions;
  std::span<const std::uint32_t> indices;  ///< three a triangle
  std::span<const ObjectId> objects;       ///< one a triangle: whose it is
  /// One a triangle: its number when the scene's objects are counted through in order, each triangle by
  /// triangle.
  std::span<const std::uint32_t> sources;
  std::span<const TextureCoordinate> texture_coordinates;  ///< as many as positions, or none
  Submission submission = Submission::calls;               ///< of the last frame: a method may change its way
  std::uint64_t bytes = 0;                                 ///< memory that the method holds, these included
};

}  // namespace sightline
