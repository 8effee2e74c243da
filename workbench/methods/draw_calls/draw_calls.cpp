// The nine methods of Serpa, Serpa & Rodrigues: three submission strategies times three structures.
#include "workbench/methods/draw_calls/draw_calls.hpp"

#include "workbench/methods/draw_calls/draw_call_method.hpp"

namespace sightline::methods {

namespace {

using partition::Structure;

constexpr ParameterInfo kHeight{"height", "levels of splitting", "4", 1, 6, true};
constexpr ParameterInfo kSubmission{"submission",
                                    "each range a call, all by one multi-draw, or neighbouring ranges merged",
                                    "calls",
                                    0,
                                    0,
                                    false,
                                    "calls|multi-draw|merged"};
constexpr ParameterInfo kFacing{
    "facing", "the safe rule for each cell, or the paper's as printed", "cone", 0, 0, false, "cone|printed"};
constexpr std::array kPlainParameters{kHeight, kSubmission};
constexpr std::array kZhangParameters{kHeight, kSubmission, kFacing};

template <Structure S, Strategy V>
std::unique_ptr<Method> make_method(const MethodSite& site, const Parameters& parameters) {
  const Scene& scene = site.scene;
  DrawCallPlan plan;
  plan.structure = S;
  plan.strategy = V;
  plan.height = parameters.count("height");
  plan.submission = submission_from(parameters);
  if (V == Strategy::zhang)
    plan.facing = parameters.word("facing") == "cone" ? FacingRule::cone : FacingRule::printed;
  return std::make_unique<DrawCallMethod>(scene, plan);
}

constexpr std::array<std::array<std::string_view, 3>, 3> kNames{
    {{"simple-grid", "simple-octree", "simple-kd-tree"},
     {"drawcall-wise-grid", "drawcall-wise-octree", "drawcall-wise-kd-tree"},
     {"zhang-grid", "zhang-octree", "zhang-kd-tree"}}};
constexpr std::array<std::string_view, 3> kSummaries{
    "triangles in cells; each contiguous run of a visible cell is a draw call",
    "triangles in cells, a copy for each; one draw call a visible cell",
    "drawcall-wise with each cell in nine parts by facing; parts that cannot face the eye are dropped"};

template <std::size_t V, std::size_t S>
constexpr MethodInfo info() {
  const auto parameters = V == 2 ? std::span<const ParameterInfo>(kZhangParameters)
                                 : std::span<const ParameterInfo>(kPlainParameters);
  return {
      .name = kNames[V][S],
      .paper = "D: Serpa, Serpa & Rodrigues",
      .summary = kSummaries[V],
      .cpu = {Guarantee::exact, parameters, make_method<static_cast<Structure>(S), static_cast<Strategy>(V)>,
              kFlattenNeeds, can_flatten}};
}

template <std::size_t... I>
constexpr std::array<MethodInfo, sizeof...(I)> product(std::index_sequence<I...>) {
  return {info<I / 3, I % 3>()...};
}

}  // namespace

Submission submission_from(const Parameters& parameters) noexcept {
  const std::string_view word = parameters.word("submission");
  for (const Submission submission : {Submission::multi_draw, Submission::merged}) {
    if (word == to_string(submission)) return submission;
  }
  return Submission::calls;
}

extern const std::array<MethodInfo, 9> kDrawCallMethods = product(std::make_index_sequence<9>{});

}  // namespace sightline::methods
