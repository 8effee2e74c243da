// Layered, faulted and folded geology with the meshes and triangles of Ye et al. 2023, table 4, whose models
// are not public: every mesh is a closed piece of one stratum between two faults.
#include <array>

#include "workbench/scene/strata.hpp"
#include "workbench/scene/strata_plan.hpp"
#include "workbench/scene/worlds.hpp"

namespace sightline::scene {

namespace {

constexpr std::array kStrataParameters{
    ParameterInfo{"model", "of the paper's five: 1,371, 2,684, 4,433, 6,744 or 17,773 meshes", "1", 1, 5,
                  true},
    ParameterInfo{"triangles", "about how many in all; 0: a hundredth of the paper's", "0", 0, 1e9, true},
    ParameterInfo{"full", "as many triangles as the paper's model", "no", 0, 0, false, "no|yes"},
    ParameterInfo{"seed", "of the random numbers", "1", 0, 4294967295.0, true},
};

constexpr Vec3 kPaperViewpoint{40000, 0, 0};

Vec3 scaled(const Vec3& a) {
  return {kStrataScale * a.x, kStrataScale * a.y, kStrataScale * a.z};
}

StrataPlan plan_of(const Parameters& parameters) {
  const StrataModel& model = kStrataModels[parameters.count("model") - 1];
  double triangles = parameters.number("triangles");
  if (triangles == 0) triangles = model.triangles / 100;
  if (parameters.word("full") == "yes") triangles = model.triangles;
  return plan_strata(model, triangles, parameters.count("seed"));
}

Scene make_strata(const Parameters& parameters) {
  const StrataPlan plan = plan_of(parameters);
  Scene scene;
  StrataMesh mesh;
  for (const StrataPiece& piece : plan.pieces) {
    make_piece(plan.ground, piece, mesh);
    scene.add_object(scene.add_mesh(mesh.positions, mesh.normals, mesh.indices),
                     place(scaled(mesh.middle), kStrataScale));
  }

  // Centred on the origin, as the paper has it.
  const Box all = extent(scene);
  for (ObjectId object = 0; object < scene.size(); ++object) {
    Affine moved = scene.transform[object];
    moved.rows[0].w -= 0.5f * (all.min.x + all.max.x);
    moved.rows[1].w -= 0.5f * (all.min.y + all.max.y);
    moved.rows[2].w -= 0.5f * (all.min.z + all.max.z);
    scene.move_object(object, moved);
  }
  scene.viewpoints.push_back({"near",
                              scaled({0.1f * kStrataSide, 0.25f * kStrataSide, 0.8f * kStrataSide}),
                              {-0.1f, -0.25f, -0.6f}});
  scene.viewpoints.push_back({"far", kPaperViewpoint, {-1, 0, 0}});
  return scene;
}

}  // namespace

const WorldInfo kStrataWorld{"strata", "layered, faulted and folded ground (Ye et al. 2023)",
                             kStrataParameters, make_strata};

StrataCount count_strata(std::string_view specification) {
  const StrataPlan plan = plan_of(parse_parameters("world", specification, kStrataParameters));
  StrataCount count;
  for (const StrataPiece& piece : plan.pieces) {
    ++count.meshes;
    count.triangles += piece.triangles();
    count.vertices += piece.vertices();
  }
  return count;
}

}  // namespace sightline::scene
