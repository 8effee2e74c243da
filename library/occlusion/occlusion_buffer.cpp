// The public class: one view's tiles.
#include <sightline/occlusion.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "library/occlusion/depth_tiles.hpp"

namespace sightline {

namespace {

using occlusion::DepthTiles;
using occlusion::kTile;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kMaxSide = 8192;

// Empty tiles of an image of this size.
void set_size(DepthTiles& t, std::uint32_t width, std::uint32_t height) {
  t.width = width, t.height = height;
  t.columns = (t.width + kTile - 1) / kTile, t.rows = (t.height + kTile - 1) / kTile;
  t.stride = (t.columns + 15) / 16 * 16 + 16;
  t.farthest.assign(std::size_t{t.stride} * t.rows, kInfinity);
  for (std::uint32_t row = 0; row < t.rows; ++row) {
    std::fill_n(t.farthest.begin() + std::size_t{row} * t.stride, t.columns, -kInfinity);
  }
  t.nearest.assign(t.farthest.size(), -kInfinity);
  if (t.nearness.size() < 64 * t.farthest.size()) t.nearness.resize(64 * t.farthest.size());
  t.untouched.resize(4 * 64);
  for (std::uint32_t kind = 0; kind < 4; ++kind) {
    for (std::uint32_t i = 0; i < 64; ++i) {
      const bool beyond = (kind & 1 && (t.columns - 1) * kTile + i % kTile >= t.width) ||
                          (kind & 2 && (t.rows - 1) * kTile + i / kTile >= t.height);
      t.untouched[kind * 64 + i] = beyond ? kInfinity : -kInfinity;
    }
  }
}

}  // namespace

OcclusionBuffer::OcclusionBuffer() : tiles_(std::make_unique<DepthTiles>()) {}
OcclusionBuffer::~OcclusionBuffer() = default;
OcclusionBuffer::OcclusionBuffer(OcclusionBuffer&&) noexcept = default;
OcclusionBuffer& OcclusionBuffer::operator=(OcclusionBuffer&&) noexcept = default;

Check OcclusionBuffer::begin(const WorldView& view) {
  if (Check bad = check(view.view)) return bad;
  const WorldPoint& o = view.origin;
  if (!(std::fabs(o.x) <= kWorldReach && std::fabs(o.y) <= kWorldReach && std::fabs(o.z) <= kWorldReach)) {
    return Failure{"occlusion: the view's origin is out of range, expected within 1e11 m of 0"};
  }
  if (view.view.width > kMaxSide || view.view.height > kMaxSide) {
    return Failure{"occlusion: expected a view of at most 8192 pixels a side"};
  }
  tiles_->view = view;
  tiles_->projection = occlusion::eye_projection(view, view.origin);
  tiles_->rays = occlusion::pixel_rays(view.view);
  set_size(*tiles_, view.view.width, view.view.height);
  return {};
}

void OcclusionBuffer::draw_boxes(std::span<const Box> boxes) noexcept {
  occlusion::draw_boxes(*tiles_, boxes);
}

void OcclusionBuffer::draw_boxes(std::span<const WorldBox> boxes) noexcept {
  const auto inwards = [](double low, double high, float& from, float& to) {
    from = static_cast<float>(low), to = static_cast<float>(high);
    if (static_cast<double>(from) < low) from = std::nextafter(from, kInfinity);
    if (static_cast<double>(to) > high) to = std::nextafter(to, -kInfinity);
  };
  const WorldPoint& o = tiles_->view.origin;
  std::array<Box, 64> some;
  for (std::size_t first = 0; first < boxes.size(); first += some.size()) {
    const std::size_t count = std::min(some.size(), boxes.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      const WorldBox& b = boxes[first + i];
      inwards(b.min.x - o.x, b.max.x - o.x, some[i].min.x, some[i].max.x);
      inwards(b.min.y - o.y, b.max.y - o.y, some[i].min.y, some[i].max.y);
      inwards(b.min.z - o.z, b.max.z - o.z, some[i].min.z, some[i].max.z);
    }
    occlusion::draw_boxes(*tiles_, std::span(some).first(count));
  }
}

void OcclusionBuffer::draw_spheres(std::span<const Sphere> spheres) noexcept {
  occlusion::draw_spheres(*tiles_, spheres);
}

void OcclusionBuffer::draw_mesh(const OccluderMesh& mesh, const Affine& transform) {
  occlusion::draw_mesh(*tiles_, mesh.topology(), transform);
}

bool OcclusionBuffer::may_see(const Box& b) const noexcept {
  std::uint8_t visible = 1;
  occlusion::query_boxes(*tiles_, tiles_->projection,
                         {&b.min.x, &b.min.y, &b.min.z, &b.max.x, &b.max.y, &b.max.z, 1}, &visible);
  return visible != 0;
}

void OcclusionBuffer::may_see(const BoxSpan& boxes, std::span<std::uint8_t> visible) const noexcept {
  occlusion::query_boxes(*tiles_, tiles_->projection, boxes, visible.data());
}

void OcclusionBuffer::may_see(const BoxSpan& boxes, const WorldPoint& origin,
                              std::span<std::uint8_t> visible) const noexcept {
  occlusion::query_boxes(*tiles_, occlusion::eye_projection(tiles_->view, origin), boxes, visible.data());
}

void OcclusionBuffer::may_see(const SphereSpan& spheres, std::span<std::uint8_t> visible) const noexcept {
  occlusion::query_spheres(*tiles_, tiles_->projection, spheres, visible.data());
}

bool OcclusionBuffer::may_see(std::span<const Vec3> triangles) const noexcept {
  return occlusion::query_triangles(*tiles_, triangles);
}

std::uint32_t OcclusionBuffer::width() const noexcept {
  return tiles_->width;
}
std::uint32_t OcclusionBuffer::height() const noexcept {
  return tiles_->height;
}

void OcclusionBuffer::read_nearness(std::span<float> pixels) const noexcept {
  const DepthTiles& t = *tiles_;
  for (std::uint32_t y = 0; y < t.height; ++y) {
    for (std::uint32_t x = 0; x < t.width; ++x) {
      const std::size_t tile = std::size_t{y / kTile} * t.stride + x / kTile;
      pixels[std::size_t{y} * t.width + x] =
          t.nearest[tile] > -kInfinity ? t.nearness[tile * 64 + y % kTile * kTile + x % kTile] : -kInfinity;
    }
  }
}

}  // namespace sightline
