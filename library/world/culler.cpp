// Culling a world: the regions and groups are sorted here, one by one; what is left goes to the SIMD passes,
// in as many jobs as the caller has threads.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include <sightline/culling.hpp>
#include <sightline/occlusion.hpp>
#include <sightline/projection.hpp>

#include "library/geometry/linear.hpp"
#include "library/world/sector_test.hpp"
#include "library/world/world_cull.hpp"
#include "library/world/world_state.hpp"

namespace sightline {

namespace world {

using namespace geometry;

struct Job {
  std::size_t first_entry = 0, entries = 0;
  std::size_t first_output = 0;
  PassCounts counts;
};

struct CullerState {
  std::vector<const ChunkMap*> maps;  // of the sectors that some view may see
  std::vector<SectorView> views;      // of these
  std::vector<GroupEntry> entries;
  std::array<Job, kMaxJobs> jobs;
  /// The plane that failed last, one a view and region: the next frame tries it first.
  std::vector<std::vector<std::uint8_t>> failed;  // by the world's sector
  std::array<SectorTest, kMaxViews> tests;

  PassInput input;
  ObjectId* out = nullptr;
  std::uint8_t* masks = nullptr;
};

namespace {

std::uint8_t side_along(float normal, std::uint8_t axis, bool far) {
  return static_cast<std::uint8_t>(axis + ((normal >= 0) != far ? 3 : 0));
}

SectorView sector_view(const WorldView& view, const Sector& sector, const CullOptions& options,
                       const OcclusionBuffer* occlusion) {
  SectorView out;
  const glm::dvec3 offset(sector.origin.x - view.origin.x, sector.origin.y - view.origin.y,
                          sector.origin.z - view.origin.z);
  glm::dmat4 moved(1.0);
  moved[3] = glm::dvec4(offset, 1.0);
  const glm::dmat4 to_eye = to_double(view.view.world_to_eye) * moved;
  const glm::dmat4 clip = to_double(view.view.eye_to_clip) * to_eye;
  out.frustum = frustum_of(clip, view_direction(view.view), sector.map->nodes()[0].bounds);
  for (std::size_t p = 0; p < Frustum::sides; ++p) {
    const Vec3& n = out.frustum.planes[p].normal;
    out.near_side[p] = {side_along(n.x, 0, false), side_along(n.y, 1, false), side_along(n.z, 2, false)};
    out.far_side[p] = {side_along(n.x, 0, true), side_along(n.y, 1, true), side_along(n.z, 2, true)};
  }
  out.eye = to_vec3(glm::dvec3(glm::inverse(to_eye)[3]));
  if (options.min_area > 0) {
    const Projector projector = make_projector(view.view, {});
    out.orthographic = projector.orthographic;
    out.area_scale = std::numbers::pi_v<float> * projector.pixels_per_metre * projector.pixels_per_metre /
                     options.min_area;
  }
  if (occlusion) {
    out.occluders = &occlusion->tiles();
    out.projection = occlusion::eye_projection(occlusion->tiles().view, sector.origin);
  }
  return out;
}

// The planes among `planes` that the box crosses, or kOutside; `failed` is tried first, and remembers.
PlaneSet classify(const Frustum& frustum, const Box& box, PlaneSet planes, std::uint8_t& failed) {
  const auto far_enough = [&](int p, bool far) {
    const Plane& plane = frustum.planes[static_cast<std::size_t>(p)];
    const bool x = (plane.normal.x >= 0) != far, y = (plane.normal.y >= 0) != far,
               z = (plane.normal.z >= 0) != far;
    return signed_distance(plane, x ? box.max.x : box.min.x, y ? box.max.y : box.min.y,
                           z ? box.max.z : box.min.z) >= 0;
  };
  if ((planes >> failed & 1) && !far_enough(failed, false)) return kOutside;
  PlaneSet crossing = 0;
  for (std::uint32_t rest = planes; rest != 0; rest &= rest - 1) {
    const int p = std::countr_zero(rest);
    if (!far_enough(p, false)) {
      failed = static_cast<std::uint8_t>(p);
      return kOutside;
    }
    if (!far_enough(p, true)) crossing |= static_cast<PlaneSet>(1u << p);
  }
  return crossing;
}

using ViewPlanes = std::array<PlaneSet, kMaxViews>;

// The region tree of one sector, depth first.
class RegionWalk {
public:
  /// `sector` counts the sectors that some view may see, `failed` is the sector's.
  RegionWalk(CullerState& state, std::uint32_t sector, std::size_t views, std::uint8_t* failed) noexcept
      : state_(state), sector_(sector), views_(views), failed_(failed), map_(*state.maps[sector]) {}

  std::uint64_t run() noexcept {
    ViewPlanes all{};
    all.fill(kAllPlanes);
    visit(0, all);
    return visited_;
  }

private:
  bool narrow(const Box& box, ViewPlanes& planes, std::uint8_t* failed) const noexcept {
    bool any = false;
    for (std::size_t v = 0; v < views_; ++v) {
      if (planes[v] == kOutside) continue;
      if (planes[v] != 0) {
        const Frustum& frustum = state_.views[sector_ * views_ + v].frustum;
        planes[v] = classify(frustum, box, planes[v], failed[v]);
      }
      any = any || planes[v] != kOutside;
    }
    return any;
  }

  void visit(std::uint32_t index, ViewPlanes planes) noexcept {
    const ChunkMap::Node& node = map_.nodes()[index];
    ++visited_;
    std::uint8_t* failed = failed_ + index * kMaxViews;
    if (node.objects == 0 || !narrow(node.bounds, planes, failed)) return;
    visited_ += node.groups.size();
    find_groups(node, std::span(state_.views).subspan(sector_ * views_, views_), planes, sector_,
                state_.entries);
    if (node.first_child == ChunkMap::kNone) return;
    for (std::uint32_t i = 0; i < 4; ++i) visit(node.first_child + i, planes);
  }

  CullerState& state_;
  std::uint32_t sector_;
  std::size_t views_;
  std::uint8_t* failed_;
  const ChunkMap& map_;
  std::uint64_t visited_ = 0;
};

void run_job(void* data, std::uint32_t index) {
  auto& state = *static_cast<CullerState*>(data);
  Job& job = state.jobs[index];
  const auto entries = std::span(state.entries).subspan(job.first_entry, job.entries);
  job.counts = cull_groups(state.input, entries, state.out + job.first_output,
                           state.masks ? state.masks + job.first_output : nullptr);
}

// Parts of about equally many objects; each writes to where it would stand if all were visible.
std::uint32_t split_work(CullerState& state, std::uint32_t threads) {
  const auto objects_of = [&](const GroupEntry& e) {
    return state.maps[e.sector]->groups()[e.group].objects;
  };
  std::size_t total = 0;
  for (const GroupEntry& entry : state.entries) total += objects_of(entry);
  std::uint32_t jobs = 0;
  std::size_t before = 0;
  for (std::size_t e = 0; e < state.entries.size(); ++e) {
    if (jobs == 0 || (jobs < threads && before >= total * jobs / threads)) {
      state.jobs[jobs] = {e, 0, before + jobs * kCullPadding, {}};
      ++jobs;
    }
    ++state.jobs[jobs - 1].entries;
    before += objects_of(state.entries[e]);
  }
  return jobs;
}

// Views that are the same are culled once.
struct DifferentViews {
  std::size_t count = 0;
  std::array<std::uint8_t, kMaxViews> first{};  // which of the caller's views
  std::array<std::uint8_t, kMaxViews> bits{};   // of all that are the same
};

DifferentViews different_views(std::span<const WorldView> views, const CullOptions& options) noexcept {
  DifferentViews out;
  const auto same = [&](std::size_t a, std::size_t b) {
    return views[a] == views[b] &&
           (options.occlusion.empty() || options.occlusion[a] == options.occlusion[b]);
  };
  for (std::size_t v = 0; v < views.size(); ++v) {
    std::size_t d = 0;
    while (d < out.count && !same(out.first[d], v)) ++d;
    if (d == out.count) out.first[out.count++] = static_cast<std::uint8_t>(v);
    out.bits[d] |= static_cast<std::uint8_t>(1u << v);
  }
  return out;
}

// Sorts the sectors: adds to the state those that some view may see, and their groups. Returns how many
// regions and groups it looked at.
std::uint64_t find_entries(CullerState& state, const World& world, std::span<const WorldView> views,
                           const DifferentViews& different, const CullOptions& options) {
  const auto& sectors = world.state().sectors;
  const auto of_different = std::span(different.first).first(different.count);
  state.maps.clear(), state.views.clear(), state.entries.clear();
  for (std::size_t d = 0; d < different.count; ++d) state.tests[d] = SectorTest(views[of_different[d]]);
  // Room for all sectors, so that a camera that turns allocates nothing.
  state.maps.reserve(sectors.size());
  state.views.reserve(sectors.size() * different.count);
  for (std::size_t s = state.failed.size(); s < sectors.size(); ++s) {
    state.failed.emplace_back();
    if (sectors[s].map) state.failed[s].resize(sectors[s].map->nodes().size() * kMaxViews, 0);
  }
  std::uint64_t visited = 0;
  for (std::size_t s = 0; s < sectors.size(); ++s) {
    const Sector& sector = sectors[s];
    if (!sector.map) continue;
    bool missed = true;
    for (std::size_t d = 0; d < different.count && missed; ++d)
      missed = state.tests[d].misses(sector.origin, sector.bounds);
    if (missed) {
      ++visited;  // its root: that is what the walk would have looked at
      continue;
    }
    const auto kept = static_cast<std::uint32_t>(state.maps.size());
    state.maps.push_back(sector.map.get());
    for (const std::uint8_t v : of_different) {
      const OcclusionBuffer* occlusion = options.occlusion.empty() ? nullptr : options.occlusion[v];
      state.views.push_back(sector_view(views[v], sector, options, occlusion));
    }
    state.failed[s].resize(sector.map->nodes().size() * kMaxViews, 0);
    visited += RegionWalk(state, kept, different.count, state.failed[s].data()).run();
  }
  return visited;
}

// Moves what the jobs wrote together, and adds their counts to the result.
void join_outputs(const CullerState& state, std::uint32_t jobs, CullResult& result) {
  for (const Job& job : std::span(state.jobs).first(jobs)) {
    if (job.first_output != result.count) {
      std::memmove(state.out + result.count, state.out + job.first_output,
                   job.counts.written * sizeof(ObjectId));
      if (state.masks)
        std::memmove(state.masks + result.count, state.masks + job.first_output, job.counts.written);
    }
    result.count += job.counts.written;
    result.tested += job.counts.tested;
    result.nodes_visited += job.counts.chunks;
    result.culled_occlusion += job.counts.occluded;
  }
}

CullError check_call(const World& world, std::span<const WorldView> views, const CullOptions& options,
                     std::span<ObjectId> visible, std::span<std::uint8_t> masks) noexcept {
  if (views.empty() || views.size() > kMaxViews) return CullError::views;
  if (!(options.min_area >= 0) || !std::isfinite(options.min_area)) return CullError::options;
  if (!options.occlusion.empty() && options.occlusion.size() != views.size()) return CullError::options;
  for (const OcclusionBuffer* buffer : options.occlusion) {
    if (buffer && buffer->width() == 0) return CullError::options;  // begin() was never called
  }
  if (options.jobs.threads < 1 || options.jobs.threads > kMaxJobs) return CullError::options;
  const std::size_t needed = cull_capacity(world, options);
  if (visible.size() < needed || (!masks.empty() && masks.size() < needed)) return CullError::buffer;
  for (const WorldView& view : views) {
    const WorldPoint& o = view.origin;
    const bool near =
        std::fabs(o.x) <= kWorldReach && std::fabs(o.y) <= kWorldReach && std::fabs(o.z) <= kWorldReach;
    if (!near || sightline::check(view.view)) return CullError::view;
  }
  return CullError::none;
}

}  // namespace
}  // namespace world

std::size_t cull_capacity(const World& world, const CullOptions& options) noexcept {
  return world.size() + kCullPadding * std::max(options.jobs.threads, 1u);
}

Culler::Culler() : state_(std::make_unique<world::CullerState>()) {}
Culler::~Culler() = default;
Culler::Culler(Culler&&) noexcept = default;
Culler& Culler::operator=(Culler&&) noexcept = default;

CullResult Culler::cull(const World& world, std::span<const WorldView> views, const CullOptions& options,
                        std::span<ObjectId> visible, std::span<std::uint8_t> masks) noexcept {
  CullResult result;
  result.error = world::check_call(world, views, options, visible, masks);
  if (result.error != CullError::none) return result;

  world::CullerState& state = *state_;
  const world::DifferentViews different = world::different_views(views, options);
  result.nodes_visited = world::find_entries(state, world, views, different, options);
  state.input = {state.maps, state.views, different.count, different.bits};
  state.out = visible.data();
  state.masks = masks.empty() ? nullptr : masks.data();
  const std::uint32_t threads = options.jobs.run ? options.jobs.threads : 1;
  const std::uint32_t jobs = world::split_work(state, threads);
  if (jobs > 1) {
    options.jobs.run(options.jobs.user, jobs, world::run_job, &state);
  } else if (jobs == 1) {
    world::run_job(&state, 0);
  }
  world::join_outputs(state, jobs, result);
  return result;
}

CullResult cull(World& world, std::span<const WorldView> views, const CullOptions& options,
                std::span<ObjectId> visible, std::span<std::uint8_t> masks) noexcept {
  return world.state().culler.cull(world, views, options, visible, masks);
}

}  // namespace sightline
