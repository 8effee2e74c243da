#include "library/world/shadow_casters.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "library/geometry/box_math.hpp"
#include "library/geometry/box_reader.hpp"
#include "library/geometry/linear.hpp"
#include "library/geometry/mutant.h"
#include "library/occlusion/depth_tiles.hpp"
#include "library/world/receiver_mask.hpp"
#include "library/world/world_state.hpp"

namespace sightline {

using namespace geometry;

namespace world {

namespace {

// The part's corners about the shadow view's origin.
std::array<glm::dvec3, 8> part_corners(const WorldView& camera, const Depths& depths,
                                       const WorldPoint& about) {
  const glm::dmat4 to_world = glm::inverse(to_double(camera.view.world_to_eye));
  const glm::dvec3 offset(camera.origin.x - about.x, camera.origin.y - about.y, camera.origin.z - about.z);
  std::array<glm::dvec3, 8> out;
  const auto near = corners_at(camera.view, depths.near_plane),
             far = corners_at(camera.view, depths.far_plane);
  for (std::size_t i = 0; i < 8; ++i) {
    const glm::dvec3& corner = i < 4 ? near[i] : far[i - 4];
    out[i] = glm::dvec3(to_world * glm::dvec4(corner, 1)) + offset;
  }
  return out;
}

// The light's rays, and how far apart the texels are that they go through.
struct Rays {
  bool parallel = false;
  glm::dvec3 eye, forward, across, down;
  glm::dvec4 w;  // · (p, 1)
  double near_plane = 0;

  explicit Rays(const View& view)
      : parallel(is_orthographic(view)), eye(eye_of(view)), forward(to_double(view_direction(view))) {
    const auto pixels = occlusion::pixel_rays(view);
    const auto vector = [](const std::array<float, 3>& a) { return glm::dvec3(a[0], a[1], a[2]); };
    across = vector(pixels.across), down = vector(pixels.down);
    w = glm::transpose(to_double(view.eye_to_clip) * to_double(view.world_to_eye))[3];
    near_plane = depths_of(view, {}).near_plane;
  }

  // How far a lit point's lookup may reach beyond it along a direction.
  [[nodiscard]] double margin(const ShadowFilter& filter, const glm::dvec3& at,
                              const glm::dvec3& along) const {
    const double scale = parallel ? 1 : std::fabs(glm::dot(w, glm::dvec4(at, 1)));
    return filter.metres +
           filter.texels * scale * (std::fabs(glm::dot(along, across)) + std::fabs(glm::dot(along, down)));
  }
};

// Around the points and what lies between them and the light.
void extrude(Casters& c, const Rays& rays, std::span<const glm::dvec3, 8> part) {
  std::array<glm::dvec3, 16> points;
  std::copy(part.begin(), part.end(), points.begin());
  std::size_t count = SIGHTLINE_MUTANT(casters_not_extruded) ? 8 : 9;
  points[8] = rays.eye;
  if (rays.parallel) {
    constexpr double kNoPlane = 1e9;  // metres to a near plane of which nothing is known
    double length = 0;
    for (const glm::dvec3& p : part)
      length = std::max(length, glm::dot(p - rays.eye, rays.forward) - std::max(rays.near_plane, -kNoPlane));
    for (std::size_t i = 0; i < 8; ++i) points[8 + i] = part[i] - (length + 1) * rays.forward;
    if (!SIGHTLINE_MUTANT(casters_not_extruded)) count = 16;
  }
  c.plane_count = hull_planes(std::span(points).first(count), c.planes);
  for (WidePlane& plane : std::span(c.planes).first(c.plane_count)) {
    for (std::size_t i = 0; i < count; ++i) {
      const glm::dvec3& p = points[i];
      const double reach = rays.margin(c.filter, p, plane.normal);
      plane.distance = std::max(plane.distance, reach - glm::dot(plane.normal, p));
    }
  }
}

void enclose(Casters& c, std::span<const glm::dvec3, 8> part) {
  c.part_plane_count = hull_planes(part, c.part_planes);
  c.part_min = c.part_max = part[0];
  for (const glm::dvec3& p : part) c.part_min = glm::min(c.part_min, p), c.part_max = glm::max(c.part_max, p);
}

// Whether the best corner of a box lies before all planes, but for what double precision loses.
bool reaches(std::span<const WidePlane> planes, const glm::dvec3& low, const glm::dvec3& high) {
  return std::all_of(planes.begin(), planes.end(), [&](const WidePlane& plane) {
    const glm::dvec3& n = plane.normal;
    const glm::dvec3 best(n.x >= 0 ? high.x : low.x, n.y >= 0 ? high.y : low.y, n.z >= 0 ? high.z : low.z);
    const double size = glm::dot(glm::abs(n), glm::abs(best)) + std::fabs(plane.distance);
    return glm::dot(n, best) + plane.distance >= -1e-12 * size;
  });
}

void receive_object(const Casters& c, ReceiverMask& mask, const WorldBox& box) {
  const WorldPoint& o = c.shadow.origin;
  glm::dvec3 low(box.min.x - o.x, box.min.y - o.y, box.min.z - o.z),
      high(box.max.x - o.x, box.max.y - o.y, box.max.z - o.z);
  if (!reaches(std::span(c.part_planes).first(c.part_plane_count), low, high)) return;
  low = glm::max(low, c.part_min), high = glm::min(high, c.part_max);
  if (low.x > high.x || low.y > high.y || low.z > high.z) return;
  mask.add_box(low, high);
}

// The part of the image's block that lies before its farthest occluder, slice by slice: a slice is not much
// longer than it is far away.
void receive_block(const Casters& c, ReceiverMask& mask, const glm::dmat4& to_shadow, const Rect& block,
                   double farthest) {
  const double length = c.depths.far_plane - c.depths.near_plane;
  const double end = std::min(farthest, c.depths.far_plane);
  constexpr int kMostSlices = 160;
  double from = c.depths.near_plane;
  for (int slice = 1; from < end; ++slice) {
    double to = std::min(end, from + std::max(0.4 * from, length / 128));
    if (slice == kMostSlices) to = end;
    std::array<glm::dvec3, 8> corners;
    for (std::size_t i = 0; i < 8; ++i) {
      const double x = i & 1 ? block.max_x : block.min_x, y = i & 2 ? block.max_y : block.min_y;
      const double across = 2 * x / c.camera.view.width - 1, up = 1 - 2 * y / c.camera.view.height;
      corners[i] = glm::dvec3(to_shadow * glm::dvec4(point_at(c.camera.view, std::min(across, 1.0),
                                                              std::max(up, -1.0), i & 4 ? to : from),
                                                     1));
    }
    mask.add_points(corners);
    from = to;
  }
}

// What no occluder hides, in some hundreds of blocks of tiles.
void receive_depth(const Casters& c, ReceiverMask& mask, const OcclusionBuffer& buffer) {
  constexpr std::uint32_t kBlocks = 32;
  const occlusion::DepthTiles& tiles = OcclusionAccess::tiles(buffer);
  const View& view = c.camera.view;
  const WorldPoint &from = c.camera.origin, &about = c.shadow.origin;
  glm::dmat4 to_shadow(1.0);
  to_shadow[3] = glm::dvec4(from.x - about.x, from.y - about.y, from.z - about.z, 1);
  to_shadow = to_shadow * glm::inverse(to_double(view.world_to_eye));
  const double metres_per_w = 1 / std::fabs(static_cast<double>(view.eye_to_clip.m[11]));
  const std::uint32_t step = (std::max(tiles.columns, tiles.rows) + kBlocks - 1) / kBlocks;
  const auto side = static_cast<float>(occlusion::kTile * tiles.scale);
  for (std::uint32_t y = 0; y < tiles.rows; y += step) {
    for (std::uint32_t x = 0; x < tiles.columns; x += step) {
      const std::uint32_t end_x = std::min(x + step, tiles.columns), end_y = std::min(y + step, tiles.rows);
      float nearness = kInfinity;
      for (std::uint32_t ty = y; ty < end_y; ++ty)
        for (std::uint32_t tx = x; tx < end_x; ++tx)
          nearness = std::min(nearness, tiles.farthest[std::size_t{ty} * tiles.stride + tx]);
      const double behind = static_cast<double>(nearness);
      double depth = std::isinf(nearness) ? c.depths.far_plane : -behind;
      if (!tiles.projection.orthographic && !std::isinf(nearness)) depth = metres_per_w / behind;
      const auto at = [&](std::uint32_t tile) { return static_cast<float>(tile) * side; };
      receive_block(c, mask, to_shadow, {at(x), at(y), at(end_x), at(end_y)}, depth);
    }
  }
}

Status check_filter(const ShadowFilter& filter) {
  if (filter.texels >= 0 && filter.metres >= 0 && std::isfinite(filter.texels) &&
      std::isfinite(filter.metres))
    return {};
  return {StatusCode::bad_argument, "shadows: a filter is negative or not finite"};
}

}  // namespace

}  // namespace world

ShadowCasters::ShadowCasters() : state_(new State) {}
ShadowCasters::~ShadowCasters() {
  delete state_;
}
ShadowCasters::ShadowCasters(ShadowCasters&& other) noexcept : state_(std::exchange(other.state_, nullptr)) {}
ShadowCasters& ShadowCasters::operator=(ShadowCasters&& other) noexcept {
  std::swap(state_, other.state_);
  return *this;
}

Status ShadowCasters::begin(const WorldView& shadow, const WorldView& camera, const DepthRange& depths,
                            const ShadowFilter& filter) {
  for (const WorldView* view : {&shadow, &camera})
    if (const Status sound = check(*view); !sound) return sound;
  const world::Depths part = world::depths_of(camera.view, depths);
  if (const Status sound = world::check_depths(depths, part); !sound) return sound;
  if (const Status sound = world::check_filter(filter); !sound) return sound;
  State& s = *state_;
  s.shadow = shadow, s.camera = camera, s.depths = part, s.filter = filter;
  s.begun = true, s.receives = false;
  const auto corners = world::part_corners(camera, part, shadow.origin);
  world::extrude(s, world::Rays(shadow.view), corners);
  world::enclose(s, corners);
  return {};
}

Status ShadowCasters::receive(const World& world, std::span<const ObjectId> visible,
                              const OcclusionBuffer* depth) {
  State& s = *state_;
  if (!s.begun)
    return {StatusCode::stale_buffer, "shadows: casters were never begun, expected a begin first"};
  if (depth && (!depth->begun() || depth->view() != s.camera))
    return {StatusCode::stale_buffer,
            "shadows: the depth was begun with another view than the casters' camera"};
  const world::WorldState& objects = WorldAccess::state(world);
  for (std::size_t i = 0; i < visible.size(); ++i) {
    if (world.handle(visible[i]).index == kNoObject)
      return {StatusCode::bad_argument, "shadows: an id is no object's, expected ids that a cull wrote", i};
  }
  world::ReceiverMask mask(s, s.of_objects);
  for (const ObjectId id : visible) world::receive_object(s, mask, world::stored_box(objects, id));
  if (depth) {
    world::ReceiverMask before(s, s.of_depth);
    world::receive_depth(s, before, *depth);
    mask.keep_nearer(s.of_depth);
  }
  mask.write(s.mask);
  s.receives = true;
  return {};
}

const WorldView& ShadowCasters::view() const noexcept {
  return state_->shadow;
}
bool ShadowCasters::begun() const noexcept {
  return state_->begun;
}

bool ShadowCasters::may_cast(const WorldBox& box) const noexcept {
  const State& s = *state_;
  const WorldPoint& o = s.shadow.origin;
  if (!s.begun || !is_valid(box)) return true;
  if (!world::reaches(std::span(s.planes).first(s.plane_count),
                      {box.min.x - o.x, box.min.y - o.y, box.min.z - o.z},
                      {box.max.x - o.x, box.max.y - o.y, box.max.z - o.z}))
    return false;
  return !s.receives || s.mask.may_see(relative_box(box, o));
}

}  // namespace sightline
