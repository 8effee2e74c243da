#include "workbench/measure/made_occluders.hpp"

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <span>

#include <sightline/occlusion.hpp>
#include <sightline/workbench/error.hpp>

#include "workbench/oracle/embree_judge.hpp"
#include "workbench/oracle/object_triangles.hpp"
#include "workbench/oracle/pixel_rays.hpp"
#include "workbench/scene/random.hpp"
#include "workbench/scene/shapes.hpp"

namespace sightline::measure {

namespace {

std::span<const Vec3> positions_of(const Scene& scene, std::uint32_t mesh) {
  return std::span(scene.positions).subspan(scene.meshes[mesh].first_vertex, scene.meshes[mesh].vertex_count);
}
std::span<const std::uint32_t> indices_of(const Scene& scene, std::uint32_t mesh) {
  return std::span(scene.indices).subspan(scene.meshes[mesh].first_index, scene.meshes[mesh].index_count);
}

// A mesh alone, where it was made, and who sees it.
struct Lone {
  Scene scene;
  Box bounds;
  bool hollow;  // nothing occludes inside, so it may be looked at from there
};

Lone lone_mesh(const Scene& scene, const MadeOccluder& made) {
  Lone out;
  out.scene.name = "mesh";
  const auto mesh = out.scene.add_mesh(positions_of(scene, made.mesh), {}, indices_of(scene, made.mesh));
  out.scene.add_object(mesh, {}, {Surface::opaque, made.sides});
  out.bounds = out.scene.bounds[0];
  out.hollow = made.occluder.solid_triangles == 0 && made.occluder.boxes.empty();
  return out;
}

Camera camera_around(const Lone& lone, scene::Random& random) {
  const Box& b = lone.bounds;
  const Vec3 middle{(b.min.x + b.max.x) / 2, (b.min.y + b.max.y) / 2, (b.min.z + b.max.z) / 2};
  const float radius = std::max(lone.scene.radius[0], 1e-6f);
  const Vec3 way = random.direction();
  const float away = radius * std::exp(random.between(0.2f, 2));
  Camera camera;
  camera.eye = {middle.x + away * way.x, middle.y + away * way.y, middle.z + away * way.z};
  camera.forward = {-way.x, -way.y, -way.z};
  camera.up = std::fabs(way.y) > 0.9f ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  camera.vertical_fov = 2 * std::asin(std::min(0.98f, radius / away));
  camera.near_plane = 0.1f * (away - radius);
  camera.far_plane = 2 * (away + radius);
  if (random.below(4) == 0) {
    camera.orthographic_height = 2 * radius;
    camera.near_plane = 0;
  } else if (lone.hollow && random.below(2) == 0) {
    camera.eye = random.inside(b);
    camera.forward = random.direction();
    camera.up = std::fabs(camera.forward.y) > 0.9f ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    camera.vertical_fov = 1.5f;
    camera.near_plane = 1e-3f * radius;
  }
  return camera;
}

// What was drawn into a buffer, against what rays see.
class Look {
public:
  Look(const Lone& lone, const oracle::EmbreeJudge& judge, const oracle::ObjectTriangles& exact,
       const Camera& camera, std::uint32_t pixels)
      : exact_(exact),
        view_(or_throw(make_view(camera, pixels, pixels))),
        rays_(view_),
        truth_(judge.render(view_)),
        nearness_(std::size_t{pixels} * pixels),
        slack_(1e-4 * (lone.scene.radius[0] + std::fabs(camera.eye.x) + std::fabs(camera.eye.y) +
                       std::fabs(camera.eye.z))) {
    const glm::dvec3 forward(camera.forward.x, camera.forward.y, camera.forward.z);
    forward_ = glm::normalize(forward);
    eye_ = {camera.eye.x, camera.eye.y, camera.eye.z};
    orthographic_ = camera.orthographic_height > 0;
  }

  [[nodiscard]] const oracle::ItemBuffer& truth() const { return truth_; }

  // How many pixels of the truth are covered; `wrong` counts those that must not be.
  template <class Draw>
  std::uint64_t count(Draw draw, std::uint64_t& wrong) {
    or_throw(buffer_.begin({view_, {}}, {Coverage::centres}));
    draw(buffer_);
    or_throw(buffer_.read_nearness(nearness_));
    std::uint64_t covered = 0;
    for (std::uint32_t y = 0; y < view_.height; ++y) {
      for (std::uint32_t x = 0; x < view_.width; ++x) {
        const std::size_t i = std::size_t{y} * view_.width + x;
        if (nearness_[i] == -std::numeric_limits<float>::infinity()) continue;
        const double depth = orthographic_ ? -double{nearness_[i]} : 1 / double{nearness_[i]};
        const bool seen = truth_.ids[i] == 0;
        covered += seen;
        if (seen && depth_at(x, y, truth_.distances[i]) <= depth + slack_) continue;
        // Rays in single precision slip through between triangles: only doubles may accuse.
        const auto met = exact_.meet(rays_.through(x, y));
        wrong += !met || depth_at(x, y, *met) > depth + slack_;
      }
    }
    return covered;
  }

private:
  // Along the view, of what lies so far from the near plane on a pixel's ray.
  [[nodiscard]] double depth_at(std::uint32_t x, std::uint32_t y, double distance) const {
    const oracle::PixelRay ray = rays_.through(x, y);
    return glm::dot(ray.origin + distance * ray.direction - eye_, forward_);
  }

  const oracle::ObjectTriangles& exact_;
  View view_;
  oracle::PixelRays rays_;
  oracle::ItemBuffer truth_;
  OcclusionBuffer buffer_;
  std::vector<float> nearness_;
  glm::dvec3 eye_, forward_;
  double slack_;
  bool orthographic_ = false;
};

// Appends what of an occluder is drawn from these sides; what has no triangle shows its boxes.
void append_part(const Occluder& occluder, Sides sides, scene::Shape& out) {
  for (std::size_t t = 0; t < occluder.sides.size(); ++t) {
    if (occluder.sides[t] != sides) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      out.indices.push_back(static_cast<std::uint32_t>(out.positions.size()));
      out.positions.push_back(occluder.positions[occluder.indices[3 * t + k]]);
    }
  }
  if (!occluder.indices.empty() || sides != Sides::front) return;
  for (const Box& box : occluder.boxes) out.append(scene::box(box));
}

}  // namespace

std::vector<MadeOccluder> make_occluders(const Scene& scene, const OccluderOptions& options,
                                         const Progress& progress) {
  std::map<std::pair<std::uint32_t, Sides>, std::size_t> shown;
  for (ObjectId o = 0; o < scene.size(); ++o) {
    if (scene.surface[o] == Surface::opaque) ++shown[{scene.mesh[o], scene.sides[o]}];
  }
  std::vector<MadeOccluder> out;
  for (const auto& [what, objects] : shown) {
    const auto [mesh, sides] = what;
    out.push_back(
        {mesh, sides, objects, indices_of(scene, mesh).size() / 3,
         or_throw(make_occluder(positions_of(scene, mesh), indices_of(scene, mesh), {&sides, 1}, options))});
    if (progress) progress(out.size(), shown.size());
  }
  return out;
}

Scene occluder_scene(const Scene& scene, const std::vector<MadeOccluder>& occluders) {
  constexpr std::uint32_t kNone = ~0u;
  Scene out;
  out.name = scene.name + " (occluders)";
  out.origin = scene.origin, out.viewpoints = scene.viewpoints;
  std::map<std::pair<std::uint32_t, Sides>, std::array<std::uint32_t, 2>> parts;
  for (const MadeOccluder& made : occluders) {
    auto& its = parts[{made.mesh, made.sides}];
    for (const Sides sides : {Sides::both, Sides::front}) {
      scene::Shape shape;
      append_part(made.occluder, sides, shape);
      its[sides == Sides::front] =
          shape.indices.empty() ? kNone : out.add_mesh(shape.positions, {}, shape.indices);
    }
  }
  for (ObjectId o = 0; o < scene.size(); ++o) {
    if (scene.surface[o] != Surface::opaque) continue;
    const auto& its = parts.at({scene.mesh[o], scene.sides[o]});
    for (const Sides sides : {Sides::both, Sides::front}) {
      if (its[sides == Sides::front] != kNone)
        out.add_object(its[sides == Sides::front], scene.transform[o], {Surface::opaque, sides});
    }
  }
  return out;
}

OccluderEvidence examine(const Scene& scene, const MadeOccluder& made, std::size_t views,
                         std::uint32_t pixels) {
  const Lone lone = lone_mesh(scene, made);
  const oracle::EmbreeJudge judge(lone.scene);
  const oracle::ObjectTriangles exact(lone.scene, 0);
  const OccluderMesh mesh =
      or_throw(OccluderMesh::make(made.occluder.positions, made.occluder.indices, made.occluder.sides));
  scene::Random random(20);
  OccluderEvidence out;
  for (std::size_t i = 0; i < views; ++i) {
    Look look(lone, judge, exact, camera_around(lone, random), pixels);
    out.mesh_pixels += look.truth().pixels[0];
    out.covered_pixels +=
        look.count([&](OcclusionBuffer& buffer) { or_throw(buffer.draw_mesh(mesh)); }, out.wrong_pixels);
    const std::span<const Box> boxes = made.occluder.boxes;
    out.box_pixels +=
        look.count([&](OcclusionBuffer& buffer) { or_throw(buffer.draw_boxes(boxes)); }, out.wrong_pixels);
  }
  return out;
}

}  // namespace sightline::measure
