// One object's triangles in world space, met by rays in double precision.
#pragma once

#include <glm/glm.hpp>

#include <optional>
#include <vector>

#include <sightline/workbench/scene.hpp>

#include "workbench/oracle/pixel_rays.hpp"

namespace sightline::oracle {

class ObjectTriangles {
public:
  ObjectTriangles(const Scene& scene, ObjectId object);

  /// Distance to the nearest triangle whose drawn side the ray meets within its length; nothing for a miss.
  [[nodiscard]] std::optional<double> meet(const PixelRay& ray) const;

private:
  std::vector<glm::dvec3> corners_;  ///< three a triangle, counter-clockwise from its front
  Sides sides_;
  glm::dvec3 centre_;  ///< of a sphere around them, which most rays miss
  double radius_ = 0;
};

}  // namespace sightline::oracle
