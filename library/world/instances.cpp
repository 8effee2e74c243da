// Where instances of worlds are.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "library/geometry/box_reader.hpp"
#include "library/geometry/linear.hpp"
#include "library/geometry/rounding.hpp"
#include "library/world/free_list.hpp"
#include "library/world/instances_state.hpp"

namespace sightline {

namespace world {

using namespace geometry;

namespace {

using Placements = Strided<const InstancePlacement>;

// The box about `at` moved there, rounded outwards.
WorldBox wide_box(const Box& b, const WorldPoint& at) {
  return {{sum_down(at.x, b.min.x), sum_down(at.y, b.min.y), sum_down(at.z, b.min.z)},
          {sum_up(at.x, b.max.x), sum_up(at.y, b.max.y), sum_up(at.z, b.max.z)}};
}

WorldBox united(const WorldBox& a, const WorldBox& b) {
  return {{std::min(a.min.x, b.min.x), std::min(a.min.y, b.min.y), std::min(a.min.z, b.min.z)},
          {std::max(a.max.x, b.max.x), std::max(a.max.y, b.max.y), std::max(a.max.z, b.max.z)}};
}

// Of what the matrix places of the bounds, the extent along an axis about the placement's origin.
struct Extent {
  double low = 0, high = 0;
};
Extent extent_along(const Mat4& matrix, const WorldBounds& bounds, std::size_t axis) {
  const double at = matrix.m[12 + axis];
  Extent out{at, at};
  if (bounds.empty) return out;
  const std::array lows{bounds.box.min.x, bounds.box.min.y, bounds.box.min.z},
      highs{bounds.box.max.x, bounds.box.max.y, bounds.box.max.z};
  double magnitude = std::fabs(at);
  for (std::size_t c = 0; c < 3; ++c) {
    const double factor = matrix.m[4 * c + axis], one = factor * lows[c], other = factor * highs[c];
    out.low += std::min(one, other), out.high += std::max(one, other);
    magnitude += std::max(std::fabs(one), std::fabs(other));
  }
  // Three products and three sums, each off by 2^-53 of what adds up.
  const double slack = 0x1p-50 * magnitude;
  return {out.low - slack, out.high + slack};
}

WorldBox placed_box(const InstancePlacement& placement, const WorldBounds& bounds) {
  const WorldPoint& o = placement.origin;
  const Extent x = extent_along(placement.transform, bounds, 0),
               y = extent_along(placement.transform, bounds, 1),
               z = extent_along(placement.transform, bounds, 2);
  return {{sum_down(o.x, x.low), sum_down(o.y, y.low), sum_down(o.z, z.low)},
          {sum_up(o.x, x.high), sum_up(o.y, y.high), sum_up(o.z, z.high)}};
}

// Whether columns are as long as each other and at right angles, to a part in 10⁴, and turn right.
bool is_similarity(const Mat4& matrix) {
  const auto& m = matrix.m;
  for (const float value : m)
    if (!std::isfinite(value)) return false;
  if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) return false;
  const glm::dmat3 turn(to_double(matrix));
  const double squared = glm::dot(turn[0], turn[0]);
  if (!(squared >= 0.999e-12 && squared <= 1.001e12)) return false;
  const glm::dmat3 product = glm::transpose(turn) * turn;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) {
      if (std::fabs(product[c][r] - (c == r ? squared : 0)) > 2e-4 * squared) return false;
    }
  }
  return glm::determinant(turn) > 0;
}

Status check_placement(const InstancesState& s, const InstancePlacement& p, std::size_t index) {
  if (p.world >= s.worlds.size() || !s.worlds[p.world].world)
    return {StatusCode::bad_argument, "instances: a placement's world is none that was added", index};
  if (!is_similarity(p.transform))
    return {StatusCode::bad_argument,
            "instances: a transform is not sound, expected a rotation, a uniform scale and a translation",
            index};
  if (!in_reach(p.origin))
    return {StatusCode::bad_argument, "instances: an origin is out of range, expected within 1e11 m of 0",
            index};
  return {};
}

constexpr const char* kOutOfReach =
    "instances: what is placed reaches out of range, expected within 1e11 m of 0";

// What the caller's memory says now, and the boxes of that; or why there are none.
struct Placing {
  std::vector<InstancePlacement> placements;
  std::vector<WorldBox> boxes;
};
Status read_placements(const InstancesState& s, const Placements& placements, Placing& out) {
  if (!placements.sound())
    return {StatusCode::bad_argument, "instances: the placements' pointer is null or their stride too short"};
  out.placements.reserve(placements.size()), out.boxes.reserve(placements.size());
  for (std::size_t i = 0; i < placements.size(); ++i) {
    const InstancePlacement p = placements[i];
    if (const Status sound = check_placement(s, p, i); !sound) return sound;
    out.placements.push_back(p);
    out.boxes.push_back(placed_box(p, s.worlds[p.world].bounds));
    if (!is_valid(out.boxes.back())) return {StatusCode::bad_box, kOutOfReach, i};
  }
  return {};
}

}  // namespace

WorldBounds bounds_of(const WorldState& world) noexcept {
  WorldBounds out;
  for (const Sector& sector : world.sectors) {
    if (!sector.map || sector.map->size() == 0) continue;
    const WorldBox box = wide_box(sector.bounds, sector.origin);
    out.box = out.empty ? box : united(out.box, box);
    out.empty = false;
  }
  return out;
}

double scale_of(const InstancePlacement& placement) noexcept {
  return std::cbrt(glm::determinant(glm::dmat3(to_double(placement.transform))));
}

}  // namespace world

using world::InstancesState;
using world::PlacedWorld;

Instances::Instances() : state_(new State) {}
Instances::~Instances() {
  delete state_;
}
Instances::Instances(Instances&& other) noexcept : state_(std::exchange(other.state_, nullptr)) {}
Instances& Instances::operator=(Instances&& other) noexcept {
  std::swap(state_, other.state_);
  return *this;
}

Result<PlacedWorldId> Instances::add_world(const World& world) {
  constexpr std::size_t kMostWorlds = std::size_t{1} << 31;
  if (state_->worlds.size() >= kMostWorlds)
    return Status(StatusCode::too_many, "instances: they cannot show more than 2^31 worlds");
  const std::uint32_t name = world::take_element(state_->worlds, state_->free_names);
  state_->worlds[name] = {&world, world::bounds_of(WorldAccess::state(world)), 0};
  return name;
}

Status Instances::remove_world(PlacedWorldId world) {
  if (!this->world(world)) return {StatusCode::bad_argument, "instances: there is no world of this name"};
  if (state_->worlds[world].instances > 0)
    return {StatusCode::bad_argument, "instances: a world cannot be removed while an instance shows it"};
  state_->worlds[world] = {};
  state_->free_names.push_back(world);
  return {};
}

Status Instances::update() {
  InstancesState& s = *state_;
  std::vector<PlacedWorld> now = s.worlds;
  for (PlacedWorld& placed : now)
    if (placed.world) placed.bounds = world::bounds_of(WorldAccess::state(*placed.world));
  std::vector<Handle> handles;
  std::vector<WorldBox> boxes;
  for (std::size_t id = 0; id < s.placements.size(); ++id) {
    const Handle handle = s.boxes.handle(static_cast<ObjectId>(id));
    const InstancePlacement& p = s.placements[id];
    if (!s.boxes.contains(handle) || now[p.world].bounds == s.worlds[p.world].bounds) continue;
    handles.push_back(handle);
    boxes.push_back(world::placed_box(p, now[p.world].bounds));
    if (!geometry::is_valid(boxes.back())) return {StatusCode::bad_box, world::kOutOfReach, id};
  }
  if (const Status moved = s.boxes.move(handles, boxes); !moved) return moved;
  s.worlds = std::move(now);
  return {};
}

Status Instances::insert(Strided<const InstancePlacement> placements, Strided<Handle> handles,
                         Strided<const std::uint32_t> layers) {
  InstancesState& s = *state_;
  world::Placing placing;
  if (const Status sound = world::read_placements(s, placements, placing); !sound) return sound;
  if (const Status in = s.boxes.insert(placing.boxes, handles, {.layers = layers}); !in) return in;
  s.placements.resize(s.boxes.id_limit());
  for (std::size_t i = 0; i < handles.size(); ++i) {
    const InstancePlacement& p = placing.placements[i];
    s.placements[handles[i].index] = p;
    ++s.worlds[p.world].instances;
  }
  return {};
}

Status Instances::move(Strided<const Handle> handles, Strided<const InstancePlacement> placements) {
  InstancesState& s = *state_;
  world::Placing placing;
  if (const Status sound = world::read_placements(s, placements, placing); !sound) return sound;
  if (const Status moved = s.boxes.move(handles, placing.boxes); !moved) return moved;
  for (std::size_t i = 0; i < handles.size(); ++i) {
    InstancePlacement& p = s.placements[handles[i].index];
    --s.worlds[p.world].instances;
    p = placing.placements[i];
    ++s.worlds[p.world].instances;
  }
  return {};
}

Status Instances::remove(Strided<const Handle> handles) {
  if (const Status gone = state_->boxes.remove(handles); !gone) return gone;
  for (std::size_t i = 0; i < handles.size(); ++i)
    --state_->worlds[state_->placements[handles[i].index].world].instances;
  return {};
}

Status Instances::set_layers(Strided<const Handle> handles, Strided<const std::uint32_t> layers) {
  return state_->boxes.set_layers(handles, layers);
}

bool Instances::contains(Handle handle) const noexcept {
  return state_->boxes.contains(handle);
}

InstancePlacement Instances::placement(Handle handle) const noexcept {
  return contains(handle) ? state_->placements[handle.index] : InstancePlacement{};
}

WorldBox Instances::box(Handle handle) const noexcept {
  return state_->boxes.box(handle);
}

Handle Instances::handle(ObjectId id) const noexcept {
  return state_->boxes.handle(id);
}

const World* Instances::world(PlacedWorldId world) const noexcept {
  return world < state_->worlds.size() ? state_->worlds[world].world : nullptr;
}

std::size_t Instances::size() const noexcept {
  return state_->boxes.size();
}
std::size_t Instances::id_limit() const noexcept {
  return state_->boxes.id_limit();
}

std::uint64_t Instances::objects() const noexcept {
  std::uint64_t sum = 0;
  for (const PlacedWorld& placed : state_->worlds)
    if (placed.world) sum += std::uint64_t{placed.instances} * placed.world->size();
  return sum;
}

}  // namespace sightline
