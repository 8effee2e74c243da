#include "workbench/measure/verify.hpp"

#include <fmt/format.h>

#include <algorithm>

#include <sightline/workbench/error.hpp>

#include "workbench/camera/path_file.hpp"
#include "workbench/oracle/embree_judge.hpp"
#include "workbench/oracle/loss.hpp"
#include "workbench/oracle/triangle_judge.hpp"

namespace sightline::measure {
namespace {

/// One is enough to show where an approximate method gives way; a defect wants several.
std::size_t examples_wanted(Guarantee guarantee) {
  return guarantee == Guarantee::approximate ? 1 : 10;
}

}  // namespace

bool Verification::passed() const noexcept {
  return std::all_of(methods.begin(), methods.end(), [](const MethodVerdict& m) { return m.holds(); });
}

Verification verify(const Scene& scene, std::span<const Contestant> contestants,
                    std::span<const Camera> cameras, std::uint32_t width, std::uint32_t height,
                    const Progress& progress) {
  const oracle::EmbreeJudge judge(scene);
  oracle::TriangleJudge triangle_judge(scene);
  Verification result;
  result.scene = scene.name;
  for (const Contestant& contestant : contestants) {
    MethodVerdict verdict;
    verdict.method = contestant.name;
    verdict.guarantee = contestant.method->guarantee();
    result.methods.push_back(std::move(verdict));
  }
  Frame frame;
  for (std::size_t v = 0; v < cameras.size(); ++v) {
    const View view = or_throw(make_view(cameras[v], width, height));
    const oracle::ItemBuffer truth = judge.render(view);
    const std::size_t visible = truth.visible_count();
    for (std::size_t m = 0; m < contestants.size(); ++m) {
      MethodVerdict& verdict = result.methods[m];
      frame.clear();
      contestants[m].method->cull(view, frame);
      oracle::Loss loss;
      std::size_t truly_visible = visible;
      if (const TriangleGeometry* geometry = contestants[m].method->geometry()) {
        oracle::TriangleJudge::Verdict found = triangle_judge.judge(view, *geometry, frame);
        loss = std::move(found.loss), truly_visible = found.truly_visible;
      } else {
        loss = oracle::confirmed_loss(judge, view, truth, frame.visible);
      }
      verdict.kept += frame.visible.size();
      verdict.visible += truly_visible;
      verdict.lost_objects += loss.lost.size();
      verdict.lost_pixels += loss.lost_pixels;
      verdict.excess_objects += loss.excess.size();
      if (loss.lost.empty()) continue;
      ++verdict.views_with_loss;
      if (verdict.examples.size() < examples_wanted(verdict.guarantee)) {
        verdict.examples.push_back({v, cameras[v], width, height, loss.lost.front(), loss.lost_pixels});
      }
    }
    ++result.views;
    if (progress) progress(v + 1, cameras.size());
  }
  return result;
}

std::string describe(const MethodVerdict& verdict, const LostObject& lost) {
  return fmt::format("{} ({}) lost object {} in view {} ({} pixels lost in this view); the view, {}x{}: {}",
                     verdict.method, to_string(verdict.guarantee), lost.object, lost.view, lost.pixels,
                     lost.width, lost.height, camera::camera_json(lost.camera).dump());
}

}  // namespace sightline::measure
