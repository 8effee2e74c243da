// Beyond paper D, which leaves open how fine a structure should be: picks the structure, its height and the
// way of submission by what a call, a command and a triangle cost on the device at hand.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "methods/draw_calls/draw_call_method.hpp"
#include "methods/draw_calls/draw_calls.hpp"

namespace sightline::methods {

namespace {

constexpr std::array kParameters{
    ParameterInfo{"call-ns", "what a draw call costs on the device, nanoseconds", "1000", 0, 1e9},
    ParameterInfo{"command-ns", "what a command of a multi-draw costs, nanoseconds", "500", 0, 1e9},
    ParameterInfo{"triangle-ns", "what a triangle costs, nanoseconds", "100", 0, 1e9}};

// What looking at a node or handing over an object costs the CPU: small beside all of the above.
constexpr double kNodeNs = 20;

struct Costs {
  double call, command, triangle;

  [[nodiscard]] double of(const Frame& frame, Submission submission) const noexcept {
    const auto ranges = static_cast<double>(frame.draws.size());
    const double calls = submission == Submission::multi_draw ? call + command * ranges : call * ranges;
    return calls + triangle * static_cast<double>(frame.stats.triangles) +
           kNodeNs * static_cast<double>(frame.stats.nodes_visited + frame.visible.size());
  }
};

std::vector<DrawCallPlan> candidates(const Scene& scene) {
  constexpr std::uint64_t kMany = 2'000'000;  // a build takes seconds: only what suits so many
  const bool many = triangle_count(scene) > kMany;
  std::vector<DrawCallPlan> plans;
  for (const auto structure :
       {partition::Structure::grid, partition::Structure::octree, partition::Structure::kd_tree}) {
    for (const Strategy strategy : {Strategy::simple, Strategy::drawcall_wise, Strategy::zhang}) {
      for (std::uint32_t height = many ? 6 : 1; height <= 6; ++height) {
        DrawCallPlan plan;
        plan.structure = structure, plan.height = height, plan.strategy = strategy;
        plan.facing = strategy == Strategy::zhang ? FacingRule::cone : FacingRule::none;
        plans.push_back(plan);
      }
    }
  }
  for (std::uint32_t size = many ? 128 : 4; size <= 1024; size *= 2) {
    DrawCallPlan plan;
    plan.clusters = true, plan.cluster_size = size, plan.facing = FacingRule::cone;
    plans.push_back(plan);
  }
  return plans;
}

// Places where somebody may stand, and four ways to look from each.
std::vector<View> sample_views(const Scene& scene) {
  constexpr std::size_t kPlaces = 10;
  std::vector<Vec3> places;
  for (const Viewpoint& viewpoint : scene.viewpoints) places.push_back(viewpoint.eye);
  places.insert(places.end(), scene.waypoints.begin(), scene.waypoints.end());
  const Box all = extent(scene);
  const Vec3 middle{0.5f * (all.min.x + all.max.x), 0.5f * (all.min.y + all.max.y),
                    0.5f * (all.min.z + all.max.z)};
  if (places.empty()) places.push_back(middle);
  const float reach = std::hypot(all.max.x - all.min.x, all.max.y - all.min.y, all.max.z - all.min.z);
  std::vector<View> views;
  for (std::size_t i = 0; i < std::min(kPlaces, places.size()); ++i) {
    Camera camera;
    camera.eye = places[i * places.size() / std::min(kPlaces, places.size())];
    camera.far_plane = std::max(2 * reach, 1.0f);
    for (int quarter = 0; quarter < 4; ++quarter) {
      const float turn = 0.5f * std::numbers::pi_v<float> * static_cast<float>(quarter) + 0.3f;
      camera.forward = {std::sin(turn), 0, -std::cos(turn)};
      if (const Result<View> view = make_view(camera, 640, 360)) views.push_back(*view);
    }
  }
  return views;
}

Result<std::unique_ptr<Method>> make_method(const Scene& scene, const Parameters& parameters) {
  const Costs costs{parameters.number("call-ns"), parameters.number("command-ns"),
                    parameters.number("triangle-ns")};
  const std::vector<View> views = sample_views(scene);
  std::unique_ptr<DrawCallMethod> best;
  double best_cost = std::numeric_limits<double>::infinity();
  Frame frame;
  for (const DrawCallPlan& plan : candidates(scene)) {
    auto method = std::make_unique<DrawCallMethod>(scene, plan);
    Submission cheapest = Submission::multi_draw;
    double cost = std::numeric_limits<double>::infinity();
    for (const Submission submission : {Submission::multi_draw, Submission::merged}) {
      method->submit_by(submission);
      double sum = 0;
      for (const View& view : views) {
        method->cull(view, frame);
        sum += costs.of(frame, submission);
      }
      if (sum < cost) cost = sum, cheapest = submission;
    }
    if (best && cost >= best_cost) continue;
    method->submit_by(cheapest);
    best_cost = cost, best = std::move(method);
  }
  return std::unique_ptr<Method>(std::move(best));
}

}  // namespace

const MethodInfo kAdaptive{
    "adaptive",
    "",
    "the structure, height and submission that a device's costs of calls and triangles want",
    Guarantee::exact,
    kFlattenNeeds,
    kParameters,
    can_flatten,
    make_method};

}  // namespace sightline::methods
