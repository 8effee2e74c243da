// Which triangles cannot face the eye: cones of normals, and the sectors of Zhang as the paper has them.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <sightline/types.hpp>
#include <sightline/view.hpp>

#include "workbench/partition/triangle_split.hpp"

namespace sightline::methods {

/// 8 sectors of 45° of the normal's direction on x–z, those too steep for one, and 8 sectors on x–y.
inline constexpr std::uint32_t kSectors = 8, kSteep = 8, kOnXy = 9, kParts = 17;

/// The planes on which normals are told apart.
enum class PartPlanes : std::uint8_t {
  xz,    ///< as Zhang has it: walls apart
  xy,    ///< floors and ceilings, too; walls that face along z are too steep
  both,  ///< on x–z, and what is too steep there on x–y
};

/// The normal's part: a sector where it is within 45° of the plane, otherwise (and without a normal) kSteep.
std::uint32_t part_of(const Vec3& normal, PartPlanes planes = PartPlanes::xz) noexcept;

/// The triangle's unit normal, counter-clockwise; zero where it has no area.
Vec3 unit_normal(const std::array<Vec3, 3>& triangle) noexcept;

/// The directions that normals take, and where their triangles lie.
struct FacingCone {
  Box bounds;
  Vec3 axis;
  float reach = 2;  ///< sine of the half angle, widened for rounding; 2: may face anywhere
  float thin = 0;  ///< per metre: of the triangle that snapping turns most, its perimeter over twice its area
  std::uint32_t part = kSteep;
};

/// A cone around the normals of triangles of the given region. A triangle without area may face anywhere.
FacingCone cone_of(const partition::TriangleSpan& all, std::span<const std::uint32_t> triangles,
                   const Box& region, PartPlanes planes = PartPlanes::xz) noexcept;

enum class FacingRule : std::uint8_t {
  none,     ///< all may face the eye
  cone,     ///< dropped only where every point of the bounds is seen from behind
  printed,  ///< sectors i − 1, i, i + 1 of the view vector's sector i on the part's plane, as printed:
            ///< loses pixels under perspective
};

/// The rule for one view.
class Facing {
public:
  Facing(const View& view, FacingRule rule) noexcept;

  /// Whether something in the cone may face the eye.
  ///
  /// The paper's rule made safe asks for angle(axis, d) + α + β <= 90°, d and β being axis and half angle of
  /// a cone of the directions from the eye to the bounds. Directions within 90° − α of the axis form a convex
  /// cone, so asking it of the bounds' eight corners asks it of every point, without the detour by d: all
  /// that the sum of angles drops, this drops.
  [[nodiscard]] bool may_face(const FacingCone& cone) const noexcept;

  /// A rasteriser snaps corners to a grid, and so turns small and thin triangles: the sine of the angle by
  /// which, at most, one of the cone that lies so many metres away is turned.
  ///
  /// Corners moved by s pixels change twice a triangle's area of P pixels around by sP + 4s² at most, and it
  /// faces the other way only if twice its area is less; divided by what a triangle seen from its front
  /// would have, P being perimeter and A twice the area in the world and u what s is there: uP/A + 4u²/A, and
  /// P² >= 10.3·A.
  [[nodiscard]] double turned_by(const FacingCone& cone, double distance) const noexcept {
    const double turned = snap_ * (orthographic_ ? 1 : distance) * double{cone.thin};
    return turned + 0.4 * turned * turned;
  }

private:
  FacingRule rule_;
  bool orthographic_;
  double snap_;  ///< metres that snapping moves a corner by at a distance of one
  Vec3 eye_, forward_;
  std::uint32_t on_xz_, on_xy_;  ///< the view vector's sectors, or kSteep
};

}  // namespace sightline::methods
