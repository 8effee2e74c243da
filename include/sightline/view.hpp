// A view: where the camera stands, how it projects, and how many pixels it fills.
#pragma once

#include <cstdint>

#include <sightline/status.hpp>
#include <sightline/types.hpp>

namespace sightline {

/// Any camera: perspective, infinite far, off-centre or orthographic, with standard or reversed depth.
/// Clip space is Vulkan's with y up: -w <= x <= w, -w <= y <= w, 0 <= z <= w; row 0 of the image is y = +w.
struct View {
  Mat4 world_to_eye;  ///< rigid, which is not checked; the eye looks down its own -z, with +y up
  Mat4 eye_to_clip;   ///< the projection
  std::uint32_t width = 1280, height = 720;  ///< pixels
  bool operator==(const View&) const = default;
};

/// A view from anywhere: `view` sees the world moved by -origin, so that its own matrices keep their
/// precision. With an origin of 0 it is the view itself.
struct WorldView {
  View view;          ///< of the world moved by -origin
  WorldPoint origin;  ///< metres
  bool operator==(const WorldView&) const = default;
};

/// Which way depth runs.
enum class Depth : std::uint8_t {
  standard,  ///< near plane at 0, far plane at 1
  reversed,  ///< near plane at 1, far plane at 0
};

/// A camera as people describe it. `make_view` turns it into matrices.
struct Camera {
  Vec3 eye{};                        ///< metres
  Vec3 forward{0, 0, -1};            ///< any length but zero, not along `up`
  Vec3 up{0, 1, 0};                  ///< any length but zero
  float vertical_fov = 1.04719755f;  ///< radians, 0 < fov < pi; ignored where `orthographic_height` is set
  float orthographic_height = 0;     ///< metres; > 0 makes the view orthographic
  float near_plane = 0.1f;           ///< metres, > 0 for perspective
  float far_plane = 2000;            ///< metres, > near; +infinity is allowed for perspective
  float shift_x = 0, shift_y = 0;    ///< off-centre projection: image shift in half image sizes
  Depth depth = Depth::standard;     ///< which way depth runs
};

/// The matrices of a camera with an image of width × height pixels.
/// Errors: bad_view for a camera that is not finite, has no direction, or whose planes, field of view or size
/// are out of range. Cost: some 500 ns. Threads: any. Allocates: nothing.
Result<View> make_view(const Camera& camera, std::uint32_t width, std::uint32_t height) noexcept;

/// Whether the view can be culled with: finite matrices, the first affine, both invertible, 1 … 16384 pixels
/// a side. Errors: bad_view. Cost: some 200 ns. Threads: any. Allocates: nothing.
Status check(const View& view) noexcept;
/// The same, and an origin within ±kWorldReach. Errors, Cost, Threads, Allocates: the same.
Status check(const WorldView& view) noexcept;

/// eye_to_clip · world_to_eye, computed in double precision, rounded once.
/// Errors: none, of a view that check() finds sound. Cost: constant. Threads: any. Allocates: nothing.
Mat4 world_to_clip(const View& view) noexcept;

/// The eye in metres, about the view's origin (for an orthographic view, the origin of eye space).
/// Errors: none, of a view that check() finds sound. Cost: constant. Threads: any. Allocates: nothing.
Vec3 eye_position(const View& view) noexcept;

/// Unit vector along which the view looks.
/// Errors: none, of a view that check() finds sound. Cost: constant. Threads: any. Allocates: nothing.
Vec3 view_direction(const View& view) noexcept;

/// Whether parallel lines stay parallel: w is 1 everywhere.
/// Errors: none. Cost: constant. Threads: any. Allocates: nothing.
bool is_orthographic(const View& view) noexcept;

}  // namespace sightline
