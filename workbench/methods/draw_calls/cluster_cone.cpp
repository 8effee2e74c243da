// Beyond paper D: triangles grouped into clusters that lie together and face alike, each with bounds and a
// cone of normals in three dimensions, under a tree of bounds; the draws of clusters that stand side by side
// merged.
#include "workbench/methods/draw_calls/draw_call_method.hpp"
#include "workbench/methods/draw_calls/draw_calls.hpp"

namespace sightline::methods {

namespace {

constexpr std::array kClusterConeParameters{
    ParameterInfo{"size", "triangles a cluster, at most", "16", 4, 4096, true},
    ParameterInfo{"submission", "each cluster a call, all by one multi-draw, or neighbouring clusters merged",
                  "merged", 0, 0, false, "calls|multi-draw|merged"}};

std::unique_ptr<Method> make_cluster_cone(const MethodSite& site, const Parameters& parameters) {
  const Scene& scene = site.scene;
  DrawCallPlan plan;
  plan.clusters = true;
  plan.cluster_size = parameters.count("size");
  plan.facing = FacingRule::cone;
  plan.submission = submission_from(parameters);
  return std::make_unique<DrawCallMethod>(scene, plan);
}

}  // namespace

extern const MethodInfo kClusterCone{
    .name = "cluster-cone",
    .paper = "",
    .summary = "clusters of triangles with bounds and normal cones, neighbours merged",
    .cpu = {Guarantee::exact, kClusterConeParameters, make_cluster_cone, kFlattenNeeds, can_flatten}};

}  // namespace sightline::methods
