// Worlds as bytes: saved, loaded as a whole, or brought in sector by sector within a memory budget, while
// another thread checks and copies what comes next.
//
//   sightline::World world;
//   sightline::Result<sightline::WorldStream> stream = sightline::WorldStream::open(mapped_file, world);
//   std::thread loader([&] { while (!done) if (!stream->work()) wait_a_moment(); });
//   for (;;) {                                                           // a frame
//     auto report = stream->update({&view, 1}, {.budget = 512u << 20});  // what came, goes and is to come
//     culler.cull(world, view, ids);
//   }
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include <sightline/status.hpp>
#include <sightline/types.hpp>
#include <sightline/world.hpp>

namespace sightline {

/// Where save() writes: called with one piece of the bytes after another; false ends the saving.
struct SnapshotSink {
  bool (*write)(void* user, std::span<const std::byte> bytes) = nullptr;  ///< puts the bytes behind the last
  void* user = nullptr;                                                   ///< handed to `write`
};

/// Writes a world's objects: boxes, handles, columns and tables of levels, but not what objects carry
/// (occluders and triangles, which are files of their own). The same for the same world, little-endian, some
/// 32 bytes an object and 4 for each number in a column.
/// Errors: bad_argument where there is no `write`, or sectors of the world are out; too_many where the sink
/// took no more. Cost: linear, some 5 ns an object, 200 in sectors where objects moved. Threads: only reads
/// the world. Allocates: the bytes of a sector at a time.
Status save(const World& world, const SnapshotSink& sink);

/// A whole world out of the bytes that save() wrote: handles, columns and orders are those of the saved one,
/// and it behaves as that would, but that objects which moved are filed anew: of boxes that lie outside a
/// frustum by no more than rounding may make of it, one may keep some that the other leaves out.
/// Errors: bad_file for what is damaged, truncated, of another version or no such file; index() is the byte
/// where the damaged part begins. Safe with any bytes that nobody changes meanwhile. Cost: linear, some 15
/// ns an object. Threads: any. Allocates: as World::insert, no more than 20 times the bytes.
Result<World> load(std::span<const std::byte> bytes);

/// Where a sector of a stream is.
enum class SectorState : std::uint8_t {
  out,      ///< in the bytes alone
  coming,   ///< asked for
  in,       ///< in the world
  changed,  ///< in the world, and no longer as in the bytes: it stays in
  damaged,  ///< its bytes were refused: it stays out
};

/// A sector of a stream.
struct StreamSector {
  WorldBox bounds;                       ///< of its boxes as saved, in metres
  std::size_t objects = 0;               ///< as saved
  std::size_t memory = 0;                ///< bytes that it takes in the world, as saved
  std::size_t first_byte = 0;            ///< where it begins in the bytes
  SectorState state = SectorState::out;  ///< where it is
  Status error;                          ///< why it is damaged; index() is the byte where it begins
};

/// Which sectors update() wants in.
struct StreamOptions {
  /// Bytes that sectors may take, those that are coming and those that changed among them, as saved; only the
  /// latter may take more. What there is besides is not counted: an id's 16 bytes, columns, the lists of who
  /// came and went.
  std::size_t budget = std::numeric_limits<std::size_t>::max();
  /// Metres around the eyes within which sectors are wanted that no view touches, after those that views
  /// touch.
  double ahead = 3200;
};

/// What update() found.
struct StreamReport {
  std::size_t in = 0;       ///< sectors in the world, changed ones among them
  std::size_t coming = 0;   ///< sectors asked for
  std::size_t missing = 0;  ///< sectors that a view touches and that are not in, but for damaged ones
  std::size_t damaged = 0;  ///< sectors that were refused so far
  std::size_t memory = 0;   ///< bytes that those in and coming take
};

/// Brings a world that lies in bytes in by sectors, nearest first.
///
/// What is out is as if it were not there: culls do not see it, and its handles are stale until it is in
/// again, when they name the same objects as before. A sector that was changed while in stays in. What its
/// objects carried, occluders and triangles, is forgotten when it goes out: came() lists who is to be given
/// it again. The bytes must stay as they are as long as the stream lives; a mapped file is what they should
/// be, for nothing of a sector is read before it comes.
///
/// What was moved from may only be destroyed or assigned to. Unless a function says otherwise: Errors: none.
/// Cost: constant. Threads: those of World's for changing it; work() alone may run on others at the same
/// time, and has returned when the stream goes. Allocates: nothing.
class WorldStream {
public:
  /// Checks all but the sectors, which are checked when they come. `world`, a new one, becomes that of the
  /// bytes with all sectors out; it is then culled and changed as any other, and must live, though it may be
  /// moved, as long as the stream. Errors: bad_file, as load(); bad_argument for a world that is in use.
  /// Cost: linear in sectors and ids, some 2 ns an id. Threads: any. Allocates: 16 bytes an id, what columns
  /// take by id, some 300 bytes a sector.
  static Result<WorldStream> open(std::span<const std::byte> bytes, World& world);
  ~WorldStream();
  WorldStream(WorldStream&&) noexcept;
  WorldStream& operator=(WorldStream&&) noexcept;

  /// How many sectors there are.
  [[nodiscard]] std::size_t size() const noexcept;
  /// One of them; {} beyond size().
  [[nodiscard]] StreamSector sector(std::size_t index) const noexcept;
  /// Whether the handle may name an object that is out: its id is that of one, and its generation, where the
  /// object was in before.
  [[nodiscard]] bool stands_out(Handle handle) const noexcept;

  /// To be called once a frame, before culling. Puts one of the sectors in that work() has made ready; wants
  /// those that the 1 … kMaxViews views touch, nearest first, then those near by, as far as the budget goes;
  /// and takes out the farthest of the others where room is needed. Errors: bad_argument, bad_view, as
  /// Culler::cull, of which it reads the views alone. Cost: some 100 ns a sector and view; an object that
  /// comes or goes 5 to 10 ns, or 200 where others were put into its sector meanwhile. Allocates: its lists,
  /// until they were as long once; columns' rows.
  Result<StreamReport> update(std::span<const CullView> views, const StreamOptions& options = {});
  /// Checks one of the wanted sectors and copies it, for the next update() to put in; false where none
  /// waits. Cost: some 5 to 10 ns an object. Threads: any, several at once. Allocates: the sector.
  bool work();
  /// update() and work() until all that the views touch is in, as far as the budget goes, and nothing else:
  /// `ahead` is not read. For the first view, or after a cut. Errors, Allocates: as update(). Cost: both.
  Result<StreamReport> bring_in(std::span<const CullView> views, const StreamOptions& options = {});
  /// Objects that came in with the last update() or bring_in() that was not refused, and are in behind it: to
  /// be given what they carry, occluders and triangles, or what a renderer keeps of each. Until the next such
  /// call; an object that is removed meanwhile is listed still.
  [[nodiscard]] std::span<const Handle> came() const noexcept;
  /// Those that were in before it and went out: their handles are stale, their ids as before. One that went
  /// and came again within the call is in both, as what it carried is forgotten.
  [[nodiscard]] std::span<const Handle> went() const noexcept;

private:
  struct State;
  explicit WorldStream(State* state) noexcept;
  State* state_;
};

}  // namespace sightline
