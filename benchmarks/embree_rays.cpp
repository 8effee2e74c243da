#include "embree_rays.hpp"

#include <algorithm>
#include <cstring>
#include <memory>
#include <vector>

#ifndef SIGHTLINE_BENCHMARKS_EMBREE_CONTEXT
#define SIGHTLINE_BENCHMARKS_EMBREE_CONTEXT
namespace sightline::benchmarks {

// What a call hands through to the callback.
struct EmbreeContext {
  RTCIntersectContext embree;   // first, so that the callback may cast back
  const PreparedRay* prepared;  // by ray id
  bool bears_inverse;  // packets have 1 / direction in their hits' normals, which Embree never touches
};

}  // namespace sightline::benchmarks
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "../benchmarks/embree_rays.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sightline::benchmarks::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Rows of an RTCRayHitN, N values each.
enum Row : std::size_t { kOrigin, kDirection = 4, kFar = 8, kNormal = 12, kBox = 17, kGeometry = 18 };

// intersect() of a box with kRays rays.
template <std::size_t kRays>
void meet_packet(const RTCIntersectFunctionNArguments* call) {
  const hn::CappedTag<float, kRays> f;
  const hn::RebindToUnsigned<decltype(f)> u;
  using V = hn::Vec<decltype(f)>;
  const Box& box = static_cast<const EmbreeBox*>(call->geometryUserPtr)[call->primID].box;
  const bool bears_inverse = reinterpret_cast<const EmbreeContext*>(call->context)->bears_inverse;
  auto* floats = reinterpret_cast<float*>(call->rayhit);
  auto* words = reinterpret_cast<unsigned*>(call->rayhit);
  for (std::size_t part = 0; part < kRays; part += hn::Lanes(f)) {
    const auto row = [&](std::size_t number) { return number * kRays + part; };
    const V best = hn::LoadU(f, floats + row(kFar));
    V entry = hn::Zero(f), exit = best;
    const auto clip = [&](std::size_t axis, float low, float high) HWY_ATTR {
      const V origin = hn::LoadU(f, floats + row(kOrigin + axis));
      const V inverse = bears_inverse ? hn::LoadU(f, floats + row(kNormal + axis))
                                      : hn::Div(hn::Set(f, 1), hn::LoadU(f, floats + row(kDirection + axis)));
      const V a = hn::Mul(hn::Sub(hn::Set(f, low), origin), inverse),
              b = hn::Mul(hn::Sub(hn::Set(f, high), origin), inverse);
      entry = hn::Max(hn::Min(a, b), entry);
      exit = hn::Min(hn::Max(a, b), exit);
    };
    clip(0, box.min.x, box.max.x);
    clip(1, box.min.y, box.max.y);
    clip(2, box.min.z, box.max.z);
    const auto had = hn::LoadU(u, words + row(kBox)), mine = hn::Set(u, call->primID);
    const auto valid = hn::LoadU(u, reinterpret_cast<const unsigned*>(call->valid) + part);
    const auto going = hn::RebindMask(f, hn::Ne(valid, hn::Zero(u)));
    const auto nearer = hn::Or(hn::Lt(entry, best), hn::RebindMask(f, hn::Lt(mine, had)));
    const auto hit = hn::And(hn::And(going, hn::Le(entry, exit)), nearer);
    const auto wrote = hn::RebindMask(u, hit);
    hn::StoreU(hn::IfThenElse(hit, entry, best), f, floats + row(kFar));
    hn::StoreU(hn::IfThenElse(wrote, mine, had), u, words + row(kBox));
    hn::StoreU(hn::IfThenZeroElse(wrote, hn::LoadU(u, words + row(kGeometry))), u, words + row(kGeometry));
  }
}

void meet_1(const RTCIntersectFunctionNArguments* call) {
  const Box& box = static_cast<const EmbreeBox*>(call->geometryUserPtr)[call->primID].box;
  auto& hit = *reinterpret_cast<RTCRayHit*>(call->rayhit);
  const float t = intersect(reinterpret_cast<const EmbreeContext*>(call->context)->prepared[hit.ray.id], box);
  if (t < 0 || t > hit.ray.tfar) return;
  if (t == hit.ray.tfar && hit.hit.primID < call->primID) return;
  hit.ray.tfar = t;
  hit.hit.primID = call->primID;
  hit.hit.geomID = 0;
}

void meet_box(const RTCIntersectFunctionNArguments* call) {
  switch (call->N) {
    case 1:
      return meet_1(call);
    case 4:
      return meet_packet<4>(call);
    case 8:
      return meet_packet<8>(call);
    default:
      return meet_packet<16>(call);
  }
}

}  // namespace sightline::benchmarks::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::benchmarks {

HWY_EXPORT(meet_box);

namespace {

// What a form keeps ready: packets of kRays rays in the order of the input, the last one filled up with rays
// that are over before they begin.
template <std::size_t kRays>
struct Packets {
  struct alignas(kRays == 1 ? 16 : 64) Packet {
    // As an RTCRayHitN has them.
    float origin[3][kRays], near[kRays], direction[3][kRays], time[kRays], far[kRays];
    unsigned mask[kRays], id[kRays], flags[kRays];
    float normal[3][kRays], u[kRays], v[kRays];
    unsigned box[kRays], geometry[kRays], instance[kRays];
  };

  EmbreeInput input;
  std::vector<Packet> packets;
  std::vector<float> far;  // by place in the order
  alignas(64) int valid[16];

  explicit Packets(const EmbreeInput& of) : input(of) {
    std::fill(std::begin(valid), std::end(valid), -1);
    const std::size_t count = (input.order.size() + kRays - 1) / kRays;
    packets.resize(count);
    far.resize(count * kRays, -1.0f);
    std::memset(static_cast<void*>(packets.data()), 0, count * sizeof(Packet));
    for (std::size_t i = 0; i < input.order.size(); ++i) {
      Packet& p = packets[i / kRays];
      const std::size_t lane = i % kRays, r = input.order[i];
      const Ray& ray = input.rays[r];
      const Vec3& inverse = input.prepared[r].inverse;
      p.origin[0][lane] = ray.origin.x, p.origin[1][lane] = ray.origin.y, p.origin[2][lane] = ray.origin.z;
      p.direction[0][lane] = ray.direction.x, p.direction[1][lane] = ray.direction.y;
      p.direction[2][lane] = ray.direction.z;
      p.normal[0][lane] = inverse.x, p.normal[1][lane] = inverse.y, p.normal[2][lane] = inverse.z;
      p.mask[lane] = ~0u, p.id[lane] = static_cast<unsigned>(r), p.instance[lane] = RTC_INVALID_GEOMETRY_ID;
      far[i] = ray.max_distance;
    }
  }

  // Undoes what the last cast wrote.
  void reset(std::size_t index) {
    Packet& p = packets[index];
    std::memcpy(p.far, far.data() + index * kRays, sizeof p.far);
    std::fill(std::begin(p.geometry), std::end(p.geometry), RTC_INVALID_GEOMETRY_ID);
    std::fill(std::begin(p.box), std::end(p.box), RTC_INVALID_GEOMETRY_ID);
  }

  void collect(std::size_t index, rays::RayHits& hits) const {
    const Packet& p = packets[index];
    const std::size_t first = index * kRays, count = std::min(kRays, input.order.size() - first);
    for (std::size_t lane = 0; lane < count; ++lane) {
      const bool hit = p.geometry[lane] != RTC_INVALID_GEOMETRY_ID;
      hits.object[p.id[lane]] = p.box[lane];
      hits.distance[p.id[lane]] = hit ? p.far[lane] : -1;
      hits.stats.hits += hit;
    }
  }
};

EmbreeContext context_of(const EmbreeInput& input, bool bears_inverse) {
  EmbreeContext context{{}, input.prepared.data(), bears_inverse};
  rtcInitIntersectContext(&context.embree);
  if (input.coherent) context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  return context;
}

void begin(const EmbreeInput& input, rays::RayHits& hits) {
  hits.object.resize(input.rays.size()), hits.distance.resize(input.rays.size());
  hits.stats = {};
  hits.stats.rays = input.rays.size();
}

template <std::size_t kRays>
EmbreeCast in_packets(const EmbreeInput& input) {
  return [packets = std::make_shared<Packets<kRays>>(input)](const EmbreeBoxes& boxes, rays::RayHits& hits) {
    EmbreeContext context = context_of(packets->input, kRays > 1);
    begin(packets->input, hits);
    for (std::size_t i = 0; i < packets->packets.size(); ++i) {
      packets->reset(i);
      void* packet = &packets->packets[i];
      RTCIntersectContext* with = &context.embree;
      if constexpr (kRays == 1) rtcIntersect1(boxes.scene(), with, static_cast<RTCRayHit*>(packet));
      if constexpr (kRays == 4)
        rtcIntersect4(packets->valid, boxes.scene(), with, static_cast<RTCRayHit4*>(packet));
      if constexpr (kRays == 8)
        rtcIntersect8(packets->valid, boxes.scene(), with, static_cast<RTCRayHit8*>(packet));
      if constexpr (kRays == 16)
        rtcIntersect16(packets->valid, boxes.scene(), with, static_cast<RTCRayHit16*>(packet));
      packets->collect(i, hits);
    }
  };
}

// All rays with one call.
template <std::size_t kRays>
EmbreeCast in_streams(const EmbreeInput& input) {
  return [packets = std::make_shared<Packets<kRays>>(input)](const EmbreeBoxes& boxes, rays::RayHits& hits) {
    EmbreeContext context = context_of(packets->input, false);
    begin(packets->input, hits);
    const std::size_t count = packets->packets.size(), bytes = sizeof(packets->packets[0]);
    for (std::size_t i = 0; i < count; ++i) packets->reset(i);
    void* first = packets->packets.data();
    if constexpr (kRays == 1) {
      rtcIntersect1M(boxes.scene(), &context.embree, static_cast<RTCRayHit*>(first),
                     static_cast<unsigned>(count), bytes);
    } else {
      rtcIntersectNM(boxes.scene(), &context.embree, static_cast<RTCRayHitN*>(first), kRays,
                     static_cast<unsigned>(count), bytes);
    }
    for (std::size_t i = 0; i < count; ++i) packets->collect(i, hits);
  };
}

}  // namespace

RTCIntersectFunctionN embree_callback() {
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  return &HWY_DYNAMIC_DISPATCH(meet_box);
}

std::span<const EmbreeForm> embree_forms() {
  static const EmbreeForm forms[] = {{"Embree1", in_packets<1>},       {"Embree4", in_packets<4>},
                                     {"Embree8", in_packets<8>},       {"Embree16", in_packets<16>},
                                     {"EmbreeStream1", in_streams<1>}, {"EmbreeStream16", in_streams<16>}};
  return forms;
}

}  // namespace sightline::benchmarks
#endif
