// The peer: Embree's user geometry, one primitive a box, tested with our own slab test.
#pragma once

#include <embree3/rtcore.h>

#include <span>
#include <vector>

#include <sightline/rays.hpp>
#include <sightline/workbench/scene.hpp>

#include "library/rays/ray_hits.hpp"

namespace sightline::benchmarks {

/// A box as Embree's callbacks find it: in one line of memory.
struct alignas(32) EmbreeBox {
  Box box;
};

class EmbreeBoxes {
public:
  /// `config` as rtcNewDevice takes it.
  EmbreeBoxes(const Boxes& boxes, RTCSceneFlags flags, const char* config = "threads=1");
  ~EmbreeBoxes();
  EmbreeBoxes(const EmbreeBoxes&) = delete;
  EmbreeBoxes& operator=(const EmbreeBoxes&) = delete;

  [[nodiscard]] RTCScene scene() const { return scene_; }

private:
  std::vector<EmbreeBox> boxes_;
  RTCDevice device_;
  RTCScene scene_;
};

}  // namespace sightline::benchmarks
