// Rays against boxes: the slab test, and a wide bounding volume hierarchy that tells what rays meet first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include <sightline/box_view.hpp>
#include <sightline/jobs.hpp>
#include <sightline/status.hpp>
#include <sightline/types.hpp>
#include <sightline/view.hpp>

namespace sightline {

/// A half line, or a piece of one.
struct Ray {
  Vec3 origin;     ///< metres
  Vec3 direction;  ///< any length but zero; distances are in units of it
  float max_distance = std::numeric_limits<float>::infinity();  ///< nothing is met beyond it
};

/// A ray as the slab test wants it. The one division a coordinate needs is done here, once, so that the test
/// itself is made of operations that every processor rounds alike.
struct PreparedRay {
  PreparedRay() noexcept = default;
  /// Errors: none. Cost: three divisions. Threads: any. Allocates: nothing.
  explicit PreparedRay(const Ray& ray) noexcept;

  Vec3 origin;   ///< metres
  Vec3 inverse;  ///< 1 / direction; 0 on an axis that the ray is parallel to (|direction| < 1e-37)
  float max_distance = std::numeric_limits<float>::infinity();  ///< the ray's
};

namespace detail {

// Narrows [entry, exit] by one slab; a ray parallel to it is inside or misses.
inline bool clip(float origin, float inverse, float low, float high, float& entry, float& exit) noexcept {
  if (inverse == 0) return origin >= low && origin <= high;
  const float a = (low - origin) * inverse, b = (high - origin) * inverse;
  const float first = a < b ? a : b, last = a < b ? b : a;
  entry = first > entry ? first : entry;
  exit = last < exit ? last : exit;
  return entry <= exit;
}

}  // namespace detail

/// Distance along the ray to the box, 0 where the ray starts inside, -1 for a miss. Slab test (Kay & Kajiya
/// 1986) without NaNs: a ray along a face, in the face's plane, hits.
///
/// The one definition that every ray method shares, on CPU and GPU. It is monotonic to the bit: a box that
/// holds another is hit by every ray that hits the other, at no greater distance.
/// Errors: none. Cost: constant. Threads: any. Allocates: nothing.
inline float intersect(const PreparedRay& ray, const Box& box) noexcept {
  float entry = 0, exit = ray.max_distance;
  if (!detail::clip(ray.origin.x, ray.inverse.x, box.min.x, box.max.x, entry, exit)) return -1;
  if (!detail::clip(ray.origin.y, ray.inverse.y, box.min.y, box.max.y, entry, exit)) return -1;
  if (!detail::clip(ray.origin.z, ray.inverse.z, box.min.z, box.max.z, entry, exit)) return -1;
  return entry;
}

/// The same, prepared on the way. Errors, Cost, Threads, Allocates: the same.
float intersect(const Ray& ray, const Box& box) noexcept;

/// Boxes to cast rays at: binned SAH (Wald 2007) collapsed to nodes of eight boxes that SIMD tests at once.
///
/// A refused call changes nothing. What was moved from may only be destroyed or assigned to. Unless a
/// function says otherwise: Errors: none. Cost: constant. Threads: one at a time. Allocates: nothing.
class BoxBvh {
public:
  /// Without a box. Allocates: a little.
  BoxBvh();
  ~BoxBvh();
  BoxBvh(BoxBvh&&) noexcept;
  BoxBvh& operator=(BoxBvh&&) noexcept;

  /// Takes the boxes, in metres about `origin`, rounded outwards to single precision there.
  /// Errors: bad_argument (not sound, an origin beyond kWorldReach), bad_box, too_many (beyond 2³⁰). Cost: n
  /// log n, some 300 ns a box. Allocates: about 90 bytes a box, and half of that again while it builds.
  Status build(const BoxView& boxes, const WorldPoint& origin = {});
  /// Takes over moved boxes, as many as were built with: the tree stays, its bounds become tight again. Rays
  /// get slower where boxes move far; build anew then. Errors: bad_argument (not sound, another number),
  /// bad_box. Cost: linear, some 15 ns a box.
  Status refit(const BoxView& boxes);
  /// How many boxes it holds.
  [[nodiscard]] std::size_t size() const noexcept;

  /// Writes, ray by ray, in metres about the boxes' origin, the box that it meets first (kNoObject: none; of
  /// equally near ones the lowest) and the distance to it in units of its direction (0 where it starts
  /// inside; -1 for a miss): the same to the bit as testing all. `distances` may be empty. Neighbouring rays
  /// that point alike are fastest. Errors: buffer_too_small where a span is shorter than `rays`; bad_argument
  /// for options out of range. A ray that is not finite or has no direction misses. Cost: 20 to 50 ns a ray
  /// among thousands of boxes. Threads: one at a time, which the caller's jobs help. Allocates: until it has
  /// seen as many rays.
  Status cast(std::span<const Ray> rays, std::span<ObjectId> objects, std::span<float> distances = {},
              const JobSystem& jobs = {});
  /// Writes the boxes that at least one of columns × rows rays through the view's image meets first,
  /// ascending, and returns how many: an approximation of what is visible (Ye et al. 2023), closer the more
  /// rays. `visible` has size() elements. `view.origin` is the one that the boxes were built with. Errors:
  /// bad_view; bad_argument for no rays or more than 2²⁴; buffer_too_small. Cost, Threads, Allocates: as
  /// cast.
  Result<std::size_t> visible_set(const WorldView& view, std::uint32_t columns, std::uint32_t rows,
                                  std::span<ObjectId> visible, const JobSystem& jobs = {});

private:
  struct State;
  State* state_;
};

}  // namespace sightline
