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
constexpr ParameterInfo kLeast{"least",
                               "a tree's node of fewer triangles than this for each child stays whole; 0 "
                               "splits every node to the height, as the paper does",
                               "0",
                               0,
                               1e6,
                               true};
constexpr ParameterInfo kCells{"cells",
                               "the cells as the paper has them: regions, those of a grid as high as the "
                               "scene; or boxes around what shows in a cell",
                               "printed",
                               0,
                               0,
                               false,
                               "printed|tight"};
constexpr ParameterInfo kOcclusion{
    "occlusion",
    "masked: what opaque triangles hide of cells in view is not drawn, found on "
    "the CPU as the method masked does it",
    "none",
    0,
    0,
    false,
    "none|masked"};
constexpr ParameterInfo kPlanes{"planes",
                                "where normals are told apart: on x-z, on x-y, or on x-z and what is too "
                                "steep there on x-y",
                                "xz",
                                0,
                                0,
                                false,
                                "xz|xy|both"};
constexpr std::array kSimpleParameters{kHeight, kSubmission, kLeast, kCells};
constexpr std::array kDrawcallWiseParameters{kHeight, kSubmission, kLeast, kCells, kOcclusion};
constexpr std::array kZhangParameters{kHeight, kSubmission, kLeast, kCells, kFacing, kPlanes};
constexpr std::array<std::span<const ParameterInfo>, 3> kParameters{
    kSimpleParameters, kDrawcallWiseParameters, kZhangParameters};

PartPlanes planes_from(std::string_view word) {
  return word == "xz" ? PartPlanes::xz : word == "xy" ? PartPlanes::xy : PartPlanes::both;
}

template <Structure S, Strategy V>
std::unique_ptr<Method> make_method(const MethodSite& site, const Parameters& parameters) {
  const Scene& scene = site.scene;
  DrawCallPlan plan;
  plan.structure = S;
  plan.strategy = V;
  plan.height = parameters.count("height");
  plan.submission = submission_from(parameters);
  plan.cells.least = parameters.count("least");
  plan.cells.printed = parameters.word("cells") == "printed";
  if (V == Strategy::drawcall_wise) plan.occlusion = parameters.word("occlusion") == "masked";
  if (V == Strategy::zhang) {
    plan.facing = parameters.word("facing") == "cone" ? FacingRule::cone : FacingRule::printed;
    plan.planes = planes_from(parameters.word("planes"));
  }
  return std::make_unique<DrawCallMethod>(scene, plan);
}

constexpr std::array<std::array<std::string_view, 3>, 3> kNames{
    {{"simple-grid", "simple-octree", "simple-kd-tree"},
     {"drawcall-wise-grid", "drawcall-wise-octree", "drawcall-wise-kd-tree"},
     {"zhang-grid", "zhang-octree", "zhang-kd-tree"}}};
constexpr std::array<std::string_view, 3> kSummaries{
    "triangles in cells; each contiguous run of a visible cell is a draw call",
    "triangles in cells, a copy for each; one draw call a visible cell",
    "drawcall-wise with each cell in parts by facing; parts that cannot face the eye are dropped"};

template <std::size_t V, std::size_t S>
constexpr MethodInfo info() {
  return {
      .name = kNames[V][S],
      .paper = "D: Serpa, Serpa & Rodrigues",
      .summary = kSummaries[V],
      .cpu = {Guarantee::exact, kParameters[V],
              make_method<static_cast<Structure>(S), static_cast<Strategy>(V)>, kFlattenNeeds, can_flatten}};
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
