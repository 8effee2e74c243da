#include "embree_boxes.hpp"

namespace sightline::benchmarks {

namespace {

struct Context {
  RTCIntersectContext embree;  // first, so that a callback may cast back
  const PreparedRay* ray;
};

void bounds_of(const RTCBoundsFunctionArguments* call) {
  const Box box = (*static_cast<const Boxes*>(call->geometryUserPtr))[call->primID];
  RTCBounds& b = *call->bounds_o;
  b.lower_x = box.min.x, b.lower_y = box.min.y, b.lower_z = box.min.z;
  b.upper_x = box.max.x, b.upper_y = box.max.y, b.upper_z = box.max.z;
}

void meet(const RTCIntersectFunctionNArguments* call) {
  if (call->valid[0] == 0) return;
  const Box box = (*static_cast<const Boxes*>(call->geometryUserPtr))[call->primID];
  const float t = intersect(*reinterpret_cast<const Context*>(call->context)->ray, box);
  auto& hit = *reinterpret_cast<RTCRayHit*>(call->rayhit);
  if (t < 0 || t > hit.ray.tfar) return;
  if (t == hit.ray.tfar && hit.hit.primID < call->primID) return;
  hit.ray.tfar = t;
  hit.hit.primID = call->primID;
  hit.hit.geomID = 0;
}

}  // namespace

EmbreeBoxes::EmbreeBoxes(const Boxes& boxes, RTCSceneFlags flags)
    : boxes_(boxes), device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_)) {
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(boxes.size()));
  rtcSetGeometryUserData(geometry, const_cast<Boxes*>(&boxes));
  rtcSetGeometryBoundsFunction(geometry, bounds_of, nullptr);
  rtcSetGeometryIntersectFunction(geometry, meet);
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

void EmbreeBoxes::cast(std::span<const Ray> rays, std::span<const PreparedRay> prepared,
                       rays::RayHits& hits) const {
  hits.reset(rays.size());
  Context context;
  rtcInitIntersectContext(&context.embree);
  context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  for (std::size_t r = 0; r < rays.size(); ++r) {
    RTCRayHit one{};
    const Ray& ray = rays[r];
    one.ray = {ray.origin.x,
               ray.origin.y,
               ray.origin.z,
               0,
               ray.direction.x,
               ray.direction.y,
               ray.direction.z,
               0,
               ray.max_distance,
               ~0u,
               0,
               0};
    one.hit.geomID = one.hit.primID = one.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    context.ray = &prepared[r];
    rtcIntersect1(scene_, &context.embree, &one);
    if (one.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
    hits.object[r] = one.hit.primID;
    hits.distance[r] = one.ray.tfar;
    ++hits.stats.hits;
  }
}

}  // namespace sightline::benchmarks
