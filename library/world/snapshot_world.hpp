// What stands behind sightline::WorldStream.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include <sightline/snapshot.hpp>

#include "library/world/chunk_map_parts.hpp"
#include "library/world/snapshot_format.hpp"
#include "library/world/world_state.hpp"

namespace sightline::world {

/// Location::slot_and_history of an object that is out, but was in.
inline constexpr std::uint32_t kGenerationIsKnown = 1;

/// Whose sectors passed one way, in or out, since clear().
class Passed {
public:
  void clear() noexcept { handles_.clear(), parts_.clear(); }
  /// Begins a sector, whose objects are then added.
  void begin(std::size_t sector) { parts_.push_back({sector, handles_.size()}); }
  void add(Handle handle) { handles_.push_back(handle); }
  /// Forgets a sector, where it is among them.
  bool drop(std::size_t sector);
  [[nodiscard]] std::span<const Handle> handles() const noexcept { return handles_; }

private:
  struct Part {
    std::size_t sector = 0, first = 0;
  };
  std::vector<Handle> handles_;
  std::vector<Part> parts_;  ///< in the order of their handles
};

/// A world of which sectors come out of a snapshot. Sector i of the snapshot has place i among the world's,
/// so that with all of them in, a cull goes through them in the order that it always had.
class SnapshotWorld {
public:
  /// Whether nobody has done anything with the world yet.
  static bool is_new(const World& world) noexcept;
  /// Of a new world; nothing is in. It stays the one meant when its World is moved.
  void begin(SnapshotDirectory directory, World& world);
  [[nodiscard]] const SnapshotDirectory& directory() const noexcept { return directory_; }
  [[nodiscard]] const WorldState& state() const noexcept { return *state_; }

  /// Reads a sector that is not in. May run on any thread.
  Status read(std::size_t sector, SectorPiece& piece) const {
    return ChunkMapParts::read(directory_, sector, piece);
  }
  /// Puts in what was read; refused, with nothing changed, where an id stands twice.
  Status put_in(std::size_t sector, SectorPiece& piece);
  /// Takes out a sector that is in and unchanged.
  void take_out(std::size_t sector);
  /// Objects that were put in or taken out since begin_turn(). Who was put in and then taken out is in
  /// neither; who went and came is in both, for what he carried is forgotten.
  void begin_turn() noexcept { came_.clear(), went_.clear(); }
  [[nodiscard]] std::span<const Handle> came() const noexcept { return came_.handles(); }
  [[nodiscard]] std::span<const Handle> went() const noexcept { return went_.handles(); }
  /// Whether a sector that was put in is as it was then.
  [[nodiscard]] bool unchanged(std::size_t sector) const noexcept {
    return state_->sectors[sector].snapshot == sector;
  }

private:
  Status claim(std::size_t sector, const ChunkMap& map);
  void read_columns(const SectorPiece& piece);
  void file_each(const ChunkMap& map, std::uint32_t into);

  SnapshotDirectory directory_;
  WorldState* state_ = nullptr;
  Passed came_, went_;
};

/// A sector that update() asked for, on its way through work().
struct Request {
  enum State : std::uint8_t { none, wanted, taken, ready };
  std::atomic<std::uint8_t> state{none};
  std::uint32_t sector = 0;
  SectorPiece piece;
  Status error;
};

/// How a sector is ranked among those to be in: one that a view touches before others, near ones first.
struct SectorRank {
  bool touched = false;
  double distance = 0;  ///< metres from the nearest eye
  std::uint32_t sector = 0;

  bool operator<(const SectorRank& other) const noexcept {
    if (touched != other.touched) return touched;
    return distance != other.distance ? distance < other.distance : sector < other.sector;
  }
};

struct StreamState {
  struct Sector {
    WorldPoint origin;
    std::size_t memory = 0;
    SectorState state = SectorState::out;
    bool due = false;  ///< to be in, by the last update()
    Status error;
  };

  SnapshotWorld snapshot;
  std::vector<Sector> sectors;
  std::size_t memory = 0;  ///< of those in and coming
  std::array<Request, 16> requests;
  std::vector<SectorRank> ranks;

  /// update() of views and options that were checked; puts in so many sectors that are ready.
  StreamReport update(std::span<const CullView> views, const StreamOptions& options, std::size_t most);

private:
  void collect(std::size_t most);
  void withdraw();
  void rank(std::span<const CullView> views);
  void choose(const StreamOptions& options);
  void order(std::size_t budget);
  [[nodiscard]] StreamReport report() const;
};

}  // namespace sightline::world
