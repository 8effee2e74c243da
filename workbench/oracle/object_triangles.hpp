// One object's triangles in world space, met by rays in double precision.
#pragma once

#include <glm/glm.hpp>

#include <optional>
#include <vector>

#include <sightline/workbench/scene.hpp>

#include "workbench/oracle/pixel_rays.hpp"

namespace sightline::oracle {

enum class Faces : std::uint8_t {
  both,   ///< triangles are seen from both sides
  front,  ///< only where their vertices run counter-clockwise, as with back-face culling
};

class ObjectTriangles {
public:
  ObjectTriangles(const Scene& scene, ObjectId object);

  /// Distance to the nearest triangle the ray meets within its length; nothing for a miss.
  [[nodiscard]] std::optional<double> meet(const PixelRay& ray, Faces faces) const;

private:
  std::vector<glm::dvec3> corners_;  ///< three a triangle
  glm::dvec3 centre_;                ///< of a sphere around them, which most rays miss
  double radius_ = 0;
};

}  // namespace sightline::oracle
