#include "workbench/methods/raster_occlusion/scene_occluders.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

#include <sightline/boxes.hpp>
#include <sightline/frustum.hpp>
#include <sightline/workbench/error.hpp>

#include "library/geometry/mutant.h"
#include "workbench/methods/raster_occlusion/occluder_proxy.hpp"

namespace sightline::methods {

SceneOccluders::SceneOccluders(const Scene& scene, const OccluderChoice& choice)
    : scene_(scene), choice_(choice), moved_(scene.size(), 0), seen_(scene.size()) {
  // Objects that share few meshes are instances, whose triangles would be too many in one.
  const bool one_thing = 2 * scene.meshes.size() >= scene.size();
  if (one_thing && triangle_count(scene) <= choice.whole) {
    usable_ = take_triangles();
    build_whole();
  } else {
    find_occluders();
    extent_ = extent(scene);
  }
}

void SceneOccluders::update(std::span<const ObjectId> objects) {
  bool first_time = false;
  for (const ObjectId o : objects) {
    first_time = first_time || !moved_[o];
    moved_[o] = 1;
  }
  if (!whole_) {
    extent_ = extent(scene_);
    return;
  }
  for (const ObjectId o : objects) {
    corners_.clear();
    append_corners(o);
    usable_ = occludees_.set(o, corners_) && usable_;
  }
  if (first_time && !SIGHTLINE_MUTANT(stale_occluders)) build_whole();
}

bool SceneOccluders::draw(const WorldView& at, std::span<const ObjectId> candidates) {
  if (!buffer_.begin(at, choice_.buffer)) return false;
  // What is refused is not drawn, and hides nothing.
  if (whole_) {
    static_cast<void>(buffer_.draw_mesh(*whole_));
    return true;
  }
  pick_occluders(at.view, candidates);
  draw_picked_spheres();
  draw_picked_meshes();
  return true;
}

std::size_t SceneOccluders::keep_seen(std::span<ObjectId> visible) {
  return whole_ ? buffer_.keep_seen(occludees_, visible) : keep_seen_spheres(visible);
}

std::size_t SceneOccluders::keep_unhidden(std::span<ObjectId> visible) {
  constexpr std::size_t kBatch = 256;
  std::array<Box, kBatch> boxes;
  std::size_t kept = 0;
  for (std::size_t first = 0; first < visible.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, visible.size() - first);
    for (std::size_t i = 0; i < count; ++i) boxes[i] = scene_.bounds[visible[first + i]];
    const BoxView view = BoxView::min_max(&boxes[0].min.x, sizeof(Box), count);
    const bool asked = static_cast<bool>(buffer_.may_see(view, seen_));
    for (std::size_t i = 0; i < count; ++i) {
      visible[kept] = visible[first + i];
      kept += !asked || seen_[i];
    }
  }
  return keep_seen(visible.first(kept));
}

bool SceneOccluders::occludes(ObjectId o) const noexcept {
  return choice_.all_solid || scene_.surface[o] == Surface::opaque;
}
Sides SceneOccluders::sides_of(ObjectId o) const noexcept {
  return choice_.all_solid ? Sides::both : scene_.sides[o];
}

// Three corners a triangle, in world space, counter-clockwise from its front.
void SceneOccluders::append_corners(ObjectId o) {
  const Mesh& mesh = scene_.meshes[scene_.mesh[o]];
  const std::size_t first = corners_.size();
  for (const std::uint32_t i : std::span(scene_.indices).subspan(mesh.first_index, mesh.index_count))
    corners_.push_back(transform_point(scene_.transform[o], scene_.positions[mesh.first_vertex + i]));
  if (!mirrors(scene_.transform[o])) return;
  for (std::size_t i = first; i < corners_.size(); i += 3) std::swap(corners_[i + 1], corners_[i + 2]);
}

bool SceneOccluders::take_triangles() {
  std::vector<std::uint32_t> counts;
  std::vector<Sides> sides;
  for (ObjectId o = 0; o < scene_.size(); ++o) {
    append_corners(o);
    counts.push_back(static_cast<std::uint32_t>(scene_.triangles(o)));
    sides.push_back(sides_of(o));
  }
  return static_cast<bool>(occludees_.assign(corners_, counts, sides));
}

// All opaque objects that never moved, in world space, so that their seams are joined across objects.
void SceneOccluders::build_whole() {
  corners_.clear();
  std::vector<Sides> sides;
  for (ObjectId o = 0; o < scene_.size(); ++o) {
    if (moved_[o] || !occludes(o)) continue;
    append_corners(o);
    sides.resize(corners_.size() / 3, sides_of(o));
  }
  std::vector<std::uint32_t> indices(corners_.size());
  std::iota(indices.begin(), indices.end(), 0u);
  whole_ = or_throw(OccluderMesh::make(corners_, indices, sides));
}

// What an object is drawn as: by its mesh, and the sides of it that are drawn.
std::size_t SceneOccluders::occluder_of(ObjectId o) const noexcept {
  return 2 * std::size_t{scene_.mesh[o]} + (sides_of(o) == Sides::front);
}

void SceneOccluders::find_occluders() {
  std::vector<std::uint8_t> asked(2 * scene_.meshes.size(), 0);
  for (ObjectId o = 0; o < scene_.size(); ++o) asked[occluder_of(o)] |= occludes(o);
  occluders_.resize(asked.size());
  for (std::size_t i = 0; i < occluders_.size(); ++i) {
    if (!asked[i]) continue;
    const Mesh& mesh = scene_.meshes[i / 2];
    const Sides sides = i % 2 == 0 ? Sides::both : Sides::front;
    const auto positions = std::span(scene_.positions).subspan(mesh.first_vertex, mesh.vertex_count);
    const auto indices = std::span(scene_.indices).subspan(mesh.first_index, mesh.index_count);
    occluders_[i].whole = or_throw(OccluderMesh::make(positions, indices, sides));
    occluders_[i].sphere = inner_sphere(positions, indices, sides);
    if (!occluders_[i].sphere) occluders_[i].proxy = occluder_proxy(positions, indices, sides);
  }
}

void SceneOccluders::pick_occluders(const View& view, std::span<const ObjectId> candidates) {
  const Projector projector = make_projector(view, extent_);
  // The frustum's planes are moved outwards by some 1e-6 of the distances from the eye and the origin; what
  // the true near plane cuts must not pass for whole.
  const Plane front = make_frustum(view).planes[Frustum::front];
  const float eye_reach =
      std::fabs(projector.eye.x) + std::fabs(projector.eye.y) + std::fabs(projector.eye.z);
  picked_.clear(), near_first_.clear(), drawn_spheres_.clear();
  for (const ObjectId o : candidates) {
    if (!occludes(o)) continue;
    const Sphere sphere = scene_.sphere(o);
    const float area = projected_area(projector, sphere);
    const Vec3 to{sphere.centre.x - projector.eye.x, sphere.centre.y - projector.eye.y,
                  sphere.centre.z - projector.eye.z};
    const float distance = to.x * to.x + to.y * to.y + to.z * to.z;
    const float moved = 1e-5f * (eye_reach + std::fabs(to.x) + std::fabs(to.y) + std::fabs(to.z));
    const bool cut = signed_distance(front, sphere.centre.x, sphere.centre.y, sphere.centre.z) <=
                     sphere.radius * (1 + 1e-4f) + moved;
    if (!cut && occluders_[occluder_of(o)].sphere) {
      if (area >= choice_.least_sphere)
        near_first_.push_back(std::uint64_t{std::bit_cast<std::uint32_t>(distance)} << 32 | o);
    } else if (area >= choice_.least_area) {
      picked_.push_back({area, distance, o, cut});
    }
  }
}

void SceneOccluders::draw_picked_spheres() {
  std::sort(near_first_.begin(), near_first_.end());
  for (const std::uint64_t key : near_first_) {
    const auto o = static_cast<ObjectId>(key);
    drawn_spheres_.push_back(sphere_inside(scene_.transform[o], *occluders_[occluder_of(o)].sphere));
  }
  static_cast<void>(buffer_.draw_spheres(std::span<const Sphere>(drawn_spheres_)));
}

void SceneOccluders::draw_picked_meshes() {
  if (picked_.size() > choice_.most) {
    std::nth_element(picked_.begin(), picked_.begin() + choice_.most, picked_.end(),
                     [](const Picked& a, const Picked& b) {
                       return a.area != b.area ? a.area > b.area : a.object < b.object;
                     });
    picked_.resize(choice_.most);
  }
  std::sort(picked_.begin(), picked_.end(), [](const Picked& a, const Picked& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.object < b.object;
  });
  for (const Picked& picked : picked_) {
    const Occluder& occluder = occluders_[occluder_of(picked.object)];
    // What stands in for a mesh lies inside it, so of one that the near plane cuts it would still show a
    // front where the inside is seen: such a mesh is drawn as it is.
    const bool simply = occluder.proxy && !picked.cut;
    static_cast<void>(buffer_.draw_mesh(simply ? *occluder.proxy : *occluder.whole,
                                        to_matrix(scene_.transform[picked.object])));
  }
}

std::size_t SceneOccluders::keep_seen_spheres(std::span<ObjectId> visible) {
  constexpr std::size_t kBatch = 256;
  std::array<float, kBatch> x, y, z, radius;
  std::size_t kept = 0;
  for (std::size_t first = 0; first < visible.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, visible.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      const Sphere sphere = scene_.sphere(visible[first + i]);
      x[i] = sphere.centre.x, y[i] = sphere.centre.y, z[i] = sphere.centre.z, radius[i] = sphere.radius;
    }
    const auto spheres = SphereView::arrays(x.data(), y.data(), z.data(), radius.data(), count);
    const bool asked = static_cast<bool>(buffer_.may_see(spheres, seen_));
    for (std::size_t i = 0; i < count; ++i) {
      visible[kept] = visible[first + i];
      kept += !asked || seen_[i];
    }
  }
  return kept;
}

}  // namespace sightline::methods
