#include "workbench/methods/raster_occlusion/ground_chunks.hpp"

#include <cmath>

#include <sightline/frustum.hpp>
#include <sightline/projection.hpp>

namespace sightline::methods {

namespace {

bool contributes(const submission::Contribution& contribution, const Projector& projector,
                 const Box& bounds) {
  if (contribution.test == submission::Contribution::Test::exact) {
    return covers_sample(projector, projected_rect(projector, bounds));
  }
  const Vec3 half{0.5f * (bounds.max.x - bounds.min.x), 0.5f * (bounds.max.y - bounds.min.y),
                  0.5f * (bounds.max.z - bounds.min.z)};
  const float radius = std::sqrt(half.x * half.x + half.y * half.y + half.z * half.z);
  const Vec3 centre{bounds.min.x + half.x, bounds.min.y + half.y, bounds.min.z + half.z};
  return projected_area(projector, Sphere{centre, radius}) >= contribution.threshold;
}

}  // namespace

GroundChunks::GroundChunks(const Scene& scene, std::uint32_t depth)
    : extent_(sightline::extent(scene)), map_({extent_, depth}) {
  map_.insert_all(scene.bounds);
}

void GroundChunks::update(const Scene& scene, std::span<const ObjectId> moved) {
  for (const ObjectId object : moved) map_.move(object, scene.bounds[object]);
  map_.tighten();
  extent_ = map_.nodes()[0].bounds;
}

void GroundChunks::select(const View& view, const submission::Contribution& contribution) {
  world::walk(map_, make_frustum(view), walk_);
  if (contribution.test == submission::Contribution::Test::off) return;
  const Projector projector = make_projector(view, extent_);
  for (auto* list : {&walk_.inside, &walk_.crossing}) {
    std::erase_if(*list, [&](std::uint32_t chunk) {
      return !contributes(contribution, projector, map_.chunk_bounds(chunk));
    });
  }
}

}  // namespace sightline::methods
