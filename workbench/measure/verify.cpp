#include "workbench/measure/verify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include <sightline/workbench/error.hpp>

#include "workbench/camera/path_file.hpp"
#include "workbench/measure/mover.hpp"

namespace sightline::measure {
namespace {

/// One is enough to show where a method gives way that promises nothing; a defect wants several.
std::size_t examples_wanted(const MethodVerdict& verdict) {
  return verdict.of_centres || verdict.guarantee == Guarantee::approximate ? 1 : 10;
}

}  // namespace

void examine(Bench& bench, Subject& subject, const View& view, const LostObject& where,
             MethodVerdict& verdict) {
  bench.run(subject, view);
  const oracle::Judgement judged = bench.judge(subject, view, Bench::Compare::pictures);
  verdict.kept += subject.frame.visible.size();
  verdict.visible += judged.truly_visible;
  verdict.lost_objects += judged.loss.lost.size();
  verdict.lost_pixels += judged.loss.lost_pixels;
  verdict.excess_objects += judged.loss.excess.size();
  verdict.different_pixels += judged.different_pixels;
  const bool lost = !judged.loss.lost.empty();
  verdict.views_with_loss += lost;
  const bool breaks = verdict.guarantee == Guarantee::exact && judged.different_pixels > 0;
  if (!lost && !breaks) return;
  if (verdict.examples.size() >= examples_wanted(verdict)) return;
  verdict.examples.push_back(where);
  verdict.examples.back().object = lost ? judged.loss.lost.front() : kNoObject;
  verdict.examples.back().pixels = lost ? judged.loss.lost_pixels : judged.different_pixels;
}

Verification start_verification(const Bench& bench) {
  Verification result;
  result.scene = bench.scene().name;
  result.raster_state = bench.scene().raster_state;
  result.device = bench.device_name();
  for (const Subject& subject : bench.subjects()) {
    MethodVerdict verdict;
    verdict.method = subject.name;
    verdict.guarantee = subject.method->guarantee();
    verdict.of_centres = bench.judges_samples() && subject.method->coverage() == Coverage::centres;
    result.methods.push_back(std::move(verdict));
  }
  return result;
}

bool Verification::passed() const noexcept {
  return std::all_of(methods.begin(), methods.end(), [](const MethodVerdict& m) { return m.holds(); });
}

Verification verify(Bench& bench, std::span<const Camera> cameras, std::uint32_t width, std::uint32_t height,
                    double moving, const Progress& progress) {
  Verification result = start_verification(bench);
  const int looks = bench.renderer() ? 2 : 1;
  Mover mover(bench.scene(), moving, 1);
  for (std::size_t v = 0; v < cameras.size(); ++v) {
    const View view = or_throw(make_view(cameras[v], width, height));
    for (int look = 0; look < looks; ++look) {
      if (moving > 0) bench.update(mover.move());
      LostObject where;
      where.view = v, where.camera = cameras[v], where.width = width, where.height = height;
      where.origin = bench.scene().origin;
      where.moves = moving > 0 ? v * static_cast<std::size_t>(looks) + static_cast<std::size_t>(look) + 1 : 0;
      if (bench.renderer() && v + static_cast<std::size_t>(look) > 0)
        where.before = cameras[look > 0 ? v : v - 1];
      for (std::size_t m = 0; m < result.methods.size(); ++m)
        examine(bench, bench.subjects()[m], view, where, result.methods[m]);
    }
    ++result.views;
    if (progress) progress(v + 1, cameras.size());
  }
  return result;
}

std::string describe(const MethodVerdict& verdict, const LostObject& lost) {
  const std::string what = lost.object == kNoObject
                               ? fmt::format("drew {} pixels otherwise in view {}", lost.pixels, lost.view)
                               : fmt::format("lost object {} in view {} ({} pixels lost in this view)",
                                             lost.object, lost.view, lost.pixels);
  return fmt::format("{} ({}) {}; the view, {}x{}: {}", verdict.method, to_string(verdict.guarantee), what,
                     lost.width, lost.height, camera::camera_json(lost.camera, lost.origin).dump());
}

}  // namespace sightline::measure
