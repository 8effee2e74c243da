// What the whole module has for worlds beside `core`: occluders that their objects carry.
#include <span>
#include <utility>
#include <vector>

#include "web/wasm/glue.hpp"
#include "web/wasm/web_world.hpp"

namespace sightline::web {

namespace {

// Bytes as JavaScript gives them; false where one is no side.
bool read_sides(std::span<const std::uint8_t> bytes, std::vector<Sides>& sides) {
  for (const std::uint8_t byte : bytes) {
    if (byte > 1) return false;
    sides.push_back(static_cast<Sides>(byte));
  }
  return true;
}

}  // namespace

extern "C" {

/// Spheres are four columns of `sphere_count` numbers. Writes the name to `result`.
SIGHTLINE_WEB(world_add_occluder)
std::uint32_t world_add_occluder(WebWorld* web, const Vec3* positions, std::size_t position_count,
                                 const std::uint32_t* indices, std::size_t index_count,
                                 const std::uint8_t* sides, std::size_t side_count,
                                 std::size_t solid_triangles, const Box* boxes, std::size_t box_count,
                                 const float* spheres, std::size_t sphere_count, double* result) {
  static_assert(sizeof(Box) == 24 && sizeof(Vec3) == 12 && sizeof(Sphere) == 16);
  Occluder occluder;
  if (!read_sides({sides, side_count}, occluder.sides))
    return keep({StatusCode::bad_argument, "occluder: a side is neither 0 (both) nor 1 (front)"});
  occluder.positions.assign(positions, positions + position_count);
  occluder.indices.assign(indices, indices + index_count);
  occluder.solid_triangles = solid_triangles;
  occluder.boxes.assign(boxes, boxes + box_count);
  std::vector<Sphere> solid(sphere_count);
  for (std::size_t i = 0; i < sphere_count; ++i) {
    solid[i] = {{spheres[i], spheres[sphere_count + i], spheres[2 * sphere_count + i]},
                spheres[3 * sphere_count + i]};
  }
  const auto added = web->world.add_occluder(occluder, solid);
  if (added) *result = *added;
  return keep(added.error());
}
SIGHTLINE_WEB(world_remove_occluder)
std::uint32_t world_remove_occluder(WebWorld* web, OccluderId occluder) {
  return keep(web->world.remove_occluder(occluder));
}
/// Names, matrices and origins, an element an object.
SIGHTLINE_WEB(world_set_occluders)
std::uint32_t world_set_occluders(WebWorld* web, const double* numbers, const OccluderId* occluders,
                                  const Mat4* transforms, const WorldPoint* origins, std::size_t count) {
  std::vector<OccluderPlacement> placements(count);
  for (std::size_t i = 0; i < count; ++i) {
    placements[i].occluder = occluders[i];
    if (transforms) placements[i].transform = transforms[i];
    if (origins) placements[i].origin = origins[i];
  }
  return keep(web->world.set_occluders(web->read(numbers, count), placements));
}
SIGHTLINE_WEB(world_set_occluding)
std::uint32_t world_set_occluding(WebWorld* web, const double* numbers, const std::uint8_t* on,
                                  std::size_t count) {
  return keep(web->world.set_occluding(web->read(numbers, count), Strided<const std::uint8_t>(on, count)));
}
SIGHTLINE_WEB(world_set_triangles)
std::uint32_t world_set_triangles(WebWorld* web, double number, const Vec3* corners, std::size_t count,
                                  double x, double y, double z, std::uint32_t sides) {
  return keep(web->world.set_triangles(web->read(&number, 1)[0], {corners, count}, {x, y, z},
                                       static_cast<Sides>(sides)));
}

}  // extern "C"

namespace {

// The library forgets both of a removed object by itself; of a retired one, which stays, they are taken here.
const bool kTakes = [] {
  take_occluders = [](World& world, std::span<const Handle> handles) {
    const std::vector<OccluderPlacement> none(handles.size());
    (void)world.set_occluders(handles, none);
    for (const Handle& handle : handles) (void)world.set_triangles(handle, {});
  };
  return true;
}();

}  // namespace

}  // namespace sightline::web
