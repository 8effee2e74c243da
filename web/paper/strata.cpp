// The five models of strata for the page: a module of its own, which makes a mesh at a time.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <sightline/workbench/affine.hpp>

#include "web/wasm/glue.hpp"
#include "workbench/scene/strata_plan.hpp"

namespace sightline::web {

namespace {

using namespace scene;

// As web/page/models/renderer.js reads it: 20 bytes.
struct Vertex {
  Vec3 position;
  std::int8_t normal[4];
  std::uint32_t object;
};
static_assert(sizeof(Vertex) == 20);

struct Model {
  std::optional<StrataPlan> plan;
  StrataMesh mesh;
  std::vector<Vertex> vertices;
  std::vector<Box> boxes;  // of the objects; before centring about the meshes' own middles
  std::vector<Vec3> middles;
} model;

Affine placed(const Vec3& middle) {
  return {{Vec4{kStrataScale, 0, 0, middle.x}, Vec4{0, kStrataScale, 0, middle.y},
           Vec4{0, 0, kStrataScale, middle.z}}};
}

Box united(const Box& a, const Box& b) {
  return {{std::min(a.min.x, b.min.x), std::min(a.min.y, b.min.y), std::min(a.min.z, b.min.z)},
          {std::max(a.max.x, b.max.x), std::max(a.max.y, b.max.y), std::max(a.max.z, b.max.z)}};
}

// Rounding keeps order, so that the corners' box is the box of all vertices.
Box moved(const Box& box, const Vec3& middle) {
  return {transform_point(placed(middle), box.min), transform_point(placed(middle), box.max)};
}

std::int8_t in_a_byte(float x) {
  return static_cast<std::int8_t>(std::lround(127 * x));
}

void make(std::uint32_t piece) {
  make_piece(model.plan->ground, model.plan->pieces[piece], model.mesh);
  const auto& [middle, positions, normals, indices] = model.mesh;
  const Vec3 at{kStrataScale * middle.x, kStrataScale * middle.y, kStrataScale * middle.z};
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Box box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  model.vertices.clear();
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const Vec3& n = normals[v];
    box = united(box, {positions[v], positions[v]});
    model.vertices.push_back({transform_point(placed(at), positions[v]),
                              {in_a_byte(n.x), in_a_byte(n.y), in_a_byte(n.z), 0},
                              piece});
  }
  model.boxes[piece] = box, model.middles[piece] = at;
}

}  // namespace

extern "C" {

/// Plans a model, 1 to 5, of about so many triangles; returns its meshes.
SIGHTLINE_WEB(plan) std::uint32_t plan(std::uint32_t number, double triangles, std::uint32_t seed) {
  model = {};
  model.plan.emplace(plan_strata(kStrataModels[number - 1], triangles, seed));
  model.boxes.resize(model.plan->pieces.size()), model.middles.resize(model.boxes.size());
  return static_cast<std::uint32_t>(model.boxes.size());
}
/// Meshes of the model.
SIGHTLINE_WEB(count) std::uint32_t count() {
  return static_cast<std::uint32_t>(model.boxes.size());
}
/// The paper's triangles.
SIGHTLINE_WEB(paper_triangles) double paper_triangles(std::uint32_t number) {
  return kStrataModels[number - 1].triangles;
}
/// Vertices, indices and layer of a mesh to be.
SIGHTLINE_WEB(piece_vertices) std::uint32_t piece_vertices(std::uint32_t piece) {
  return static_cast<std::uint32_t>(model.plan->pieces[piece].vertices());
}
SIGHTLINE_WEB(piece_indices) std::uint32_t piece_indices(std::uint32_t piece) {
  return static_cast<std::uint32_t>(3 * model.plan->pieces[piece].triangles());
}
SIGHTLINE_WEB(piece_layer) std::uint32_t piece_layer(std::uint32_t piece) {
  return model.plan->pieces[piece].layer;
}
/// Makes a mesh, to be read before the next is made.
SIGHTLINE_WEB(make_mesh) void make_mesh(std::uint32_t piece) {
  make(piece);
}
SIGHTLINE_WEB(vertices) const Vertex* vertices() {
  return model.vertices.data();
}
SIGHTLINE_WEB(indices) const std::uint32_t* indices() {
  return model.mesh.indices.data();
}
/// Once all meshes are made: writes what centres them on the origin, which vertices lack, and returns all
/// boxes with it.
SIGHTLINE_WEB(centre) const Box* centre(float* offset) {
  Box all = moved(model.boxes[0], model.middles[0]);
  for (std::size_t i = 1; i < model.boxes.size(); ++i)
    all = united(all, moved(model.boxes[i], model.middles[i]));
  const float by[] = {0.5f * (all.min.x + all.max.x), 0.5f * (all.min.y + all.max.y),
                      0.5f * (all.min.z + all.max.z)};
  for (std::size_t i = 0; i < model.boxes.size(); ++i) {
    Vec3& m = model.middles[i];
    m = {m.x - by[0], m.y - by[1], m.z - by[2]};
    model.boxes[i] = moved(model.boxes[i], m);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) offset[axis] = -by[axis];
  return model.boxes.data();
}
/// Room for centre()'s numbers.
SIGHTLINE_WEB(scratch) float* scratch() {
  static float numbers[4];
  return numbers;
}

}  // extern "C"

}  // namespace sightline::web
