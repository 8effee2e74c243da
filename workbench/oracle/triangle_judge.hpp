// The judge of methods that draw triangles instead of objects: the image, pixel by pixel, down to the
// triangle.
#pragma once

#include <memory>
#include <optional>

#include <sightline/workbench/frame.hpp>
#include <sightline/workbench/triangle_draws.hpp>

#include "workbench/oracle/embree_judge.hpp"
#include "workbench/oracle/loss.hpp"

namespace sightline::oracle {

/// The scene with each triangle an object of its own, in world space, in the order of
/// TriangleGeometry::sources.
Scene one_object_a_triangle(const Scene& scene);

/// Rays through pixel centres against all triangles. Built when first asked; one view's truth is kept.
class TriangleJudge {
public:
  /// The scene outlives the judge and does not move.
  explicit TriangleJudge(const Scene& scene) : scene_(scene) {}

  struct Verdict {
    Loss loss;                      ///< objects that lost a pixel; pixels whose triangle was not submitted
    std::size_t truly_visible = 0;  ///< objects with a pixel
  };
  /// Throws Error where a draw is no range of the geometry.
  Verdict judge(const View& view, const TriangleGeometry& geometry, const Frame& frame);

private:
  struct Truth {
    Scene triangles;
    std::optional<EmbreeJudge> judge;
    std::optional<View> view;
    ItemBuffer image;
  };

  Truth& truth(const View& view);

  const Scene& scene_;
  std::vector<ObjectId> owners_;
  std::unique_ptr<Truth> truth_;
  std::vector<std::uint8_t> submitted_;
};

}  // namespace sightline::oracle
