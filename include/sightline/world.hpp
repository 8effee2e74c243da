// A world of boxes that come, move and go, at any scale, and the culling of it: here are my boxes, here is my
// camera, give me what to draw. No GPU is needed.
//
//   sightline::World world;
//   world.insert(boxes, handles);
//   std::vector<sightline::ObjectId> visible(sightline::cull_capacity(world));
//   const auto drawn = sightline::cull(world, views, {}, visible);   // ids are visible[0 … drawn.count-1]
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include <sightline/jobs.hpp>
#include <sightline/types.hpp>
#include <sightline/view.hpp>

namespace sightline {

namespace world {
struct CullerState;
struct WorldState;
}  // namespace world
class OcclusionBuffer;

/// Names an object for as long as it stands in the world. A handle whose object was removed is found out, not
/// followed: the generation of a reused index differs.
struct Handle {
  ObjectId index = kNoObject;  ///< the id that cull() writes; below World::id_limit()
  std::uint32_t generation = 0;
  bool operator==(const Handle&) const = default;
};

/// Boxes in sectors of 3,200 m, each with a double-precision origin, so that a box keeps its place to half a
/// millimetre anywhere, rounded outwards: what is stored holds what was given. Inside a sector, a chunk map.
/// Not for use by two threads at once, unless both only read; culling with a Culler each only reads.
class World {
public:
  World();
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  /// Puts boxes.size() objects in and writes their handles; both spans have one length. Refuses all of them,
  /// changing nothing, if one is not valid or the world would hold 2³¹ objects.
  Check insert(std::span<const WorldBox> boxes, std::span<Handle> handles);
  /// Gives each object a new box. Refuses all, changing nothing, if a box is not valid or a handle is stale.
  Check move(std::span<const Handle> handles, std::span<const WorldBox> boxes);
  /// Takes the objects out. Refuses all, changing nothing, if a handle is stale or stands there twice.
  Check remove(std::span<const Handle> handles);

  [[nodiscard]] bool contains(Handle handle) const noexcept;
  /// The box as stored; {} for a stale handle.
  [[nodiscard]] WorldBox box(Handle handle) const noexcept;
  /// The handle of the object that has this id now; a handle that no world contains where none has.
  [[nodiscard]] Handle handle(ObjectId id) const noexcept;
  [[nodiscard]] std::size_t size() const noexcept;
  /// All ids lie below this: the length of a caller's array by id. Ids of removed objects are given again.
  [[nodiscard]] std::size_t id_limit() const noexcept;

  [[nodiscard]] const world::WorldState& state() const noexcept { return *state_; }
  [[nodiscard]] world::WorldState& state() noexcept { return *state_; }

private:
  std::unique_ptr<world::WorldState> state_;
};

/// Views that one call culls together.
inline constexpr std::size_t kMaxViews = 8;

struct CullOptions {
  /// Drops what covers fewer px² than this by its bounding sphere (Lee & Shin 2023, equation 1, mended):
  /// approximate. 0 drops nothing.
  float min_area = 0;
  /// One a view or none; a null entry culls nothing by occlusion. Each was drawn with its view.
  std::span<const OcclusionBuffer* const> occlusion = {};
  JobSystem jobs = {};
};

enum class CullError : std::uint8_t { none, views, view, buffer, options };

struct CullResult {
  std::size_t count = 0;               ///< objects written
  CullError error = CullError::none;   ///< what was wrong with the call; nothing was culled then
  std::uint64_t tested = 0;            ///< objects tested one by one
  std::uint64_t nodes_visited = 0;     ///< regions, groups and chunks looked at
  std::uint64_t culled_occlusion = 0;  ///< objects that only occlusion dropped, summed over the views
};

/// Elements that the buffers of a cull need.
std::size_t cull_capacity(const World& world, const CullOptions& options = {}) noexcept;

/// Culls, and remembers from frame to frame what helps the next. One a thread of culling; a world can have
/// many.
class Culler {
public:
  Culler();
  ~Culler();
  Culler(Culler&&) noexcept;
  Culler& operator=(Culler&&) noexcept;

  /// Writes the ids of the objects that at least one of the 1 … kMaxViews views may see, in an order that
  /// depends on the world's history alone, and to `masks`, unless it is empty, bit v set where view v may see
  /// the object. Both have cull_capacity() elements; what stands behind the returned count is undefined.
  /// Same world, same answer for any number of threads and any SIMD width. Allocates nothing once it has
  /// grown to the world's size.
  CullResult cull(const World& world, std::span<const WorldView> views, const CullOptions& options,
                  std::span<ObjectId> visible, std::span<std::uint8_t> masks = {}) noexcept;

private:
  std::unique_ptr<world::CullerState> state_;
};

/// Culls with a Culler that the world carries.
CullResult cull(World& world, std::span<const WorldView> views, const CullOptions& options,
                std::span<ObjectId> visible, std::span<std::uint8_t> masks = {}) noexcept;

}  // namespace sightline
