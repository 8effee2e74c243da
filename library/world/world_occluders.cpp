#include "library/world/world_occluders.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "library/geometry/box_math.hpp"
#include "library/geometry/box_reader.hpp"
#include "library/geometry/linear.hpp"
#include "library/occlusion/mesh_check.hpp"
#include "library/world/automatic_cull.hpp"
#include "library/world/free_list.hpp"
#include "library/world/world_state.hpp"

namespace sightline {

namespace world {

namespace {

// Of a box's distance from the placement's origin: what its caller's floats may have lost of it, twice over.
constexpr double kBoxRounding = 2.5e-7;

WorldBox about(const WorldPoint& origin, const glm::dvec3& low, const glm::dvec3& high) {
  return {{origin.x + low.x, origin.y + low.y, origin.z + low.z},
          {origin.x + high.x, origin.y + high.y, origin.z + high.z}};
}

// Of the box's corners, moved by an affine matrix.
WorldBox placed_bounds(const Box& box, const OccluderPlacement& placement) {
  const glm::dmat4 m = geometry::to_double(placement.transform);
  glm::dvec3 low(m[3]), high(m[3]);
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::uint32_t>(axis);
    const glm::dvec3 at_min = glm::dvec3(m[axis]) * double{geometry::coordinate(box.min, a)},
                     at_max = glm::dvec3(m[axis]) * double{geometry::coordinate(box.max, a)};
    low += glm::min(at_min, at_max), high += glm::max(at_min, at_max);
  }
  return about(placement.origin, low, high);
}

CarrierBrief brief_of(const Carrier& carrier) {
  const WorldBox& b = carrier.bounds;
  const auto& m = carrier.placement.transform.m;
  const bool along_axes = m[1] == 0 && m[2] == 0 && m[4] == 0 && m[6] == 0 && m[8] == 0 && m[9] == 0;
  const double x = 0.5 * (b.max.x - b.min.x), y = 0.5 * (b.max.y - b.min.y), z = 0.5 * (b.max.z - b.min.z);
  return {{b.min.x + x, b.min.y + y, b.min.z + z},
          static_cast<float>(std::sqrt(x * x + y * y + z * z)),
          carrier.placement.occluder,
          carrier.object,
          along_axes};
}

// Twelve triangles a box, their fronts outwards.
void append_box(const Box& box, std::vector<Vec3>& positions, std::vector<std::uint32_t>& indices) {
  constexpr std::array<std::uint32_t, 36> kCorners{0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                                   2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
  const auto first = static_cast<std::uint32_t>(positions.size());
  for (std::uint32_t i = 0; i < 8; ++i)
    positions.push_back(
        {i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z});
  for (const std::uint32_t corner : kCorners) indices.push_back(first + corner);
}

void include(Box& bounds, const Occluder& occluder, std::span<const Sphere> spheres) {
  bounds = geometry::kEmptyBox;
  for (const Vec3& p : occluder.positions) bounds = geometry::united(bounds, {p, p});
  for (const Box& box : occluder.boxes) bounds = geometry::united(bounds, box);
  for (const Sphere& s : spheres) {
    const Vec3 c = s.centre;
    bounds = geometry::united(bounds, {{c.x - s.radius, c.y - s.radius, c.z - s.radius},
                                       {c.x + s.radius, c.y + s.radius, c.z + s.radius}});
  }
  if (bounds.min.x > bounds.max.x) bounds = {};
}

bool is_valid(const Sphere& s) {
  return geometry::is_finite(s.centre) && std::isfinite(s.radius) && s.radius >= 0;
}

Status check_solids(const Occluder& occluder, std::span<const Sphere> spheres) {
  if (occluder.solid_triangles > occluder.indices.size() / 3)
    return {StatusCode::bad_argument, "world: an occluder has more solid triangles than triangles"};
  const auto bad_box = std::find_if_not(occluder.boxes.begin(), occluder.boxes.end(),
                                        [](const Box& box) { return geometry::is_valid(box); });
  if (bad_box != occluder.boxes.end())
    return {StatusCode::bad_box, "world: an occluder's box is not finite or turned inside out",
            static_cast<std::size_t>(bad_box - occluder.boxes.begin())};
  const auto bad_sphere = std::find_if_not(spheres.begin(), spheres.end(), is_valid);
  if (bad_sphere != spheres.end())
    return {StatusCode::bad_box, "world: an occluder's sphere is not finite or has a negative radius",
            static_cast<std::size_t>(bad_sphere - spheres.begin())};
  return {};
}

// The meshes of a shape: all triangles, those that do not lie inside, boxes.
Status make_meshes(const Occluder& occluder, OccluderShape& shape) {
  const std::span indices(occluder.indices);
  const std::span sides(occluder.sides);
  const std::size_t solid = 3 * occluder.solid_triangles;
  auto all = OccluderMesh::make(occluder.positions, indices, sides);
  if (!all) return all.error();
  shape.all = *std::move(all);
  shape.some_inside = solid > 0;
  if (shape.some_inside && solid < indices.size()) {
    const bool each = sides.size() == indices.size() / 3;
    auto own = OccluderMesh::make(occluder.positions, indices.subspan(solid),
                                  each ? sides.subspan(solid / 3) : sides);
    if (!own) return own.error();
    shape.own = *std::move(own);
  }
  if (!indices.empty() || occluder.boxes.empty()) return {};
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> corners;
  for (const Box& box : occluder.boxes) append_box(box, positions, corners);
  auto turned = OccluderMesh::make(positions, corners, Sides::front);
  if (!turned) return turned.error();
  shape.turned = *std::move(turned);
  return {};
}

bool is_affine(const Mat4& m) noexcept {
  return std::all_of(m.m.begin(), m.m.end(), [](float x) { return std::isfinite(x); }) && m.m[3] == 0 &&
         m.m[7] == 0 && m.m[11] == 0 && m.m[15] == 1;
}

bool names_one(const WorldOccluders& o, OccluderId id) noexcept {
  return id < o.shapes.size() && o.shapes[id].used;
}

void let_go(WorldOccluders& o, std::uint32_t carrier) noexcept {
  --o.shapes[o.carriers[carrier].placement.occluder].carriers;
}

}  // namespace

bool stands(const WorldBox& bounds, const WorldPoint& origin, const WorldBox& when_given,
            const WorldBox& box) noexcept {
  const auto within = [](double low, double high, double at, double outer_low, double outer_high) {
    const double away = std::max(std::fabs(outer_low - at), std::fabs(outer_high - at));
    const double slack = kBoxRounding * away + 1e-15 * std::fabs(at);
    return low >= outer_low - slack && high <= outer_high + slack;
  };
  return when_given == box && within(bounds.min.x, bounds.max.x, origin.x, box.min.x, box.max.x) &&
         within(bounds.min.y, bounds.max.y, origin.y, box.min.y, box.max.y) &&
         within(bounds.min.z, bounds.max.z, origin.z, box.min.z, box.max.z);
}

WorldOccluders& WorldState::own_occluders() {
  if (!occluders) occluders = std::make_unique<WorldOccluders>();
  return *occluders;
}

WorldOccluders::~WorldOccluders() = default;

void WorldOccluders::forget(ObjectId id) noexcept {
  take_away(id);
  take_triangles(id);
}

std::unique_ptr<Hiding> WorldOccluders::make_hiding() const {
  return world::make_hiding();
}

void WorldOccluders::place(const WorldState& world, ObjectId id, const OccluderPlacement& placement) {
  if (placement.occluder == kNoOccluder) return take_away(id);
  if (carrier_of.size() < world.objects.size()) carrier_of.resize(world.objects.size(), kNothing);
  std::uint32_t at = carrier_of[id];
  if (at == kNothing) {
    at = carrier_of[id] = take_element(carriers, free_carriers);
    briefs.resize(carriers.size());
  } else {
    let_go(*this, at);
  }
  ++shapes[placement.occluder].carriers;
  carriers[at] = {id, placement, placed_bounds(shapes[placement.occluder].bounds, placement),
                  stored_box(world, id)};
  briefs[at] = brief_of(carriers[at]);
}

void WorldOccluders::take_away(ObjectId id) noexcept {
  const std::uint32_t at = carrier(id);
  if (at == kNothing) return;
  let_go(*this, at);
  carriers[at] = {};
  briefs[at] = {};
  carrier_of[id] = kNothing;
  free_carriers.push_back(at);
}

void WorldOccluders::set_triangles(const WorldState& world, ObjectId id, std::span<const Vec3> corners,
                                   const WorldPoint& origin, Sides sides) {
  if (corners.empty()) return take_triangles(id);
  if (triangles_of.size() < world.objects.size()) triangles_of.resize(world.objects.size(), kNothing);
  std::uint32_t& at = triangles_of[id];
  if (at == kNothing) at = take_element(triangles, free_triangles);
  constexpr std::size_t kPerBlock = occlusion::TriangleBlock::kSize;
  ObjectTriangles& set = triangles[at];
  set.blocks.resize((corners.size() / 3 + kPerBlock - 1) / kPerBlock);
  triangle_count -= set.count;
  set.count = occlusion::fill_blocks(corners, set.blocks);
  triangle_count += set.count;
  glm::dvec3 low(corners[0].x, corners[0].y, corners[0].z), high = low;
  for (const Vec3& p : corners) {
    low = glm::min(low, geometry::to_double(p)), high = glm::max(high, geometry::to_double(p));
  }
  set.origin = origin, set.sides = sides;
  set.bounds = about(origin, low, high), set.object_box = stored_box(world, id);
}

void WorldOccluders::take_triangles(ObjectId id) noexcept {
  const std::uint32_t at = triangle_set(id);
  if (at == kNothing) return;
  triangle_count -= triangles[at].count;
  triangles[at] = {};
  triangles_of[id] = kNothing;
  free_triangles.push_back(at);
}

}  // namespace world

using world::kNothing;
using world::WorldOccluders;

Result<OccluderId> World::add_occluder(const Occluder& occluder, std::span<const Sphere> spheres) {
  if (const Status sound = world::check_solids(occluder, spheres); !sound) return sound;
  world::OccluderShape shape;
  if (const Status made = world::make_meshes(occluder, shape); !made) return made;
  if (occluder.indices.empty()) shape.boxes = occluder.boxes;
  shape.spheres.assign(spheres.begin(), spheres.end());
  world::include(shape.bounds, occluder, spheres);
  shape.used = true;
  WorldOccluders& o = state_->own_occluders();
  const OccluderId id = world::take_element(o.shapes, o.free_shapes);
  o.shapes[id] = std::move(shape);
  return id;
}

Status World::remove_occluder(OccluderId occluder) {
  WorldOccluders& o = state_->own_occluders();
  if (!world::names_one(o, occluder))
    return {StatusCode::bad_argument, "world: there is no occluder of this name", occluder};
  if (o.shapes[occluder].carriers > 0)
    return {StatusCode::bad_argument, "world: an object still carries this occluder", occluder};
  o.shapes[occluder] = {};
  o.free_shapes.push_back(occluder);
  return {};
}

Status World::set_occluders(Strided<const Handle> handles, Strided<const OccluderPlacement> placements) {
  if (const Status stand = world::check_handles(*this, handles); !stand) return stand;
  if (!placements.sound())
    return {StatusCode::bad_argument, "world: the placements' pointer is null or their stride too short"};
  if (placements.size() != handles.size())
    return {StatusCode::bad_argument, "world: expected one occluder's placement a handle"};
  WorldOccluders& o = state_->own_occluders();
  for (std::size_t i = 0; i < placements.size(); ++i) {
    const OccluderPlacement placement = placements[i];
    if (placement.occluder == kNoOccluder) continue;
    if (!world::names_one(o, placement.occluder))
      return {StatusCode::bad_argument, "world: a placement names no occluder of this world", i};
    if (!world::is_affine(placement.transform) || !geometry::in_reach(placement.origin))
      return {StatusCode::bad_argument,
              "world: a placement is not finite, not affine or out of reach, expected the last row 0 0 0 1",
              i};
  }
  for (std::size_t i = 0; i < placements.size(); ++i) o.place(*state_, handles[i].index, placements[i]);
  return {};
}

Status World::set_occluding(Strided<const Handle> handles, Strided<const std::uint8_t> on) {
  if (const Status stand = world::check_handles(*this, handles); !stand) return stand;
  if (!on.sound())
    return {StatusCode::bad_argument, "world: the switches' pointer is null or their stride too short"};
  if (on.size() != handles.size())
    return {StatusCode::bad_argument, "world: expected one switch, 0 or 1, a handle"};
  for (std::size_t i = 0; i < on.size(); ++i)
    if (on[i] > 1) return {StatusCode::bad_argument, "world: a switch is neither 0 nor 1", i};
  WorldOccluders& o = state_->own_occluders();
  for (std::size_t i = 0; i < on.size(); ++i) {
    const std::uint32_t at = o.carrier(handles[i].index);
    if (at != kNothing) o.briefs[at].occluder = on[i] ? o.carriers[at].placement.occluder : kNoOccluder;
  }
  return {};
}

Status World::set_triangles(Handle handle, std::span<const Vec3> corners, const WorldPoint& origin,
                            Sides sides) {
  if (!contains(handle))
    return {StatusCode::stale_handle, "world: the handle names no object that stands in this world"};
  if (corners.size() % 3 != 0) return {StatusCode::bad_mesh, "world: expected three points a triangle"};
  if (corners.size() / 3 > std::size_t{1} << 30)
    return {StatusCode::too_many, "world: an object cannot have more than 2^30 triangles"};
  if (!geometry::in_reach(origin))
    return {StatusCode::bad_argument, "world: the triangles' origin is not finite or out of reach"};
  if (!occlusion::is_known(sides))
    return {StatusCode::bad_argument, "world: the triangles' sides are none, expected both or front"};
  state_->own_occluders().set_triangles(*state_, handle.index, corners, origin, sides);
  return {};
}

}  // namespace sightline
