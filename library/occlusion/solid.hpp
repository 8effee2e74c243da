// What lies inside a closed surface, and whether something touches it: every occluder that is made must pass
// here, whoever proposed it.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <vector>

#include "library/occlusion/mesh_parts.hpp"

namespace sightline::occlusion {

using Corners3 = std::array<glm::dvec3, 3>;

struct Bounds3 {
  glm::dvec3 low{1e300}, high{-1e300};
  void add(const glm::dvec3& p) { low = glm::min(low, p), high = glm::max(high, p); }
};

/// A part of a mesh, stretched along the axes so that the box around it is the unit cube: what lies inside,
/// what is flat and what touches what stays so. In double precision. What is not certain counts as touching,
/// and as outside.
///
/// An open part is closed by a lid. A triangle inside that has all of the lid behind its plane is met from
/// its front by no line of sight through the lid, so that each has passed the mesh.
class Solid {
public:
  /// The mesh may go afterwards. Nothing lies inside a part that is thin.
  Solid(const MeshParts& mesh, const MeshPart& part);

  /// The part is flat along an axis, or so far from the origin that floats cannot tell its sides apart, or
  /// more hole than surface.
  [[nodiscard]] bool thin() const noexcept { return thin_; }
  [[nodiscard]] bool has_lid() const noexcept { return !lid_.empty(); }
  [[nodiscard]] glm::dvec3 to_solid(const glm::dvec3& p) const noexcept { return (p - low_) / extent_; }
  [[nodiscard]] glm::dvec3 to_mesh(const glm::dvec3& p) const noexcept { return low_ + p * extent_; }

  /// Whether the surface comes within a margin, some 5e-5 of the cube, of the triangle or of the box.
  [[nodiscard]] bool touches(const Corners3& triangle) const;
  [[nodiscard]] bool touches(const Bounds3& box) const;
  /// Whether a point lies inside.
  [[nodiscard]] bool holds(const glm::dvec3& point) const;
  /// What does not touch the surface lies inside as a whole if one point of it does. Where there is a lid, a
  /// triangle must have it behind: it may occlude from its front alone.
  [[nodiscard]] bool holds(const Corners3& triangle) const;
  [[nodiscard]] bool holds(const Bounds3& box) const;

  /// Where a line along an axis through a point meets the surface, in order.
  struct Crossing {
    double at;
    int turn;  ///< 1 where it leaves, -1 where it enters
  };
  /// False where the line passes an edge too closely to tell.
  bool crossings(const glm::dvec3& point, int axis, std::vector<Crossing>& out) const;
  /// Whether a place with such a count of turns and crossings before it, or behind it, is inside.
  [[nodiscard]] bool inside_by(int turns, std::size_t crossed) const noexcept;
  /// From a point to the surface; `most` where it is farther.
  [[nodiscard]] double distance(const glm::dvec3& point, double most) const;
  /// The corners of the mesh's triangles.
  [[nodiscard]] const std::vector<glm::dvec3>& points() const noexcept { return points_; }
  /// From a point to the nearest corner of the lid.
  [[nodiscard]] double distance_to_lid(const glm::dvec3& point) const;

private:
  struct Node {
    Bounds3 box;
    std::uint32_t first, count;  ///< triangles of a leaf; of others count is 0 and `first` the second child
  };
  void add_lid(const MeshParts& mesh, const MeshPart& part, std::vector<Corners3>& corners);
  void build(std::vector<std::uint32_t>& order, std::size_t first, std::size_t end,
             const std::vector<Corners3>& corners);
  /// Visits the triangles of all leaves whose boxes, and those of all above, pass; stops where `at` says so.
  template <class Passes, class At>
  bool any(Passes passes, At at) const;

  std::vector<Node> nodes_;
  std::vector<Corners3> triangles_;
  std::vector<glm::dvec3> points_, lid_;
  glm::dvec3 low_{0}, extent_{1};
  double margin_ = 0;
  Inside rule_;
  bool thin_ = false;
};

}  // namespace sightline::occlusion
