#include "embree_boxes.hpp"

#include "embree_rays.hpp"

namespace sightline::benchmarks {

namespace {

void bounds_of(const RTCBoundsFunctionArguments* call) {
  const Box& box = static_cast<const EmbreeBox*>(call->geometryUserPtr)[call->primID].box;
  RTCBounds& b = *call->bounds_o;
  b.lower_x = box.min.x, b.lower_y = box.min.y, b.lower_z = box.min.z;
  b.upper_x = box.max.x, b.upper_y = box.max.y, b.upper_z = box.max.z;
}

}  // namespace

EmbreeBoxes::EmbreeBoxes(const Boxes& boxes, RTCSceneFlags flags, const char* config)
    : device_(rtcNewDevice(config)), scene_(rtcNewScene(device_)) {
  for (std::size_t i = 0; i < boxes.size(); ++i) boxes_.push_back({boxes[i]});
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(boxes.size()));
  rtcSetGeometryUserData(geometry, boxes_.data());
  rtcSetGeometryBoundsFunction(geometry, bounds_of, nullptr);
  rtcSetGeometryIntersectFunction(geometry, embree_callback());
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcSetSceneFlags(scene_, flags);
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
  rtcCommitScene(scene_);
}

EmbreeBoxes::~EmbreeBoxes() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

}  // namespace sightline::benchmarks
