// Worlds in many places: a floor, a patch of forest, a city's block is a World of its own, placed by a turn,
// a uniform scale and a translation, one level deep. What is seen comes back as runs of objects, an instance
// each.
//
//   sightline::Instances forest;
//   const auto patch = forest.add_world(trees);                // a World, kept by its address
//   forest.insert(placements, handles);                        // {*patch, transform, origin} each
//   sightline::InstanceCuller culler;
//   const auto seen = culler.cull(forest, {.view = camera});
//   if (seen)
//     for (const auto& [instance, first, count] : seen->ranges) draw(instance, seen->ids.subspan(first,
//     count));
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <sightline/box_view.hpp>
#include <sightline/jobs.hpp>
#include <sightline/status.hpp>
#include <sightline/types.hpp>
#include <sightline/world.hpp>

namespace sightline {

/// Names a world that instances show.
using PlacedWorldId = std::uint32_t;
/// The name of none.
inline constexpr PlacedWorldId kNoPlacedWorld = 0xffffffffu;

/// Which world an instance shows, and where.
struct InstancePlacement {
  PlacedWorldId world = kNoPlacedWorld;  ///< as add_world() named it
  /// From the world's metres to metres about `origin`: a rotation, a uniform scale of 10⁻⁶ … 10⁶ and a
  /// translation, right to a part in 10⁴. What is culled is what this very matrix places.
  Mat4 transform = {};
  WorldPoint origin = {};  ///< metres
};

/// Places of worlds. Each world is kept once, however many instances show it, and an instance takes some 250
/// bytes: ten thousand of a world of 100,000 objects are 10⁹ objects in ten megabytes.
///
/// Instances are objects as World has them: their handles name them, a box each, which holds all of the world
/// that they show. A refused call changes nothing. What was moved from may only be destroyed or assigned to.
/// Unless a function says otherwise: Errors: none. Cost: constant. Threads: many may read and cull (each with
/// a culler of its own) while nobody changes these or the worlds; changing is for one. Allocates: nothing.
class Instances {
public:
  /// Allocates: its first tables.
  Instances();
  ~Instances();
  Instances(Instances&&) noexcept;
  Instances& operator=(Instances&&) noexcept;

  /// Keeps a world for instances to show, by its address: it must stay there until it is removed from here.
  /// It may change between culls as any world does; see update(). Errors: too_many beyond 2³¹ worlds. Cost:
  /// linear in the world's sectors. Allocates: some 80 bytes.
  Result<PlacedWorldId> add_world(const World& world);
  /// Forgets a world; its name may be used again. Errors: bad_argument where there is none of the name, or an
  /// instance shows it.
  Status remove_world(PlacedWorldId world);
  /// To be called when worlds have changed, before the next cull: gives the instances of those that reach
  /// elsewhere now new boxes. Errors: bad_box where an instance would reach out of ±kWorldReach; index() is
  /// its id. Cost: linear in the instances of such worlds. Allocates: as World::move.
  Status update();

  /// Puts placements.size() instances in and writes their handles; `layers`, an element an instance or none,
  /// are as ObjectColumns has them: a view sees an object iff it shares a layer with the instance and a layer
  /// with the object. Errors: bad_argument (lengths, strides, pointers; a world of no such name; a transform
  /// that is not finite or no rotation, uniform scale and translation; an origin beyond kWorldReach), bad_box
  /// where the placed world reaches beyond kWorldReach, too_many; index() is the placement's. Cost: linear,
  /// some 500 ns each. Allocates: some 250 bytes each.
  Status insert(Strided<const InstancePlacement> placements, Strided<Handle> handles,
                Strided<const std::uint32_t> layers = {});
  /// Gives each instance a new placement, also of another world; see World::move. Errors: as insert;
  /// stale_handle. Cost: linear. Allocates: as World::move.
  Status move(Strided<const Handle> handles, Strided<const InstancePlacement> placements);
  /// Takes the instances out. Errors: bad_argument; stale_handle, also for one that is listed twice. Cost:
  /// linear. Allocates: a list of free ids.
  Status remove(Strided<const Handle> handles);
  /// Gives each instance new layers. Errors: bad_argument, stale_handle. Cost: linear. Allocates: as
  /// World::set_layers.
  Status set_layers(Strided<const Handle> handles, Strided<const std::uint32_t> layers);

  /// Whether the handle names an instance that stands here.
  [[nodiscard]] bool contains(Handle handle) const noexcept;
  /// Where the instance is, and what it shows; {} for a stale handle.
  [[nodiscard]] InstancePlacement placement(Handle handle) const noexcept;
  /// A box that holds all that the instance shows, in metres; {} for a stale handle.
  [[nodiscard]] WorldBox box(Handle handle) const noexcept;
  /// The handle of the instance that has this id now; a handle that contains() denies where none has.
  [[nodiscard]] Handle handle(ObjectId id) const noexcept;
  /// The world of a name, or null.
  [[nodiscard]] const World* world(PlacedWorldId world) const noexcept;
  /// How many instances there are.
  [[nodiscard]] std::size_t size() const noexcept;
  /// All ids of instances lie below this; those of removed ones are used again.
  [[nodiscard]] std::size_t id_limit() const noexcept;
  /// How many objects all instances show together. Cost: linear in the worlds.
  [[nodiscard]] std::uint64_t objects() const noexcept;

private:
  friend struct InstancesAccess;
  struct State;
  State* state_;
};

/// How a call culls; the same for all its views.
struct InstanceCullOptions {
  JobSystem jobs = {};          ///< the caller's threads, among which instances are shared out
  bool values_for_ids = false;  ///< writes the objects' values instead of their ids
  bool masks = false;           ///< whether InstanceCullResult::masks are wanted
  bool levels = false;          ///< whether its levels and fades are
  /// By which view and at which sizes levels of detail are chosen. An instance's objects are as large as they
  /// are placed. Nothing is remembered from frame to frame: `key` and `cut` are not read, and a hysteresis
  /// above 0 is refused.
  LevelOptions level_options = {};
  /// The most objects that there may be room for, 2³¹ at most. What may be seen of a group of chunks counts
  /// whole; instances that share their objects' ids count once.
  std::size_t most_objects = std::size_t{1} << 26;
  CullZones zones = {};  ///< both functions, or none
};

/// The objects that are seen of an instance: `count` of the result's ids, from `first` on.
struct InstanceRange {
  ObjectId instance = kNoObject;  ///< the id of its handle
  std::uint32_t first = 0;        ///< of the result's ids, masks, levels and fades
  std::uint32_t count = 0;        ///< at least 1
  bool operator==(const InstanceRange&) const = default;
};

/// What a cull saw. The spans lie in the culler until its next cull.
struct InstanceCullResult {
  /// An instance each, of which something may be seen. Ranges may share ids: instances of one world that are
  /// seen whole, by the same views where masks are asked for, do, so that a draw call may serve them all.
  std::span<const InstanceRange> ranges;
  std::span<const std::uint32_t> ids;           ///< objects, as their own world names them, or their values
  std::span<const std::uint8_t> masks;          ///< bit v: view v may see it; empty unless asked for
  std::span<const std::uint8_t> levels, fades;  ///< as CullOutput has them; empty unless asked for
  std::uint64_t objects = 0;                    ///< in all ranges together
  std::uint64_t tested = 0;                     ///< objects tested one by one, and instances
  std::uint64_t nodes_visited = 0;              ///< regions, groups and chunks looked at
  /// Objects that occlusion dropped, as CullResult counts them; an instance that it dropped whole counts as
  /// one.
  std::uint64_t culled_occlusion = 0;
};

/// Culls instances of worlds.
///
/// What was moved from may only be destroyed or assigned to. Unless a function says otherwise: Errors: none.
/// Cost: constant. Threads: one at a time; instances can have many cullers at once. Allocates: nothing.
class InstanceCuller {
public:
  /// Allocates: its first tables.
  InstanceCuller();
  ~InstanceCuller();
  InstanceCuller(InstanceCuller&&) noexcept;
  InstanceCuller& operator=(InstanceCuller&&) noexcept;

  /// Finds the objects that at least one of the 1 … kMaxViews views may see, instance by instance, in an
  /// order that depends on the calls so far alone, never on threads, SIMD width or processor. Each object is
  /// a box in its own world's axes: its instance turns and scales it, and no larger box around that is
  /// tested. Nothing that is visible anywhere on the image is left out, but by what the views ask for (by a
  /// buffer begun for Coverage::centres, nothing that is visible at one):
  ///
  /// - `layers` as insert() says; `occlusion`, a buffer begun with the view, hides instances and objects;
  /// - `min_area` of an object as it is placed; `distances` of objects, in metres of their own world from the
  ///   eye to the box's centre: where an instance is twice as large it is seen from twice as far;
  ///   `distance_scale` and `distance_view` as World has them;
  /// - `casters` are refused, and what objects carry to hide others is not drawn.
  ///
  /// Errors: bad_argument (no or too many views, casters, an option out of range; a world that reaches
  /// elsewhere since its instances were placed: index() is its name, and update() is due), bad_view,
  /// stale_buffer; too_many where the views may see more than most_objects. Cost: as Culler::cull of a world
  /// in which all that stood by itself, and some 600 ns a view for each instance that is seen in
  /// part, some 100 ns for one seen whole. Threads: only reads the instances, the worlds and the buffers.
  /// Allocates: nothing once it has seen its largest view.
  Result<InstanceCullResult> cull(const Instances& instances, std::span<const CullView> views,
                                  const InstanceCullOptions& options = {}) noexcept;
  /// The same for one view. Errors, Cost, Threads, Allocates: the same.
  Result<InstanceCullResult> cull(const Instances& instances, const CullView& view,
                                  const InstanceCullOptions& options = {}) noexcept {
    return cull(instances, {&view, 1}, options);
  }

private:
  struct State;
  State* state_;
};

}  // namespace sightline
