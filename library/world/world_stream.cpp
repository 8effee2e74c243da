// Which sectors of a snapshot are in: ranked, chosen and exchanged once a frame; read by whoever calls
// work().
#include <algorithm>
#include <cmath>
#include <utility>

#include <sightline/snapshot.hpp>

#include "library/geometry/box_reader.hpp"
#include "library/geometry/linear.hpp"
#include "library/world/sector_test.hpp"
#include "library/world/snapshot_world.hpp"

namespace sightline {

namespace world {

namespace {

double distance_to(const WorldPoint& p, const WorldBox& b) noexcept {
  const auto beyond = [](double at, double low, double high) { return std::max({low - at, at - high, 0.0}); };
  return std::hypot(beyond(p.x, b.min.x, b.max.x), beyond(p.y, b.min.y, b.max.y),
                    beyond(p.z, b.min.z, b.max.z));
}

bool is_in(SectorState state) noexcept {
  return state == SectorState::in || state == SectorState::changed;
}

}  // namespace

// Puts in what work() has made ready, and learns what was changed meanwhile.
void StreamState::collect(std::size_t most) {
  for (std::size_t i = 0; i < sectors.size(); ++i)
    if (sectors[i].state == SectorState::in && !snapshot.unchanged(i))
      sectors[i].state = SectorState::changed;
  for (Request& request : requests) {
    if (most == 0 || request.state.load(std::memory_order_acquire) != Request::ready) continue;
    --most;
    Sector& sector = sectors[request.sector];
    if (!request.error) {
      sector.error = request.error;
    } else {
      sector.error = snapshot.put_in(request.sector, request.piece);
    }
    const bool in = static_cast<bool>(sector.error);
    sector.state = !in                                  ? SectorState::damaged
                   : snapshot.unchanged(request.sector) ? SectorState::in
                                                        : SectorState::changed;
    if (!in) memory -= sector.memory;
    request.piece = {}, request.error = {};
    request.state.store(Request::none, std::memory_order_relaxed);
  }
}

// Takes back what was asked for and nobody has begun with, so that what is wanted most is asked for first.
void StreamState::withdraw() {
  for (Request& request : requests) {
    std::uint8_t expected = Request::wanted;
    if (!request.state.compare_exchange_strong(expected, Request::none, std::memory_order_relaxed)) continue;
    sectors[request.sector].state = SectorState::out;
    memory -= sectors[request.sector].memory;
  }
}

void StreamState::rank(std::span<const CullView> views) {
  std::array<SectorTest, kMaxViews> tests;
  std::array<WorldPoint, kMaxViews> eyes;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const WorldView& view = views[v].view;
    const glm::dvec3 eye = geometry::eye_of(view.view);
    tests[v] = SectorTest(view);
    eyes[v] = {view.origin.x + eye.x, view.origin.y + eye.y, view.origin.z + eye.z};
  }
  ranks.clear();
  for (std::uint32_t i = 0; i < sectors.size(); ++i) {
    const WorldPoint& origin = sectors[i].origin;
    const Box& bounds = snapshot.directory().sectors[i].bounds;
    const WorldBox box = geometry::world_box(bounds, origin);
    SectorRank rank{false, std::numeric_limits<double>::infinity(), i};
    for (std::size_t v = 0; v < views.size(); ++v) {
      rank.touched = rank.touched || !tests[v].misses(origin, bounds);
      rank.distance = std::min(rank.distance, distance_to(eyes[v], box));
    }
    ranks.push_back(rank);
  }
  std::sort(ranks.begin(), ranks.end());
}

// Those first in rank are due, as many as the budget holds beside what stays whatever happens.
void StreamState::choose(const StreamOptions& options) {
  std::size_t used = 0;
  const auto stays = [&](const Sector& s) {
    return s.state == SectorState::changed || s.state == SectorState::coming;
  };
  for (Sector& sector : sectors) {
    sector.due = stays(sector);
    if (sector.due) used += sector.memory;
  }
  for (const SectorRank& rank : ranks) {
    Sector& sector = sectors[rank.sector];
    if (sector.due || sector.state == SectorState::damaged) continue;
    if (!rank.touched && !(rank.distance <= options.ahead)) continue;
    if (used > options.budget || sector.memory > options.budget - used) continue;
    sector.due = true, used += sector.memory;
  }
}

// Asks for what is due and out, and makes room for it: what ranks last goes first.
void StreamState::order(std::size_t budget) {
  auto last = ranks.rbegin();
  const auto make_room = [&](std::size_t wanted) {
    for (; last != ranks.rend() && (memory > budget || wanted > budget - memory); ++last) {
      Sector& sector = sectors[last->sector];
      if (sector.due || sector.state != SectorState::in) continue;
      snapshot.take_out(last->sector);
      sector.state = SectorState::out;
      memory -= sector.memory;
    }
    return memory <= budget && wanted <= budget - memory;
  };
  make_room(0);
  auto request = requests.begin();
  for (const SectorRank& rank : ranks) {
    Sector& sector = sectors[rank.sector];
    if (!sector.due || sector.state != SectorState::out) continue;
    while (request != requests.end() && request->state.load(std::memory_order_relaxed) != Request::none)
      ++request;
    if (request == requests.end() || !make_room(sector.memory)) return;
    sector.state = SectorState::coming;
    memory += sector.memory;
    request->sector = rank.sector;
    request->state.store(Request::wanted, std::memory_order_release);
  }
}

StreamReport StreamState::update(std::span<const CullView> views, const StreamOptions& options,
                                 std::size_t most) {
  collect(most);
  withdraw();
  rank(views);
  choose(options);
  order(options.budget);
  return report();
}

StreamReport StreamState::report() const {
  StreamReport out;
  out.memory = memory;
  for (const SectorRank& rank : ranks) {
    const SectorState state = sectors[rank.sector].state;
    out.in += is_in(state), out.coming += state == SectorState::coming;
    out.damaged += state == SectorState::damaged;
    out.missing += rank.touched && !is_in(state) && state != SectorState::damaged;
  }
  return out;
}

}  // namespace world

namespace {

Status check_stream(std::span<const CullView> views, const StreamOptions& options) noexcept {
  if (views.empty() || views.size() > kMaxViews)
    return {StatusCode::bad_argument, "stream: expected 1 to 8 views", views.size()};
  if (!(options.ahead >= 0))
    return {StatusCode::bad_argument, "stream: the metres ahead are negative or not a number"};
  for (std::size_t v = 0; v < views.size(); ++v)
    if (const Status sound = check(views[v].view); !sound) return {StatusCode::bad_view, sound.message(), v};
  return {};
}

}  // namespace

struct WorldStream::State : world::StreamState {};

WorldStream::WorldStream(State* state) noexcept : state_(state) {}
WorldStream::~WorldStream() {
  delete state_;
}
WorldStream::WorldStream(WorldStream&& other) noexcept : state_(std::exchange(other.state_, nullptr)) {}
WorldStream& WorldStream::operator=(WorldStream&& other) noexcept {
  std::swap(state_, other.state_);
  return *this;
}

Result<WorldStream> WorldStream::open(std::span<const std::byte> bytes, World& into) {
  if (!world::SnapshotWorld::is_new(into))
    return Status(StatusCode::bad_argument, "stream: the world is in use, expected a new one");
  Result<world::SnapshotDirectory> directory = world::read_directory(bytes);
  if (!directory) return directory.error();
  WorldStream stream(new State);
  State& state = *stream.state_;
  for (const world::SectorEntry& e : directory->sectors) {
    const auto at = [](std::int64_t cell) { return static_cast<double>(cell) * world::kSectorSide; };
    world::StreamState::Sector sector;
    sector.origin = {at(e.cell[0]), at(e.cell[1]), at(e.cell[2])};
    sector.memory = world::ChunkMapParts::memory(e, directory->columns);
    state.sectors.push_back(sector);
  }
  state.snapshot.begin(*std::move(directory), into);
  return stream;
}

std::size_t WorldStream::size() const noexcept {
  return state_->sectors.size();
}

StreamSector WorldStream::sector(std::size_t index) const noexcept {
  if (index >= size()) return {};
  const auto& sector = state_->sectors[index];
  const world::SnapshotDirectory& directory = state_->snapshot.directory();
  const world::SectorEntry& entry = directory.sectors[index];
  const bool changed = sector.state == SectorState::in && !state_->snapshot.unchanged(index);
  return {geometry::world_box(entry.bounds, sector.origin),
          entry.objects,
          sector.memory,
          directory.first_bytes[index],
          changed ? SectorState::changed : sector.state,
          sector.error};
}

bool WorldStream::stands_out(Handle handle) const noexcept {
  const auto& objects = state_->snapshot.state().objects;
  if (handle.index >= objects.size()) return false;
  const auto& at = objects[handle.index];
  return at.chunk == world::ChunkMap::kOut &&
         (at.slot_and_history != world::kGenerationIsKnown || at.generation == handle.generation);
}

Result<StreamReport> WorldStream::update(std::span<const CullView> views, const StreamOptions& options) {
  if (const Status sound = check_stream(views, options); !sound) return sound;
  state_->snapshot.begin_turn();
  return state_->update(views, options, 1);
}

std::span<const Handle> WorldStream::came() const noexcept {
  return state_->snapshot.came();
}

std::span<const Handle> WorldStream::went() const noexcept {
  return state_->snapshot.went();
}

bool WorldStream::work() {
  for (world::Request& request : state_->requests) {
    std::uint8_t expected = world::Request::wanted;
    if (!request.state.compare_exchange_strong(expected, world::Request::taken, std::memory_order_acquire))
      continue;
    request.error = state_->snapshot.read(request.sector, request.piece);
    request.state.store(world::Request::ready, std::memory_order_release);
    return true;
  }
  return false;
}

Result<StreamReport> WorldStream::bring_in(std::span<const CullView> views, const StreamOptions& options) {
  if (const Status sound = check_stream(views, options); !sound) return sound;
  state_->snapshot.begin_turn();
  StreamOptions touched = options;
  touched.ahead = 0;
  for (;;) {
    const StreamReport report = state_->update(views, touched, state_->requests.size());
    bool worked = false;
    while (work()) worked = true;
    // Others may be at work on what is missing.
    if (!worked && report.coming == 0) return report;
  }
}

Result<World> load(std::span<const std::byte> bytes) {
  Result<world::SnapshotDirectory> directory = world::read_directory(bytes);
  if (!directory) return directory.error();
  World loaded;
  world::SnapshotWorld snapshot;
  snapshot.begin(*std::move(directory), loaded);
  for (std::size_t i = 0; i < snapshot.directory().sectors.size(); ++i) {
    world::SectorPiece piece;
    snapshot.begin_turn();
    Status sound = snapshot.read(i, piece);
    if (sound) sound = snapshot.put_in(i, piece);
    if (!sound) return sound;
  }
  return loaded;
}

}  // namespace sightline
