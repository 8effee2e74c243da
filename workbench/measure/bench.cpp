#include "workbench/measure/bench.hpp"

#include <chrono>

#include <sightline/workbench/error.hpp>

#include "workbench/device/renderer.hpp"
#include "workbench/methods/drawn_on_device.hpp"

namespace sightline::measure {

Bench::Bench(Scene& scene, std::span<const std::string> specifications, device::Device* device,
             std::uint32_t samples)
    : scene_(scene),
      samples_(samples),
      renderer_(device ? std::make_unique<device::Renderer>(*device, scene) : nullptr) {
  if (renderer_ && samples > 0)
    throw Error("samples: a device judges pixel centres alone, expected --device cpu");
  oracle_ = renderer_ ? oracle::make_raster_oracle(*renderer_) : oracle::make_ray_oracle(scene, samples);
  for (const std::string& specification : specifications) {
    subjects_.push_back({specification, create_method(specification, MethodSite{scene, renderer_.get()})});
  }
}

Bench::~Bench() = default;

std::string Bench::device_name() const {
  return renderer_ ? renderer_->device().info().name : "cpu";
}

Subject& Bench::add(std::string name, std::unique_ptr<Method> method) {
  if (renderer_) method = methods::draw_on_device(std::move(method), *renderer_);
  return subjects_.emplace_back(std::move(name), std::move(method));
}

device::FrameTimes Bench::run(Subject& subject, const View& view, device::Timed timed) {
  device::FrameTimes times;
  if (!renderer_) {
    const auto begin = std::chrono::steady_clock::now();
    cull(*subject.method, view, subject.frame);
    const auto end = std::chrono::steady_clock::now();
    times.record_ms = std::chrono::duration<double, std::milli>(end - begin).count();
    return times;
  }
  times = renderer_->frame(
      view,
      [&](device::Recorder& recorder) {
        FrameContext context{view, subject.frame, &recorder};
        subject.method->record(context);
      },
      timed);
  // Timestamps make a frame slower: what chooses by its times is told of whole frames alone.
  if (timed == device::Timed::frame) subject.method->report_frame_time(times.frame_ms);
  return times;
}

oracle::Judgement Bench::judge(Subject& subject, const View& view, Compare what) {
  subject.method->read_back(subject.frame);
  oracle::Answer answer{subject.frame, subject.method->geometry()};
  device::Picture picture;
  std::vector<float> depth;
  if (renderer_ && what == Compare::pictures) {
    picture = renderer_->picture(), depth = renderer_->depth();
    answer.picture = &picture, answer.depth = &depth;
  }
  return oracle_->judge(view, answer);
}

void Bench::update(std::span<const ObjectId> moved) {
  if (renderer_) renderer_->update(moved);
  for (Subject& subject : subjects_) subject.method->update(moved);
  oracle_->update(moved);
}

std::vector<std::string> fitting_methods(const Scene& scene, bool on_device) {
  std::vector<std::string> names;
  for (const MethodInfo& info : all_methods()) {
    if (info.cpu.suits(scene) || (on_device && info.device.suits(scene))) names.emplace_back(info.name);
  }
  return names;
}

std::vector<std::string> promising_methods(const Scene& scene, bool on_device) {
  std::vector<std::string> names;
  for (const MethodInfo& info : all_methods()) {
    const MethodForm& form = on_device ? info.device : info.cpu;
    if (form.suits(scene) && form.guarantee != Guarantee::approximate) names.emplace_back(info.name);
  }
  return names;
}

}  // namespace sightline::measure
