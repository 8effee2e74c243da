// What `adaptive` gives a try: for every price of a call, reckoned in triangles, the plan that would be
// cheapest over sample views; and clusters of three sizes, and of each structure the cheapest at three
// prices, for the reckoning takes all triangles alike, and they are not.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>

#include "library/geometry/elementary.hpp"
#include "workbench/methods/draw_calls/adaptive.hpp"
#include "workbench/methods/draw_calls/draw_calls.hpp"

namespace sightline::methods {

namespace {

constexpr std::array kAdaptiveParameters{
    ParameterInfo{"call-ns", "what a draw call may cost, nanoseconds; decides what is tried first", "1000", 0,
                  1e9},
    ParameterInfo{"command-ns", "what a command of a multi-draw may cost, nanoseconds", "500", 0, 1e9},
    ParameterInfo{"triangle-ns", "what a triangle may cost, nanoseconds", "100", 0, 1e9}};

// What looking at a node or handing over an object costs the CPU, measured in levels with cold caches.
constexpr double kNodeNs = 50;

constexpr std::uint64_t kMany = 2'000'000;  // triangles at which a build takes seconds, and memory is dear

struct Costs {
  double call, command, triangle;
};

constexpr Costs kFreeCommands{1600, 0, 100};  // a device that reads the commands of a multi-draw by itself

/// Sums over the sample views.
struct Reckoning {
  DrawCallPlan plan;
  double commands = 0, merged_calls = 0, views = 0, triangles = 0, visits = 0;

  [[nodiscard]] double as(Submission submission, const Costs& costs) const noexcept {
    const double calls = submission == Submission::merged ? costs.call * merged_calls
                                                          : costs.call * views + costs.command * commands;
    return calls + costs.triangle * triangles + kNodeNs * visits;
  }
  [[nodiscard]] double at(const Costs& costs) const noexcept {
    return std::min(as(Submission::merged, costs), as(Submission::multi_draw, costs));
  }
};

std::vector<DrawCallPlan> candidates(bool many) {
  constexpr std::uint32_t kHighest = 6;
  constexpr std::uint32_t kStops = 3;  // lower trees are split to their height by either rule, or nearly
  std::vector<DrawCallPlan> plans;
  const auto add = [&](partition::Structure structure, Strategy strategy, std::uint32_t height,
                       std::uint32_t least) {
    DrawCallPlan plan;
    plan.structure = structure, plan.height = height, plan.strategy = strategy, plan.cells.least = least;
    plan.facing = strategy == Strategy::zhang ? FacingRule::cone : FacingRule::none;
    plans.push_back(plan);
  };
  for (const auto structure :
       {partition::Structure::grid, partition::Structure::octree, partition::Structure::kd_tree}) {
    for (const Strategy strategy : {Strategy::simple, Strategy::drawcall_wise, Strategy::zhang}) {
      for (std::uint32_t height = many ? kHighest : 1; height <= kHighest; ++height) {
        add(structure, strategy, height, partition::kCallsWorth);
        if (!many && height >= kStops) add(structure, strategy, height, 0);  // where calls are cheap
      }
    }
  }
  // Finer ones gain a few per cent at most while the caches are theirs, and lose ten where others use them
  // too.
  for (std::uint32_t size = many ? 128 : 16; size <= 1024; size *= 2) {
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
      camera.forward = {portable::sin(turn), 0, -portable::cos(turn)};
      if (const Result<View> view = make_view(camera, 640, 360)) views.push_back(*view);
    }
  }
  return views;
}

std::vector<Reckoning> reckon(const Scene& scene, bool many) {
  const std::vector<View> views = sample_views(scene);
  std::vector<Reckoning> all;
  Frame frame;
  for (const DrawCallPlan& plan : candidates(many)) {
    DrawCallMethod method(scene, plan);
    Reckoning sums{plan};
    sums.views = static_cast<double>(views.size());
    for (const Submission submission : {Submission::multi_draw, Submission::merged}) {
      method.submit_by(submission);
      for (const View& view : views) {
        method.cull(view, frame);
        (submission == Submission::merged ? sums.merged_calls : sums.commands) +=
            static_cast<double>(frame.draws.size());
        if (submission == Submission::multi_draw) continue;
        sums.triangles += static_cast<double>(frame.stats.triangles);
        sums.visits += static_cast<double>(frame.stats.nodes_visited + frame.visible.size());
      }
    }
    all.push_back(sums);
  }
  return all;
}

template <class Suits>
const Reckoning* cheapest(const std::vector<Reckoning>& all, const Costs& costs, Suits suits) {
  const Reckoning* best = nullptr;
  for (const Reckoning& one : all) {
    if (suits(one.plan) && (!best || one.at(costs) < best->at(costs))) best = &one;
  }
  return best;
}

Costs calls_worth(double triangles) {
  return {100 * triangles, 50 * triangles, 100};
}

std::vector<DrawCallPlan> plans_of(const std::vector<const Reckoning*>& chosen) {
  std::vector<DrawCallPlan> plans;
  for (const Reckoning* one : chosen) plans.push_back(one->plan);
  return plans;
}

bool wants_merged(const Reckoning& one, const Costs& given) {
  return one.as(Submission::merged, given) <= one.as(Submission::multi_draw, given);
}

// Each plan submitted as the given prices want it; those of the most commands, to which it matters most, the
// other way as well.
std::vector<Adaptive::Way> ways_of(const std::vector<const Reckoning*>& chosen, const Costs& given) {
  constexpr std::size_t kBothWays = 2;
  std::vector<Adaptive::Way> ways;
  const auto add = [&](std::size_t plan, bool merged) {
    ways.push_back({static_cast<std::uint32_t>(plan), merged ? Submission::merged : Submission::multi_draw});
  };
  for (std::size_t plan = 0; plan < chosen.size(); ++plan) add(plan, wants_merged(*chosen[plan], given));
  std::vector<std::size_t> by_commands(chosen.size());
  std::iota(by_commands.begin(), by_commands.end(), std::size_t{0});
  std::ranges::stable_sort(by_commands, std::greater<>(), [&](std::size_t p) { return chosen[p]->commands; });
  for (std::size_t i = 0; i < std::min(kBothWays, by_commands.size()); ++i)
    add(by_commands[i], !wants_merged(*chosen[by_commands[i]], given));
  // Of two alike the coarser is to be preferred: it leaves more of the caches to others.
  std::ranges::stable_sort(ways, {}, [&](const Adaptive::Way& way) { return chosen[way.plan]->commands; });
  return ways;
}

std::unique_ptr<Method> make_adaptive(const MethodSite& site, const Parameters& parameters) {
  const Scene& scene = site.scene;
  const Costs given{parameters.number("call-ns"), parameters.number("command-ns"),
                    parameters.number("triangle-ns")};
  const bool many = triangle_count(scene) > kMany;
  const std::vector<Reckoning> all = reckon(scene, many);
  std::vector<const Reckoning*> chosen;
  const auto choose = [&](const Reckoning* one) {
    if (one && std::ranges::find(chosen, one) == chosen.end()) chosen.push_back(one);
  };
  const auto any = [](const DrawCallPlan&) { return true; };
  choose(cheapest(all, given, any));
  for (const double price : {16.0, 64.0, 4.0, 256.0, 1.0, 0.25})
    choose(cheapest(all, calls_worth(price), any));
  for (const std::uint32_t least : {partition::kCallsWorth, std::uint32_t{0}}) {
    choose(cheapest(all, kFreeCommands, [least](const DrawCallPlan& plan) {
      return !plan.clusters && plan.cells.least == least;
    }));
  }
  for (const std::uint32_t size : {16, 64, 256}) {
    choose(cheapest(all, given,
                    [size](const DrawCallPlan& plan) { return plan.clusters && plan.cluster_size == size; }));
  }
  for (const double price : {16.0, 64.0, 256.0}) {
    for (const auto structure :
         {partition::Structure::grid, partition::Structure::octree, partition::Structure::kd_tree}) {
      choose(cheapest(all, calls_worth(price), [&](const DrawCallPlan& plan) {
        return !plan.clusters && plan.structure == structure;
      }));
    }
  }
  if (many) chosen.resize(std::min<std::size_t>(chosen.size(), 2));
  std::vector<Adaptive::Way> ways = ways_of(chosen, given);
  const Submission wanted = wants_merged(*chosen[0], given) ? Submission::merged : Submission::multi_draw;
  const auto first = std::ranges::find_if(
      ways, [&](const Adaptive::Way& way) { return way.plan == 0 && way.submission == wanted; });
  const auto at = static_cast<std::uint32_t>(first - ways.begin());
  return std::make_unique<Adaptive>(scene, plans_of(chosen), std::move(ways), at);
}

}  // namespace

extern const MethodInfo kAdaptive{
    .name = "adaptive",
    .paper = "",
    .summary = "the structure, height and submission whose frames turn out quickest, told what they took",
    .cpu = {Guarantee::exact, kAdaptiveParameters, make_adaptive, kFlattenNeeds, can_flatten}};

}  // namespace sightline::methods
