// What is seen as ranges of an order that stays, for who draws by chunk: an instance buffer holds the objects
// of a World slot by slot, and a cull says which slots to draw. The order changes only by report.
//
//   sightline::ObjectOrder order;
//   for (const auto& [slot, object] : *order.update(world))    // after each change of the world
//     if (object != sightline::kNoObject) buffer[slot] = instances[object];
//   sightline::RangeCuller culler;
//   const auto seen = culler.cull(world, order, {.view = camera});
//   if (seen)
//     for (const auto& [first, count] : seen->ranges) draw_instances(first, count);
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <sightline/jobs.hpp>
#include <sightline/status.hpp>
#include <sightline/types.hpp>
#include <sightline/world.hpp>

namespace sightline {

/// The slot of no object.
inline constexpr std::uint32_t kNoSlot = 0xffffffffu;

/// A slot that has another object than it had.
struct SlotChange {
  std::uint32_t slot = kNoSlot;  ///< below slot_limit(), or it was before
  ObjectId object = kNoObject;   ///< kNoObject: it is free now
  bool operator==(const SlotChange&) const = default;
};

/// An order of a world's objects, as its chunks hold them: each chunk has slots that follow one another, and
/// chunks that lie side by side in space have neighbouring ones, so that what a view sees is few ranges. An
/// object keeps its slot while it stays in its chunk, and while its chunk has room.
///
/// Takes 8 bytes a slot, 5 a chunk, 8 for each change of the largest report, and nothing of a world that has
/// no order. What was moved from may only be destroyed or assigned to. Unless a function says otherwise:
/// Errors: none. Cost: constant. Threads: many may read and cull while nobody changes it or its world;
/// changing is for one. Allocates: nothing.
class ObjectOrder {
public:
  /// Of no world. Allocates: its first tables.
  ObjectOrder();
  ~ObjectOrder();
  ObjectOrder(ObjectOrder&&) noexcept;
  ObjectOrder& operator=(ObjectOrder&&) noexcept;

  /// Follows what has changed in the world, and says what that changed in the order: slots that have another
  /// object, each once, free ones among them. The report lies here until the next. Call it after all changes
  /// of a frame, boxes that moved included, and before culls. The first update, one of another world, and one
  /// after another order has followed this world, number all objects one after another, without gaps but in
  /// chunks of objects that move, or that others have left, and report every slot that has an object, or had
  /// one. Errors: too_many beyond 2³² - 1 slots; the next update then begins anew. Cost: grows with the
  /// chunks that changed, not with the world: up to a microsecond each. Threads: counts as changing the
  /// world. Allocates: where the order grows, or changes as never before.
  Result<std::span<const SlotChange>> update(World& world);
  /// The same, but numbers all objects anew, as a first update does. Worth it where slot_limit() has grown
  /// far beyond the world's size. Errors, Cost: as of the first update. Allocates: another order's memory.
  Result<std::span<const SlotChange>> renumber(World& world);

  /// All slots lie below this: the length of an instance buffer.
  [[nodiscard]] std::size_t slot_limit() const noexcept;
  /// The object of each slot, or kNoObject; slot_limit() elements, until the next update.
  [[nodiscard]] std::span<const ObjectId> objects() const noexcept;
  /// The slot of an object of the world; kNoSlot for a stale handle, or where the world has changed since
  /// update().
  [[nodiscard]] std::uint32_t slot(const World& world, Handle handle) const noexcept;

private:
  friend struct OrderAccess;
  struct State;
  State* state_;
};

/// How a call culls; the same for all its views.
struct RangeOptions {
  JobSystem jobs = {};  ///< the caller's threads; without them, the calling one
  bool masks = false;   ///< whether RangeResult::masks are wanted: ranges then end where the views change
  /// Whether a chunk of which a view may see something is drawn whole: no object is tested, ranges are far
  /// fewer, and hold what stands beside the view's borders, too. `min_area` then drops nothing, and columns
  /// and occlusion only what they drop of a chunk as a whole.
  bool whole_chunks = false;
  CullZones zones = {};  ///< both functions, or none
};

/// Slots that follow one another, each with an object.
struct SlotRange {
  std::uint32_t first = 0;  ///< slot
  std::uint32_t count = 0;  ///< at least 1
  bool operator==(const SlotRange&) const = default;
};

/// What a cull saw. The spans lie in the culler until its next cull.
struct RangeResult {
  std::span<const SlotRange> ranges;    ///< no slot stands in two of them, and no range could join the next
  std::span<const std::uint8_t> masks;  ///< bit v: view v may see the range; empty unless asked for
  std::uint64_t objects = 0;            ///< in all ranges together
  std::uint64_t tested = 0;             ///< objects tested one by one
  std::uint64_t nodes_visited = 0;      ///< regions, groups and chunks looked at
  /// Objects that occlusion dropped, summed over the views. Of a chunk that is hidden whole all objects count
  /// that layers and distances leave, those that planes or min_area would drop, too.
  std::uint64_t culled_occlusion = 0;
};

/// Culls worlds into ranges of their order.
///
/// What was moved from may only be destroyed or assigned to. Unless a function says otherwise: Errors: none.
/// Cost: constant. Threads: one at a time; a world can have many cullers at once. Allocates: nothing.
class RangeCuller {
public:
  /// Allocates: its first tables.
  RangeCuller();
  ~RangeCuller();
  RangeCuller(RangeCuller&&) noexcept;
  RangeCuller& operator=(RangeCuller&&) noexcept;

  /// Finds the slots of the objects that at least one of the 1 … kMaxViews views may see: those that
  /// Culler::cull() finds without automatic occlusion, and with the same masks; with `whole_chunks`, those
  /// and more. In an order that depends on the calls so far alone, never on threads, SIMD width or processor.
  /// Errors: bad_argument (no or too many views; an option out of range), bad_view, stale_buffer, also where
  /// the world has changed since the order's update, or the order is another world's; index() is the view's.
  /// Cost: as Culler::cull, less the writing: chunks wholly in view take a few ns. Threads: only reads the
  /// world, the order and the buffers. Allocates: nothing once it has seen its largest view; up to 8 bytes
  /// for each object of the groups of chunks in view.
  Result<RangeResult> cull(const World& world, const ObjectOrder& order, std::span<const CullView> views,
                           const RangeOptions& options = {}) noexcept;
  /// The same for one view. Errors, Cost, Threads, Allocates: the same.
  Result<RangeResult> cull(const World& world, const ObjectOrder& order, const CullView& view,
                           const RangeOptions& options = {}) noexcept {
    return cull(world, order, {&view, 1}, options);
  }

private:
  struct State;
  State* state_;
};

}  // namespace sightline
