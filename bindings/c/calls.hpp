// What the functions of the C API share: they take what C gives, call the C++ of the same name, and keep why
// it refused.
#pragma once

#include <sightline/sightline.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include <sightline/box_view.hpp>
#include <sightline/jobs.hpp>
#include <sightline/occluder.hpp>
#include <sightline/occlusion.hpp>
#include <sightline/shadows.hpp>
#include <sightline/status.hpp>
#include <sightline/view.hpp>
#include <sightline/world.hpp>

struct sightline_world {
  sightline::World world;
};
struct sightline_culler {
  sightline::Culler culler;
};
struct sightline_occluder {
  sightline::Occluder occluder;
};
struct sightline_occlusion {
  sightline::OcclusionBuffer buffer;
};
struct sightline_shadow_casters {
  sightline::ShadowCasters casters;
};

namespace sightline::c_api {

/// Keeps a refusal for the thread, and returns its code either way.
sightline_status keep(const Status& status) noexcept;

/// Keeps that a pointer, a count or an option is not as it should be; `message` is a literal.
inline sightline_status refuse(const char* message) noexcept {
  return keep({StatusCode::bad_argument, message});
}

/// More bytes no program has: processors of 64 bits give it 2⁵⁶ at most, others half of what they count.
inline constexpr std::size_t kMostBytes = static_cast<std::size_t>(-1) >> (sizeof(std::size_t) == 8 ? 8 : 1);

/// Whether there can be `count` elements of so many numbers at `first`, as far as a pointer tells.
template <class T>
bool can_hold(const T* first, std::size_t count, std::size_t numbers = 1) noexcept {
  return count == 0 || (first && count <= kMostBytes / (numbers * sizeof(T)));
}

/// Bytes of a struct's first version, whose last member was `last`. Later ones stand behind it.
#define SIGHTLINE_FIRST_SIZE(type, last) (offsetof(type, last) + sizeof(type::last))

/// Whether the library knows a struct of this size, whose first version had `first_size` bytes. No version
/// ends inside a pointer, so each is a whole number of them long where it has one.
template <class T>
bool knows(std::uint32_t struct_size, std::size_t first_size) noexcept {
  return struct_size >= first_size && struct_size <= sizeof(T) && struct_size % alignof(T) == 0;
}

/// Fills in what an older header's struct has; `taken` keeps its defaults for the rest.
template <class T>
bool take_struct(const void* given, std::size_t first_size, T& taken) noexcept {
  std::uint32_t size = 0;
  std::memcpy(&size, given, sizeof size);
  if (!knows<T>(size, first_size)) return false;
  std::memcpy(&taken, given, size);
  return true;
}

/// Spheres where they lie, or copies of those whose x, y and z do not lie side by side.
struct GivenSpheres : SphereView {
  std::vector<Sphere> copied;
};

// Of what the caller gave; refused where it is not what its function makes.
Status take(const sightline_box_view& given, BoxView& boxes) noexcept;
Status take(const sightline_sphere_view& given, GivenSpheres& spheres) noexcept;
Status take(const sightline_jobs& given, JobSystem& jobs) noexcept;
/// The same of a view, which must be sound.
Status take(const sightline_view& given, WorldView& view) noexcept;

/// The views stand as far apart as the caller's header has them.
using Views = std::array<CullView, kMaxViews>;
Status take(const sightline_cull_view* given, std::size_t count, Views& views) noexcept;

inline Strided<const Handle> read(const sightline_handles& handles) noexcept {
  return {handles.first, handles.count, handles.stride};
}
inline Strided<const std::uint32_t> read(const sightline_column& column) noexcept {
  return {column.first, column.count, column.stride};
}
inline Strided<const DistanceRange> read(const sightline_distances& distances) noexcept {
  return {distances.first, distances.count, distances.stride};
}
inline CullZones zones_of(const sightline_cull_zones& zones) noexcept {
  return {zones.begin, zones.end, zones.user};
}
/// NULL where there are none.
inline const std::uint8_t* first_of(std::span<const std::uint8_t> bytes) noexcept {
  return bytes.empty() ? nullptr : bytes.data();
}
inline Handle handle_of(sightline_handle handle) noexcept {
  return {handle.index, handle.generation};
}

/// Whether the pointers hold a mesh, and its sides.
Status take_mesh(const float* positions, std::size_t position_count, const std::uint32_t* indices,
                 std::size_t index_count, const std::uint8_t* sides, std::size_t side_count,
                 std::vector<Sides>& drawn);

WorldView view_of(const sightline_view& view) noexcept;
sightline_view view_of(const WorldView& view) noexcept;

inline Box box_of(const float box[6]) noexcept {
  return {{box[0], box[1], box[2]}, {box[3], box[4], box[5]}};
}
inline Sphere sphere_of(const float sphere[4]) noexcept {
  return {{sphere[0], sphere[1], sphere[2]}, sphere[3]};
}
inline std::span<const Vec3> points_of(const float* points, std::size_t count) noexcept {
  static_assert(sizeof(Vec3) == 3 * sizeof(float));
  return {reinterpret_cast<const Vec3*>(points), count};
}

}  // namespace sightline::c_api
