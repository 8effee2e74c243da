// What a cull did: its walk once more, and each test by itself.
#include <sightline/inspect.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "library/geometry/box_reader.hpp"
#include "library/geometry/linear.hpp"
#include "library/world/begin_cull-inl.hpp"
#include "library/world/culler_state.hpp"
#include "library/world/inspect_pass.hpp"
#include "library/world/occluder_picks.hpp"

namespace sightline {

namespace world {

namespace {

struct InspectorState {
  CullerState inner;
  std::vector<CullView> views;  // with what the culler drew
  std::vector<ViewStats> stats;
  std::vector<DebugBox> boxes;
};

// What the last cull with automatic occlusion drew for the view at this place; null: nothing.
const OccluderPicks* drawn_at(const Culler& culler, std::size_t place) {
  const Hiding* hiding = CullerAccess::state(culler).hiding.get();
  return hiding && place < kMaxViews ? hiding->drawn(place) : nullptr;
}
// The same, where it was for this view.
const OccluderPicks* drawn_for(const Culler& culler, std::size_t place, const WorldView& view) {
  const OccluderPicks* picks = drawn_at(culler, place);
  return picks && picks->buffer().view() == view ? picks : nullptr;
}

void look_at_sectors(InspectorState& state, std::span<const CullView> views) {
  std::array<SectorTest, kMaxViews> tests;
  for (std::size_t v = 0; v < views.size(); ++v) tests[v] = SectorTest(views[v].view);
  for (const Sector& sector : state.inner.world->sectors) {
    if (!sector.map) continue;
    DebugBox box{geometry::world_box(sector.bounds, sector.origin), DebugBoxKind::sector, 0, 0,
                 static_cast<std::uint32_t>(sector.map->size())};
    for (std::size_t v = 0; v < views.size(); ++v) {
      const bool seen = !tests[v].misses(sector.origin, sector.bounds);
      ++state.stats[v].sectors, state.stats[v].sectors_in_view += seen;
      box.seen |= static_cast<std::uint8_t>(seen << v);
    }
    state.boxes.push_back(box);
  }
}

void look_at_chunks(InspectorState& state, const GroupEntry& entry, const DifferentViews& different,
                    std::span<ViewStats> stats) {
  const CullerState& inner = state.inner;
  const ChunkMap& map = *inner.maps[entry.sector];
  const ChunkMap::Group& group = map.groups()[entry.group];
  std::array<ChunkSight, kMaxViews> sights;
  for (std::size_t d = 0; d < different.count; ++d)
    if (entry.planes[d] != kOutside)
      sights[d] = inspect_group(inner.input, inner.world->columns, entry, d, stats[d]);
  for (std::uint32_t i = 0; i < group.count; ++i) {
    const ChunkMap::ChunkView chunk = map.chunk(group, i);
    const auto holes = std::count(chunk.objects, chunk.objects + chunk.count, kNoObject);
    DebugBox box{geometry::world_box(map.chunk_bounds(group.chunks[i]), inner.origins[entry.sector]),
                 DebugBoxKind::chunk, 0, 0, chunk.count - static_cast<std::uint32_t>(holes)};
    for (std::size_t d = 0; d < different.count; ++d) {
      if (sights[d].seen >> i & 1) box.seen |= different.bits[d];
      if (sights[d].whole >> i & 1) box.whole |= different.bits[d];
    }
    state.boxes.push_back(box);
  }
}

void look_at_occluders(InspectorState& state, std::span<const CullView> views, const Culler& culler) {
  const WorldState& world = *state.inner.world;
  const std::size_t first = state.boxes.size();
  for (std::size_t v = 0; v < views.size(); ++v) {
    const OccluderPicks* picks = drawn_for(culler, v, views[v].view);
    if (!picks) continue;
    for (const ObjectId id : picks->drawn()) {
      if (id >= world.objects.size() || world.objects[id].sector == ChunkMap::kNone) continue;
      const auto known = std::find_if(state.boxes.begin() + static_cast<std::ptrdiff_t>(first),
                                      state.boxes.end(), [&](const DebugBox& b) { return b.objects == id; });
      DebugBox& box =
          known != state.boxes.end()
              ? *known
              : state.boxes.emplace_back(DebugBox{stored_box(world, id), DebugBoxKind::occluder, 0, 0, id});
      box.seen |= static_cast<std::uint8_t>(1u << v);
    }
  }
}

}  // namespace

}  // namespace world

struct CullInspector::State : world::InspectorState {};

CullInspector::CullInspector() : state_(new State) {}
CullInspector::~CullInspector() {
  delete state_;
}
CullInspector::CullInspector(CullInspector&& other) noexcept : state_(std::exchange(other.state_, nullptr)) {}
CullInspector& CullInspector::operator=(CullInspector&& other) noexcept {
  std::swap(state_, other.state_);
  return *this;
}

Result<Inspection> CullInspector::inspect(const World& world, std::span<const CullView> views,
                                          const Culler* culler) {
  if (const Status sound = world::check_views(views, {}, {}); !sound) return sound;
  world::InspectorState& state = *state_;
  state.views.assign(views.begin(), views.end());
  for (std::size_t v = 0; v < views.size() && culler; ++v) {
    const world::OccluderPicks* picks = world::drawn_for(*culler, v, views[v].view);
    if (picks && !views[v].occlusion) state.views[v].occlusion = &picks->buffer();
  }
  CullResult found;
  const world::DifferentViews different = world::begin_cull(state.inner, world, state.views, found);
  state.stats.assign(views.size(), {});
  state.boxes.clear();
  world::look_at_sectors(state, state.views);
  std::array<ViewStats, kMaxViews> of_different;
  for (const world::GroupEntry& entry : state.inner.entries)
    world::look_at_chunks(state, entry, different, of_different);
  for (std::size_t d = 0; d < different.count; ++d) {
    for (std::size_t v = 0; v < views.size(); ++v) {
      if ((different.bits[d] >> v & 1) == 0) continue;
      of_different[d].sectors = state.stats[v].sectors;
      of_different[d].sectors_in_view = state.stats[v].sectors_in_view;
      state.stats[v] = of_different[d];
    }
  }
  if (culler) world::look_at_occluders(state, state.views, *culler);
  return Inspection{state.stats, state.boxes};
}

Result<std::array<WorldPoint, 8>> view_corners(const WorldView& view, double farthest) noexcept {
  using namespace geometry;
  if (const Status sound = check(view); !sound) return sound;
  const glm::dmat4 from_clip = glm::inverse(to_double(view.view.eye_to_clip)),
                   from_eye = glm::inverse(to_double(view.view.world_to_eye));
  // Along each edge of the frustum, where it begins and where it would end: depth 1 may be either.
  std::array<WorldPoint, 8> corners;
  for (int c = 0; c < 4; ++c) {
    const auto at = [&](double depth) {
      return from_clip * glm::dvec4(c & 1 ? 1 : -1, c & 2 ? 1 : -1, depth, 1);
    };
    const auto distance = [](const glm::dvec4& p) {
      return p.w > 0 ? -p.z / p.w : std::numeric_limits<double>::infinity();
    };
    glm::dvec4 near = at(0), far = at(1);
    if (distance(far) < distance(near)) std::swap(near, far);
    const double begins = distance(near);
    if (!(farthest > begins))
      return Status(StatusCode::bad_argument, "view: its farthest distance is not beyond its near plane");
    const glm::dvec3 from = glm::dvec3(near) / near.w;
    // The point at infinity is a direction.
    const glm::dvec3 along = far.w > 0 ? glm::dvec3(far) / far.w - from : glm::dvec3(far);
    const double ends = std::min(distance(far), farthest);
    if (!std::isfinite(ends))
      return Status(StatusCode::bad_argument,
                    "view: it has no far plane, expected a farthest distance that is finite");
    const double length = (ends - begins) / -along.z;
    const auto set = [&](std::size_t i, const glm::dvec3& eye) {
      const glm::dvec4 p = from_eye * glm::dvec4(eye, 1);
      corners[i] = {view.origin.x + p.x, view.origin.y + p.y, view.origin.z + p.z};
    };
    set(static_cast<std::size_t>(c), from), set(static_cast<std::size_t>(c) + 4, from + length * along);
  }
  return corners;
}

Status depth_image(const OcclusionBuffer& buffer, std::span<std::uint8_t> pixels) {
  if (!buffer.begun()) return {StatusCode::stale_buffer, "depth image: the buffer was never begun"};
  const View& view = buffer.view().view;
  const std::size_t count = std::size_t{view.width} * view.height;
  if (pixels.size() < count)
    return {StatusCode::buffer_too_small, "depth image: expected a byte a pixel of the buffer's view"};
  std::vector<float> nearness(count);
  if (const Status read = buffer.read_nearness(nearness); !read) return read;
  const bool orthographic = is_orthographic(view);
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (float& n : nearness) {
    if (n == -std::numeric_limits<float>::infinity()) continue;
    if (!orthographic) n = std::log(std::max(n, 1e-30f));
    low = std::min(low, n), high = std::max(high, n);
  }
  const float scale = high > low ? 200 / (high - low) : 0;
  for (std::size_t i = 0; i < count; ++i) {
    const bool none = nearness[i] == -std::numeric_limits<float>::infinity();
    pixels[i] = none ? std::uint8_t{0} : static_cast<std::uint8_t>(255.5f - scale * (high - nearness[i]));
  }
  return {};
}

Status depth_image(const Culler& culler, std::size_t place, std::span<std::uint8_t> pixels) {
  const world::OccluderPicks* picks = world::drawn_at(culler, place);
  if (!picks)
    return {StatusCode::stale_buffer, "depth image: the culler has drawn no occluders for that view"};
  return depth_image(picks->buffer(), pixels);
}

}  // namespace sightline
