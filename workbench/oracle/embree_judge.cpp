#include "workbench/oracle/embree_judge.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/held_scene.hpp>

#include "workbench/oracle/embree_layer.hpp"
#include "workbench/oracle/object_triangles.hpp"
#include "workbench/oracle/pixel_rays.hpp"

namespace sightline::oracle {
namespace {

constexpr std::uint32_t kTile = 4;  ///< a packet is 4 × 4 neighbouring pixels
constexpr unsigned kPacket = kTile * kTile;

/// What the filter needs to know, behind Embree's own context.
struct LayerContext {
  RTCIntersectContext embree;  ///< first, so that a filter may cast back
  const EmbreeLayer* layer = nullptr;
  std::vector<ObjectId>* through = nullptr;  ///< set: every object passed is noted and the ray goes on
};

// Refuses sides that are not drawn, and in a pass through what hides nothing notes each object met and lets
// the ray go on.
void filter(const RTCFilterFunctionNArguments* call) {
  auto* context = reinterpret_cast<LayerContext*>(call->context);
  const EmbreeLayer& layer = *context->layer;
  for (unsigned i = 0; i < call->N; ++i) {
    if (call->valid[i] != -1) continue;
    const unsigned instance = RTCHitN_instID(call->hit, call->N, i, 0);
    const ObjectId object = layer.object_of(instance, RTCHitN_primID(call->hit, call->N, i));
    const float along = RTCHitN_Ng_x(call->hit, call->N, i) * RTCRayN_dir_x(call->ray, call->N, i) +
                        RTCHitN_Ng_y(call->hit, call->N, i) * RTCRayN_dir_y(call->ray, call->N, i) +
                        RTCHitN_Ng_z(call->hit, call->N, i) * RTCRayN_dir_z(call->ray, call->N, i);
    if (!layer.is_drawn(object, instance, along)) {
      call->valid[i] = 0;
    } else if (context->through != nullptr) {
      context->through->push_back(object);
      call->valid[i] = 0;
    }
  }
}

struct Packet {
  alignas(64) RTCRayHit16 rays;
  alignas(64) std::array<int, kPacket> valid;
};

void set_ray(Packet& packet, unsigned i, const PixelRay& ray) {
  RTCRay16& r = packet.rays.ray;
  r.org_x[i] = static_cast<float>(ray.origin.x), r.dir_x[i] = static_cast<float>(ray.direction.x);
  r.org_y[i] = static_cast<float>(ray.origin.y), r.dir_y[i] = static_cast<float>(ray.direction.y);
  r.org_z[i] = static_cast<float>(ray.origin.z), r.dir_z[i] = static_cast<float>(ray.direction.z);
  r.tnear[i] = 0, r.time[i] = 0;
  r.tfar[i] = static_cast<float>(ray.length);
  r.mask[i] = ~0u, r.id[i] = i, r.flags[i] = 0;
  packet.rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
  packet.rays.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  packet.valid[i] = -1;
}

RTCRayHit extract_ray(const Packet& packet, unsigned i) {
  const RTCRay16& r = packet.rays.ray;
  RTCRayHit one{};
  one.ray = {r.org_x[i], r.org_y[i], r.org_z[i], 0,   r.dir_x[i], r.dir_y[i],
             r.dir_z[i], 0,          r.tfar[i],  ~0u, i,          0};
  one.hit.geomID = one.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return one;
}

}  // namespace

struct EmbreeJudge::State {
  explicit State(const Scene& shown);
  ~State();
  void trace_tile(const PixelRays& rays, std::uint32_t x, std::uint32_t y, ItemBuffer& out,
                  std::vector<std::uint32_t>& see_through_pixels, std::vector<ObjectId>& passed) const;

  const Scene& scene;
  HeldScene held;
  RTCDevice device = nullptr;
  std::vector<RTCScene> mesh_scenes;
  std::unique_ptr<EmbreeLayer> opaque, see_through;  ///< what hides nothing: cut-outs, glass
};

EmbreeJudge::State::State(const Scene& shown) : scene(shown), held(shown, "oracle of rays") {
  device = rtcNewDevice(nullptr);
  if (device == nullptr) throw Error("item buffer: Embree could not be started on this machine");
  mesh_scenes = build_mesh_scenes(device, scene);
  std::vector<ObjectId> opaque_objects, see_through_objects;
  for (ObjectId object = 0; object < scene.size(); ++object) {
    (scene.surface[object] == Surface::opaque ? opaque_objects : see_through_objects).push_back(object);
  }
  opaque = std::make_unique<EmbreeLayer>(device, scene, opaque_objects, mesh_scenes);
  see_through = std::make_unique<EmbreeLayer>(device, scene, see_through_objects, mesh_scenes);
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE) {
    throw Error(
        "item buffer: Embree could not build its acceleration structure, most likely for want of memory");
  }
}

EmbreeJudge::State::~State() {
  opaque.reset();
  see_through.reset();
  for (RTCScene mesh_scene : mesh_scenes) {
    if (mesh_scene != nullptr) rtcReleaseScene(mesh_scene);
  }
  rtcReleaseDevice(device);
}

EmbreeJudge::EmbreeJudge(const Scene& scene) {
  check(scene);
  state_ = std::make_unique<State>(scene);
}

EmbreeJudge::~EmbreeJudge() = default;

void EmbreeJudge::State::trace_tile(const PixelRays& rays, std::uint32_t x, std::uint32_t y, ItemBuffer& out,
                                    std::vector<std::uint32_t>& see_through_pixels,
                                    std::vector<ObjectId>& passed) const {
  Packet packet{};  // Embree looks at lanes without a ray, too
  for (unsigned i = 0; i < kPacket; ++i) {
    const std::uint32_t px = x + i % kTile, py = y + i / kTile;
    if (px < out.width && py < out.height) set_ray(packet, i, rays.through(px, py));
  }
  LayerContext context;
  rtcInitIntersectContext(&context.embree);
  context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  context.layer = opaque.get();
  if (opaque->has_sides()) context.embree.filter = filter;
  if (!opaque->empty()) rtcIntersect16(packet.valid.data(), opaque->handle(), &context.embree, &packet.rays);
  context.layer = see_through.get();
  context.embree.filter = filter;
  context.through = &passed;
  for (unsigned i = 0; i < kPacket; ++i) {
    if (packet.valid[i] == 0) continue;
    const RTCHit16& hit = packet.rays.hit;
    if (hit.geomID[i] != RTC_INVALID_GEOMETRY_ID) {
      const std::size_t pixel = std::size_t{y + i / kTile} * out.width + x + i % kTile;
      out.ids[pixel] = opaque->object_of(hit.instID[0][i], hit.primID[i]);
      out.distances[pixel] = packet.rays.ray.tfar[i];
    }
    if (see_through->empty()) continue;
    RTCRayHit one = extract_ray(packet, i);
    passed.clear();
    rtcIntersect1(see_through->handle(), &context.embree, &one);
    std::sort(passed.begin(), passed.end());
    passed.erase(std::unique(passed.begin(), passed.end()), passed.end());
    for (const ObjectId object : passed) ++see_through_pixels[object];
  }
}

ItemBuffer EmbreeJudge::render(const View& view, std::uint32_t sample) const {
  or_throw(check(view));
  state_->held.require_same();
  ItemBuffer out;
  out.width = view.width, out.height = view.height, out.sample = sample;
  out.ids.assign(std::size_t{view.width} * view.height, kNoObject);
  out.distances.assign(out.ids.size(), std::numeric_limits<float>::infinity());
  out.pixels.assign(state_->scene.size(), 0);
  const PixelRays rays(view, sample);
  const bool counts = !state_->see_through->empty();
  struct Worker {
    std::vector<std::uint32_t> pixels;
    std::vector<ObjectId> passed;
  };
  tbb::enumerable_thread_specific<Worker> workers([&] {
    return Worker{std::vector<std::uint32_t>(counts ? out.pixels.size() : 0), {}};
  });
  const std::uint32_t bands = (view.height + kTile - 1) / kTile;
  tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, bands), [&](const auto& range) {
    Worker& worker = workers.local();
    for (std::uint32_t band = range.begin(); band != range.end(); ++band) {
      for (std::uint32_t x = 0; x < view.width; x += kTile) {
        state_->trace_tile(rays, x, band * kTile, out, worker.pixels, worker.passed);
      }
    }
  });
  for (const ObjectId object : out.ids) {
    if (object != kNoObject) ++out.pixels[object];
  }
  for (const Worker& worker : workers) {
    for (std::size_t o = 0; o < worker.pixels.size(); ++o) out.pixels[o] += worker.pixels[o];
  }
  return out;
}

void EmbreeJudge::move(std::span<const ObjectId> objects) {
  state_->held.require_sound(objects);
  state_->opaque->move(objects);
  state_->see_through->move(objects);
}

std::vector<std::uint32_t> EmbreeJudge::confirmed_pixels(const View& view, const ItemBuffer& truth,
                                                         std::span<const ObjectId> objects) const {
  const Scene& scene = state_->scene;
  std::vector<std::uint32_t> confirmed(objects.size(), 0);
  if (objects.empty()) return confirmed;
  std::vector<ObjectTriangles> triangles;
  std::vector<std::size_t> place(scene.size(), objects.size()), see_through_places;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    triangles.emplace_back(scene, objects[i]);
    place[objects[i]] = i;
    if (scene.surface[objects[i]] != Surface::opaque) see_through_places.push_back(i);
  }
  const PixelRays rays(view, truth.sample);
  const auto add = [&](std::size_t i, const PixelRay& ray) {
    confirmed[i] += triangles[i].meet(ray).has_value();
  };
  for (std::uint32_t y = 0; y < truth.height; ++y) {
    for (std::uint32_t x = 0; x < truth.width; ++x) {
      const ObjectId nearest = truth.ids[std::size_t{y} * truth.width + x];
      const bool asked = nearest != kNoObject && place[nearest] < objects.size();
      if (!asked && see_through_places.empty()) continue;
      const PixelRay ray = rays.through(x, y);
      if (asked) add(place[nearest], ray);
      for (const std::size_t i : see_through_places) add(i, ray);
    }
  }
  // The own rays of what hides nothing may meet it behind something opaque, too.
  for (const std::size_t i : see_through_places)
    confirmed[i] = std::min(confirmed[i], truth.pixels[objects[i]]);
  return confirmed;
}

}  // namespace sightline::oracle
