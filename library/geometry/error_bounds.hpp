// What rounding can do, wherever a result is called sure.
#pragma once

#include <cmath>

namespace sightline::geometry {

// planes
inline constexpr double kPlaneRounding = 0x1p-21;
inline constexpr double kPlaneAtInfinity = 1e-12;
// projector
inline constexpr double kProjectionRounding = 0x3p-22;
inline constexpr float kSubpixelSlack = 1.0f / 128;
inline constexpr float kAreaGrowth = 1e-5f;
inline constexpr float kScaleRounding = 1e-5f;

// occluders, drawn
inline constexpr float kInset = 1.0f / 256, kInsetGrowth = 2e-6f;
inline constexpr float kLeastDrawnArea = 0.02f, kLeastClippedArea = 0.5f;
inline constexpr float kFlatEdge = 1e-3f;
inline constexpr float kNearnessRounding = 2e-5f;
inline constexpr float kPixelPlay = 1.0f / 64;
inline constexpr float kDrawnNormalRounding = 4.2e-7f;
inline constexpr float kQuadRounding = 5e-7f;
inline constexpr float kTileRounding = 1e-6f;
inline constexpr double kEdgeOnSine = 1e-4, kEdgeOnPart = 1e-5, kEdgeOnDistance = 1e-6;
inline constexpr float kFacePart = 1e-5f, kFaceDistance = 1e-6f, kFaceSine = 1e-5f;
inline constexpr double kNearPlanePart = 1e-5, kNearPlaneReach = 1e-3, kNearPlaneDepth = 1e-6;
inline constexpr double kGroupGrowth = 1e-6;
inline constexpr double kMostShear = 1e-5, kDiscShrink = 2e-5;
inline constexpr float kDiscRounding = 1e-6f;
inline constexpr float kSphereClearance = 1e-4f, kSphereReach = 1e-6f;

// queries
inline constexpr float kRowRounding = 0x1p-20f;
inline constexpr float kReciprocalRounding = 1e-6f;
inline constexpr float kSphereGrowth = 1e-6f;
inline constexpr float kLeastClearance = 1e-2f;
inline constexpr float kSphereSlack = 1.0f / 64, kSphereSlackGrowth = 2e-5f;
inline constexpr float kAskedFlatEdge = 1.0f / 64;
inline constexpr float kAskedNormalRounding = 4e-7f, kMostDoubt = 1e4f;
inline constexpr float kMostNearness = 1e30f, kFarthestPlace = 30000;
inline constexpr double kKeptBeforeNear = 1e-3, kKeptReach = 1e-6;

inline double near_plane_slack(double at_eye, double eye) noexcept {
  return kNearPlanePart * (std::fabs(at_eye) + kNearPlaneReach * eye + kNearPlaneReach);
}

}  // namespace sightline::geometry
