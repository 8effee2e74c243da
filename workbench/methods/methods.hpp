// What each method file gives to the registry.
#pragma once

#include <sightline/workbench/method.hpp>

namespace sightline::methods {

extern const MethodInfo kNone;
extern const MethodInfo kVfcVc;
extern const MethodInfo kMasked;
extern const MethodInfo kGridCell;
extern const MethodInfo kObjectFrustum;
extern const MethodInfo kLevelPvs;
extern const MethodInfo kToca;
extern const MethodInfo kBoca;
extern const MethodInfo kWideRays;
extern const MethodInfo kTrianglePvs;
extern const MethodInfo kGuided;
extern const MethodInfo kBaked;

inline bool fits_any_scene(const Scene&) {
  return true;
}

/// A factory for a method whose constructor takes the scene and its parameters.
template <class M>
Result<std::unique_ptr<Method>> make(const Scene& scene, const Parameters& parameters) {
  return std::unique_ptr<Method>(std::make_unique<M>(scene, parameters));
}

}  // namespace sightline::methods
