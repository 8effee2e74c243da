// The peer: Embree's user geometry, one primitive a box, tested with our own slab test.
#pragma once

#include <embree3/rtcore.h>

#include <span>

#include <sightline/rays.hpp>
#include <sightline/workbench/scene.hpp>

#include "library/rays/ray_hits.hpp"

namespace sightline::benchmarks {

class EmbreeBoxes {
public:
  EmbreeBoxes(const Boxes& boxes, RTCSceneFlags flags);
  ~EmbreeBoxes();
  EmbreeBoxes(const EmbreeBoxes&) = delete;
  EmbreeBoxes& operator=(const EmbreeBoxes&) = delete;

  void cast(std::span<const Ray> rays, std::span<const PreparedRay> prepared, rays::RayHits& hits) const;

private:
  const Boxes& boxes_;
  RTCDevice device_;
  RTCScene scene_;
};

}  // namespace sightline::benchmarks
