// Objects' triangles in the blocks that queries read, and the queries.
#include <numeric>
#include <string>

#include "library/occlusion/depth_tiles.hpp"

namespace sightline {

using occlusion::TriangleBlock;

namespace {

constexpr std::size_t kPerBlock = TriangleBlock::kSize;

Failure expected_corners(std::size_t expected, std::size_t given) {
  return {"triangles that are asked for: expected " + std::to_string(expected) + " corners, got " +
          std::to_string(given)};
}

void fill(std::span<TriangleBlock> blocks, std::span<const Vec3> corners) noexcept {
  for (std::size_t b = 0; b < blocks.size(); ++b) blocks[b].take(corners, b * kPerBlock);
}

}  // namespace

OccludeeTriangles::OccludeeTriangles() = default;
OccludeeTriangles::~OccludeeTriangles() = default;
OccludeeTriangles::OccludeeTriangles(OccludeeTriangles&&) noexcept = default;
OccludeeTriangles& OccludeeTriangles::operator=(OccludeeTriangles&&) noexcept = default;

Check OccludeeTriangles::assign(std::span<const Vec3> corners,
                                std::span<const std::uint32_t> triangles_per_object) {
  const std::uint64_t expected =
      3 * std::accumulate(triangles_per_object.begin(), triangles_per_object.end(), std::uint64_t{0});
  if (corners.size() != expected) return expected_corners(expected, corners.size());
  triangles_.assign(triangles_per_object.begin(), triangles_per_object.end());
  first_block_.assign(1, 0);
  for (const std::uint64_t count : triangles_)
    first_block_.push_back(first_block_.back() +
                           static_cast<std::uint32_t>((count + kPerBlock - 1) / kPerBlock));
  blocks_.resize(first_block_.back());
  for (std::size_t o = 0; o < triangles_.size(); ++o) {
    const std::size_t count = std::size_t{3} * triangles_[o];
    fill(std::span(blocks_).subspan(first_block_[o], first_block_[o + 1] - first_block_[o]),
         corners.first(count));
    corners = corners.subspan(count);
  }
  return {};
}

Check OccludeeTriangles::set(std::uint32_t object, std::span<const Vec3> corners) {
  if (object >= objects()) {
    return Failure{"triangles that are asked for: expected an object below " + std::to_string(objects()) +
                   ", got " + std::to_string(object)};
  }
  const std::size_t expected = std::size_t{3} * triangles_[object];
  if (corners.size() != expected) return expected_corners(expected, corners.size());
  const std::uint32_t first = first_block_[object];
  fill(std::span(blocks_).subspan(first, first_block_[object + 1] - first), corners);
  return {};
}

std::uint32_t OccludeeTriangles::objects() const noexcept {
  return static_cast<std::uint32_t>(triangles_.size());
}

std::uint32_t OccludeeTriangles::triangles(std::uint32_t object) const noexcept {
  return object < objects() ? triangles_[object] : 0;
}

std::span<const TriangleBlock> OccludeeTriangles::blocks(std::uint32_t object) const noexcept {
  if (object >= objects()) return {};
  return std::span(blocks_).subspan(first_block_[object], first_block_[object + 1] - first_block_[object]);
}

bool OcclusionBuffer::may_see(const OccludeeTriangles& triangles, std::uint32_t object) const noexcept {
  if (object >= triangles.objects()) return true;
  return occlusion::query_triangles(*tiles_, triangles.blocks(object), triangles.triangles_[object]);
}

std::size_t OcclusionBuffer::keep_seen(const OccludeeTriangles& triangles,
                                       std::span<std::uint32_t> objects) const noexcept {
  constexpr std::size_t kAhead = 3;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (i + kAhead < objects.size()) occlusion::prefetch(triangles.blocks(objects[i + kAhead]));
    const std::uint32_t object = objects[i];
    objects[kept] = object;
    kept += may_see(triangles, object);
  }
  return kept;
}

}  // namespace sightline
