// Objects' triangles in the blocks that queries read, and the queries.
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "library/occlusion/depth_tiles.hpp"
#include "library/occlusion/mesh_check.hpp"

namespace sightline {

using occlusion::TriangleBlock;

namespace {

constexpr std::size_t kPerBlock = TriangleBlock::kSize;

constexpr Status kExpectedCorners{StatusCode::bad_mesh,
                                  "occludees: expected three corners for each of their triangles"};

}  // namespace

struct OccludeeTriangles::State {
  std::vector<TriangleBlock> blocks;       // object by object
  std::vector<std::uint32_t> first_block;  // one an object, and the end
  std::vector<std::uint32_t> triangles;
  std::vector<std::uint32_t> asked;  // of these, those that may show something
  std::vector<Sides> sides;

  [[nodiscard]] std::span<TriangleBlock> of(std::uint32_t object) noexcept {
    if (object >= triangles.size()) return {};
    return std::span(blocks).subspan(first_block[object], first_block[object + 1] - first_block[object]);
  }
  [[nodiscard]] occlusion::TriangleRun run(std::uint32_t object) const noexcept {
    if (object >= triangles.size()) return {};
    return {blocks.data() + first_block[object], asked[object], sides[object]};
  }
  void fill(std::uint32_t object, std::span<const Vec3> corners) noexcept {
    asked[object] = occlusion::fill_blocks(corners, of(object));
  }
};

OccludeeTriangles::OccludeeTriangles() : state_(new State) {}
OccludeeTriangles::~OccludeeTriangles() {
  delete state_;
}
OccludeeTriangles::OccludeeTriangles(OccludeeTriangles&& other) noexcept
    : state_(std::exchange(other.state_, nullptr)) {}
OccludeeTriangles& OccludeeTriangles::operator=(OccludeeTriangles&& other) noexcept {
  std::swap(state_, other.state_);
  return *this;
}

Status OccludeeTriangles::assign(std::span<const Vec3> corners,
                                 std::span<const std::uint32_t> triangles_per_object,
                                 std::span<const Sides> sides) {
  constexpr std::uint64_t kMost = 0xfffffffeu;
  std::uint64_t triangles = 0, blocks = 0;
  for (const std::uint32_t count : triangles_per_object)
    triangles += count, blocks += (std::uint64_t{count} + kPerBlock - 1) / kPerBlock;
  if (triangles_per_object.size() > kMost || blocks > kMost)
    return {StatusCode::too_many,
            "occludees: expected at most 2^32 - 2 objects and blocks of four triangles"};
  if (corners.size() != 3 * triangles) return kExpectedCorners;
  if (sides.size() > 1 && sides.size() != triangles_per_object.size())
    return {StatusCode::bad_mesh, "occludees: expected sides for each object, one for all, or none"};
  const auto odd = std::ranges::find_if_not(sides, occlusion::is_known);
  if (odd != sides.end())
    return {StatusCode::bad_argument, "occludees: sides are none, expected both or front",
            static_cast<std::size_t>(odd - sides.begin())};
  State& s = *state_;
  s.sides.assign(triangles_per_object.size(), sides.empty() ? Sides::both : sides[0]);
  if (sides.size() > 1) std::ranges::copy(sides, s.sides.begin());
  s.triangles.assign(triangles_per_object.begin(), triangles_per_object.end());
  s.first_block.assign(1, 0);
  for (const std::uint64_t count : s.triangles)
    s.first_block.push_back(s.first_block.back() +
                            static_cast<std::uint32_t>((count + kPerBlock - 1) / kPerBlock));
  s.blocks.resize(blocks);
  s.asked.resize(s.triangles.size());
  for (std::uint32_t o = 0; o < objects(); ++o) {
    const std::size_t count = std::size_t{3} * s.triangles[o];
    s.fill(o, corners.first(count));
    corners = corners.subspan(count);
  }
  return {};
}

Status OccludeeTriangles::set(std::uint32_t object, std::span<const Vec3> corners) {
  if (object >= objects()) return {StatusCode::bad_argument, "occludees: there is no such object", object};
  if (corners.size() != std::size_t{3} * state_->triangles[object]) return kExpectedCorners;
  state_->fill(object, corners);
  return {};
}

std::uint32_t OccludeeTriangles::objects() const noexcept {
  return static_cast<std::uint32_t>(state_->triangles.size());
}

std::uint32_t OccludeeTriangles::triangles(std::uint32_t object) const noexcept {
  return object < objects() ? state_->triangles[object] : 0;
}

bool OcclusionBuffer::may_see(const OccludeeTriangles& triangles, std::uint32_t object) const noexcept {
  return keep_seen(triangles, {&object, 1}) == 1;
}

std::size_t OcclusionBuffer::keep_seen(const OccludeeTriangles& triangles,
                                       std::span<std::uint32_t> objects) const noexcept {
  if (!state_->begun) return objects.size();
  constexpr std::size_t kAtOnce = 64;
  std::array<occlusion::TriangleRun, kAtOnce> runs;
  std::array<std::uint8_t, kAtOnce> seen;
  std::size_t kept = 0;
  for (std::size_t first = 0; first < objects.size(); first += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, objects.size() - first);
    for (std::size_t i = 0; i < count; ++i) runs[i] = triangles.state_->run(objects[first + i]);
    occlusion::query_triangles(*state_, std::span(runs).first(count), seen.data());
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t object = objects[first + i];
      objects[kept] = object;
      kept += seen[i] || object >= triangles.objects();
    }
  }
  return kept;
}

}  // namespace sightline
