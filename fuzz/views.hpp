// Numbers, cameras and boxes out of the fuzzer's bytes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <sightline/view.hpp>

#include "bytes.hpp"

namespace sightline::fuzz {

inline void require(bool holds) {
  if (!holds) std::abort();
}

struct Numbers : Bytes {
  using Bytes::Bytes;
  // Mostly ordinary, now and then anything.
  float number() {
    const std::uint8_t kind = byte();
    return kind < 8 ? take<float>()
                    : static_cast<float>(take<std::int16_t>()) / static_cast<float>(1 << (kind % 16));
  }
  Vec3 point() { return {number(), number(), number()}; }
  bool rarely() { return byte() == 0; }
};

/// A camera's view, its matrices now and then harmed.
inline View view_of(Numbers& in) {
  Camera camera{.eye = in.point(), .forward = in.point(), .up = in.point()};
  camera.vertical_fov = in.number(), camera.orthographic_height = in.byte() & 1 ? in.number() : 0;
  camera.near_plane = in.number(), camera.far_plane = in.byte() & 1 ? in.number() : 1000;
  camera.shift_x = in.byte() & 1 ? in.number() : 0;
  camera.depth = in.byte() & 1 ? Depth::reversed : Depth::standard;
  const std::uint32_t width = 1 + in.byte(), height = 1 + in.byte();
  const Result<View> made = make_view(camera, width, height);
  View view = made ? *made : *make_view(Camera{}, width, height);
  const std::uint8_t harm = in.byte();
  if (harm < 16) view.eye_to_clip.m[harm] = in.take<float>();
  if (harm >= 16 && harm < 32) view.world_to_eye.m[harm - 16] = in.take<float>();
  return view;
}

/// A valid box.
inline Box box_of(Numbers& in) {
  const Vec3 a = in.point(), b = in.point();
  const auto finite = [](float v) { return std::isfinite(v) ? std::clamp(v, -1e30f, 1e30f) : 0; };
  const auto low = [&](float p, float q) { return std::min(finite(p), finite(q)); };
  const auto high = [&](float p, float q) { return std::max(finite(p), finite(q)); };
  return {{low(a.x, b.x), low(a.y, b.y), low(a.z, b.z)}, {high(a.x, b.x), high(a.y, b.y), high(a.z, b.z)}};
}

}  // namespace sightline::fuzz
