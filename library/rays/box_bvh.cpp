// The public hierarchy: boxes checked and rounded, rays prepared, the wide tree asked.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include <sightline/boxes.hpp>
#include <sightline/rays.hpp>

#include "library/geometry/box_reader.hpp"
#include "library/geometry/linear.hpp"
#include "library/rays/wide_rays.hpp"

namespace sightline {

struct BoxBvh::State {
  rays::WideBvh tree;
  WorldPoint origin;
  Boxes boxes;
  std::vector<rays::WideStack> stacks{1};
  std::vector<PreparedRay> prepared;
  std::vector<std::uint32_t> order;
  std::vector<float> distances;
  rays::RayGrid grid;
  rays::RayHits hits;
  std::vector<std::uint8_t> seen;
};

namespace {

using geometry::kBlock;

// Rounds all boxes to `out`, which has their size already.
Status take(const BoxView& boxes, const WorldPoint& origin, Boxes& out) {
  std::array<WorldBox, kBlock> block;
  for (std::size_t first = 0; first < boxes.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, boxes.size() - first);
    BoxReader::read(boxes, first, count, block.data(), true);
    for (std::size_t i = 0; i < count; ++i) {
      if (!geometry::is_valid(block[i]))
        return {StatusCode::bad_box, "rays: a box is not valid, expected min <= max within 1e11 m of 0",
                first + i};
      out.set(first + i, geometry::relative_box(block[i], origin));
    }
  }
  return {};
}

Status check_jobs(const JobSystem& jobs) {
  if (jobs.threads < 1 || jobs.threads > kMaxJobs)
    return {StatusCode::bad_argument, "rays: expected 1 to 64 jobs"};
  return {};
}

// A ray without a direction or with a coordinate that is no number ends before it begins: it misses.
PreparedRay prepared(const Ray& ray) {
  const Vec3& d = ray.direction;
  const bool sound = geometry::is_finite(ray.origin) && geometry::is_finite(d) && ray.max_distance >= 0 &&
                     (d.x != 0 || d.y != 0 || d.z != 0);
  return PreparedRay(sound ? ray : Ray{{}, {1, 0, 0}, -1});
}

}  // namespace

BoxBvh::BoxBvh() : state_(new State) {}
BoxBvh::~BoxBvh() {
  delete state_;
}
BoxBvh::BoxBvh(BoxBvh&& other) noexcept : state_(std::exchange(other.state_, nullptr)) {}
BoxBvh& BoxBvh::operator=(BoxBvh&& other) noexcept {
  std::swap(state_, other.state_);
  return *this;
}

Status BoxBvh::build(const BoxView& boxes, const WorldPoint& origin) {
  if (!boxes.sound())
    return {StatusCode::bad_argument, "rays: a box's pointer is null or its stride too short"};
  if (boxes.size() > std::size_t{1} << 30) return {StatusCode::too_many, "rays: expected at most 2^30 boxes"};
  if (!geometry::in_reach(origin))
    return {StatusCode::bad_argument, "rays: the origin is out of range, expected within 1e11 m of 0"};
  Boxes taken;
  taken.resize(boxes.size());
  if (const Status sound = take(boxes, origin, taken); !sound) return sound;
  state_->tree.build(taken);
  state_->boxes = std::move(taken);
  state_->origin = origin;
  return {};
}

Status BoxBvh::refit(const BoxView& boxes) {
  if (!boxes.sound())
    return {StatusCode::bad_argument, "rays: a box's pointer is null or its stride too short"};
  if (boxes.size() != size())
    return {StatusCode::bad_argument, "rays: expected as many boxes as the hierarchy was built with"};
  // On refusal what was overwritten is never read: the next refit overwrites all of it again.
  if (const Status sound = take(boxes, state_->origin, state_->boxes); !sound) return sound;
  state_->tree.refit(state_->boxes);
  return {};
}

std::size_t BoxBvh::size() const noexcept {
  return state_->tree.size();
}

Status BoxBvh::cast(std::span<const Ray> rays, std::span<ObjectId> objects, std::span<float> distances,
                    const JobSystem& jobs) {
  if (const Status sound = check_jobs(jobs); !sound) return sound;
  if (rays.size() >= kNoObject) return {StatusCode::bad_argument, "rays: expected fewer than 2^32 - 1 rays"};
  if (objects.size() < rays.size() || (!distances.empty() && distances.size() < rays.size()))
    return {StatusCode::buffer_too_small, "rays: expected room for one answer a ray"};
  State& s = *state_;
  s.prepared.clear();
  for (const Ray& ray : rays) s.prepared.push_back(prepared(ray));
  const std::size_t known = s.order.size();
  if (known < rays.size()) {
    s.order.resize(rays.size());
    std::iota(s.order.begin() + static_cast<std::ptrdiff_t>(known), s.order.end(),
              static_cast<std::uint32_t>(known));
  }
  if (distances.empty()) {
    if (s.distances.size() < rays.size()) s.distances.resize(rays.size());
    distances = s.distances;
  }
  if (s.stacks.size() < jobs.threads) s.stacks.resize(jobs.threads);
  rays::RayStats stats;
  cast_wide(s.tree, s.prepared, std::span(s.order).first(rays.size()), jobs, s.stacks, objects, distances,
            stats);
  return {};
}

Result<std::size_t> BoxBvh::visible_set(const WorldView& view, std::uint32_t columns, std::uint32_t rows,
                                        std::span<ObjectId> visible, const JobSystem& jobs) {
  constexpr std::uint64_t kMostRays = std::uint64_t{1} << 24;
  if (const Status sound = check_jobs(jobs); !sound) return sound;
  if (const Status sound = check(view); !sound) return sound;
  if (view.origin != state_->origin)
    return Status{StatusCode::bad_view, "rays: the view has another origin than the boxes were built about"};
  if (columns == 0 || rows == 0 || std::uint64_t{columns} * rows > kMostRays)
    return Status{StatusCode::bad_argument, "rays: expected 1 to 2^24 rays"};
  if (visible.size() < size())
    return Status{StatusCode::buffer_too_small, "rays: expected room for as many ids as there are boxes"};
  State& s = *state_;
  if (s.stacks.size() < jobs.threads) s.stacks.resize(jobs.threads);
  s.grid.make(view.view, columns, rows);
  cast_wide(s.tree, s.grid, jobs, s.stacks, s.hits);
  s.seen.assign(size(), 0);
  for (const ObjectId object : s.hits.object) {
    if (object != kNoObject) s.seen[object] = 1;
  }
  std::size_t count = 0;
  for (std::size_t object = 0; object < size(); ++object) {
    if (s.seen[object]) visible[count++] = static_cast<ObjectId>(object);
  }
  return count;
}

}  // namespace sightline
