// The public class: one view's tiles.
#include <sightline/occlusion.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "library/geometry/mutant.h"
#include "library/occlusion/depth_tiles.hpp"

namespace sightline {

namespace {

using geometry::BoxSpan;
using geometry::kBlock;
using geometry::SphereSpan;
using occlusion::DepthTiles;
using occlusion::kTile;
using occlusion::TileMemory;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kMaxSide = 8192;

// Empty tiles of an image of this size.
void set_size(DepthTiles& t, TileMemory& memory, std::uint32_t width, std::uint32_t height) {
  t.width = width, t.height = height;
  t.first_row = 0, t.end_row = height;
  t.columns = (t.width + kTile - 1) / kTile, t.rows = (t.height + kTile - 1) / kTile;
  t.stride = (t.columns + 15) / 16 * 16 + 16;
  const std::size_t tiles = std::size_t{t.stride} * t.rows;
  t.level_rows = (t.rows + 15) / 16 * 16;
  memory.farthest.resize(std::size_t{t.stride} * 2 * t.level_rows);
  if (!SIGHTLINE_MUTANT(coarse_tiles_kept)) memory.coarse = {};
  t.coarse = &memory.coarse;
  std::fill_n(memory.farthest.begin(), tiles, kInfinity);
  for (std::uint32_t row = 0; row < t.rows; ++row) {
    std::fill_n(memory.farthest.begin() + std::size_t{row} * t.stride, t.columns, -kInfinity);
  }
  memory.nearest.assign(tiles, -kInfinity);
  if (memory.nearness.size() < 64 * tiles) {
    memory.nearness.resize(64 * tiles);
    for (auto* floats : {&memory.plane.base, &memory.plane.across, &memory.plane.down}) floats->resize(tiles);
  }
  memory.untouched.resize(4 * 64);
  for (std::uint32_t kind = 0; kind < 4; ++kind) {
    for (std::uint32_t i = 0; i < 64; ++i) {
      const bool beyond = (kind & 1 && (t.columns - 1) * kTile + i % kTile >= t.width) ||
                          (kind & 2 && (t.rows - 1) * kTile + i / kTile >= t.height);
      memory.untouched[kind * 64 + i] = beyond ? kInfinity : -kInfinity;
    }
  }
  if (memory.scratch.empty()) memory.scratch.resize(1);
  t.farthest = memory.farthest.data(), t.nearest = memory.nearest.data();
  t.plane = {memory.plane.base.data(), memory.plane.across.data(), memory.plane.down.data()};
  t.nearness = memory.nearness.data();
  t.untouched = memory.untouched.data(), t.mesh = memory.scratch.data();
}

// Before the first begin(): empty, so that everything may be seen.
Status check_begun(const DepthTiles& tiles) noexcept {
  if (tiles.begun) return {};
  return {StatusCode::stale_buffer,
          "occlusion: the buffer was never begun, expected a begin with a view first"};
}

float nearness_at(const DepthTiles& t, std::uint32_t x, std::uint32_t y) noexcept {
  const std::size_t tile = std::size_t{y / kTile} * t.stride + x / kTile;
  if (!(t.nearest[tile] > -kInfinity)) return -kInfinity;
  const std::uint32_t column = x % kTile, row = y % kTile;
  if (t.plane.base[tile] > -kInfinity) return occlusion::nearness_of(t.plane.of(tile), column, row);
  return t.nearness[tile * 64 + row * kTile + column];
}

bool is_affine(const Mat4& m) noexcept {
  for (const float x : m.m) {
    if (!std::isfinite(x)) return false;
  }
  return m.m[3] == 0 && m.m[7] == 0 && m.m[11] == 0 && m.m[15] == 1;
}

constexpr occlusion::BoxQuestions kBoxQuestions{occlusion::eye_projection, occlusion::query_boxes};

// Asks in blocks, laid out where the caller's arrays are not so already.
template <class Block, class Ask>
void ask_blocks(std::size_t count, std::uint8_t* visible, const Ask& ask) {
  Block block;
  for (std::size_t first = 0; first < count; first += geometry::kBlock)
    ask(first, std::min(geometry::kBlock, count - first), block, visible + first);
}

}  // namespace

OcclusionBuffer::OcclusionBuffer() : state_(new State) {}
OcclusionBuffer::~OcclusionBuffer() {
  delete state_;
}
OcclusionBuffer::OcclusionBuffer(OcclusionBuffer&& other) noexcept
    : state_(std::exchange(other.state_, nullptr)) {}
OcclusionBuffer& OcclusionBuffer::operator=(OcclusionBuffer&& other) noexcept {
  std::swap(state_, other.state_);
  return *this;
}

Status OcclusionBuffer::begin(const WorldView& view, const OcclusionOptions& options) {
  if (const Status sound = check(view); !sound) return sound;
  const std::uint32_t scale = options.scale;
  if (scale != 1 && scale != 2 && scale != 4)
    return {StatusCode::bad_argument, "occlusion: the scale is none, expected 1, 2 or 4"};
  if (options.coverage != Coverage::centres && options.coverage != Coverage::area)
    return {StatusCode::bad_argument, "occlusion: the coverage is none, expected centres or area"};
  if (view.view.width > kMaxSide || view.view.height > kMaxSide)
    return {StatusCode::bad_view, "occlusion: the view is too large, expected at most 8192 pixels a side"};
  state_->view = view;
  state_->begun = true;
  state_->ask = &kBoxQuestions;
  state_->options = options;
  state_->scale = scale;
  // Of a pixel of scale x scale the centres lie up to that far from its own centre; all of it half a side.
  state_->margin = options.coverage == Coverage::area ? 0.5f : 0.5f - 0.5f / static_cast<float>(scale);
  state_->projection = occlusion::eye_projection(view, view.origin, scale);
  state_->rounding = occlusion::corner_rounding(state_->projection, view.view, scale);
  state_->rays = occlusion::pixel_rays(view.view, scale);
  set_size(*state_, state_->memory, (view.view.width + scale - 1) / scale,
           (view.view.height + scale - 1) / scale);
  return {};
}

const WorldView& OcclusionBuffer::view() const noexcept {
  return state_->view;
}
const OcclusionOptions& OcclusionBuffer::options() const noexcept {
  return state_->options;
}
bool OcclusionBuffer::begun() const noexcept {
  return state_->begun;
}

Status OcclusionBuffer::draw_boxes(const BoxView& boxes) noexcept {
  if (const Status begun = check_begun(*state_); !begun) return begun;
  if (!boxes.sound())
    return {StatusCode::bad_argument, "occlusion: a box's pointer is null or its stride too short"};
  if (std::span<const Box> structs; BoxReader::lies_as_structs(boxes, state_->view.origin, structs)) {
    occlusion::draw_boxes(*state_, structs);
    return {};
  }
  std::array<WorldBox, kBlock> exact;
  std::array<Box, kBlock> block;
  for (std::size_t first = 0; first < boxes.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, boxes.size() - first);
    BoxReader::read(boxes, first, count, exact.data(), false);
    for (std::size_t i = 0; i < count; ++i) block[i] = geometry::inner_box(exact[i], state_->view.origin);
    occlusion::draw_boxes(*state_, std::span(block).first(count));
  }
  return {};
}

Status OcclusionBuffer::draw_spheres(const SphereView& spheres) noexcept {
  if (const Status begun = check_begun(*state_); !begun) return begun;
  if (!spheres.sound())
    return {StatusCode::bad_argument, "occlusion: a sphere's pointer is null or its stride too short"};
  if (std::span<const Sphere> structs; BoxReader::lies_as_structs(spheres, structs)) {
    occlusion::draw_spheres(*state_, structs);
    return {};
  }
  std::array<Sphere, kBlock> block;
  for (std::size_t first = 0; first < spheres.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, spheres.size() - first);
    for (std::size_t i = 0; i < count; ++i) block[i] = spheres[first + i];
    occlusion::draw_spheres(*state_, std::span(block).first(count));
  }
  return {};
}

Status OcclusionBuffer::draw_mesh(const OccluderMesh& mesh, const Mat4& transform, const JobSystem& jobs) {
  if (const Status begun = check_begun(*state_); !begun) return begun;
  if (!is_affine(transform)) {
    return {StatusCode::bad_argument,
            "occlusion: the transform is not finite or not affine, expected the last row 0 0 0 1"};
  }
  occlusion::draw_mesh(*state_, state_->memory, *mesh.topology_, geometry::exact_affine(transform), jobs);
  return {};
}

bool OcclusionBuffer::may_see(const Box& b) const noexcept {
  if (!state_->begun) return true;
  std::uint8_t visible = 1;
  occlusion::query_boxes(*state_, state_->projection,
                         {&b.min.x, &b.min.y, &b.min.z, &b.max.x, &b.max.y, &b.max.z, 1}, &visible);
  return visible != 0;
}

Status OcclusionBuffer::may_see(const BoxView& boxes, std::span<std::uint8_t> visible) const noexcept {
  const std::size_t count = boxes.size();
  if (!boxes.sound())
    return {StatusCode::bad_argument, "occlusion: a box's pointer is null or its stride too short"};
  if (visible.size() < count)
    return {StatusCode::buffer_too_small, "occlusion: expected room for one answer a box"};
  if (!state_->begun) {
    std::fill_n(visible.begin(), count, std::uint8_t{1});
    return {};
  }
  // Arrays are read where they lie, about their own origin.
  BoxSpan arrays;
  if (BoxReader::lies_in_arrays(boxes, boxes.origin(), arrays)) {
    const bool near = boxes.origin() == state_->view.origin;
    const auto& projection =
        near ? state_->projection : occlusion::eye_projection(state_->view, boxes.origin(), state_->scale);
    occlusion::query_boxes(*state_, projection, arrays, visible.data());
    return {};
  }
  ask_blocks<geometry::BoxBlock>(
      count, visible.data(), [&](std::size_t first, std::size_t size, auto& block, std::uint8_t* out) {
        const BoxSpan laid_out = BoxReader::lay_out(boxes, first, size, state_->view.origin, block);
        occlusion::query_boxes(*state_, state_->projection, laid_out, out);
      });
  return {};
}

Status OcclusionBuffer::may_see(const SphereView& spheres, std::span<std::uint8_t> visible) const noexcept {
  const std::size_t count = spheres.size();
  if (!spheres.sound())
    return {StatusCode::bad_argument, "occlusion: a sphere's pointer is null or its stride too short"};
  if (visible.size() < count)
    return {StatusCode::buffer_too_small, "occlusion: expected room for one answer a sphere"};
  if (!state_->begun) {
    std::fill_n(visible.begin(), count, std::uint8_t{1});
    return {};
  }
  if (SphereSpan arrays; BoxReader::lies_in_arrays(spheres, arrays)) {
    occlusion::query_spheres(*state_, state_->projection, arrays, visible.data());
    return {};
  }
  ask_blocks<geometry::SphereBlock>(
      count, visible.data(), [&](std::size_t first, std::size_t size, auto& block, std::uint8_t* out) {
        occlusion::query_spheres(*state_, state_->projection, BoxReader::lay_out(spheres, first, size, block),
                                 out);
      });
  return {};
}

bool OcclusionBuffer::may_see(std::span<const Vec3> triangles) const noexcept {
  return !state_->begun || occlusion::query_triangles(*state_, triangles);
}

Status OcclusionBuffer::read_nearness(std::span<float> pixels) const noexcept {
  if (const Status begun = check_begun(*state_); !begun) return begun;
  const DepthTiles& t = *state_;
  const std::uint32_t width = t.view.view.width, height = t.view.view.height;
  if (pixels.size() < std::size_t{width} * height)
    return {StatusCode::buffer_too_small, "occlusion: expected room for width x height pixels"};
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      pixels[std::size_t{y} * width + x] = nearness_at(t, x / t.scale, y / t.scale);
    }
  }
  return {};
}

}  // namespace sightline
