#include "workbench/measure/workbench.hpp"

#include <algorithm>
#include <numeric>

#include "workbench/scene/random.hpp"

namespace sightline::measure {

Workbench::Workbench(device::Device& device, Scene& scene, std::span<const std::string> specifications)
    : scene_(scene),
      renderer_(device, scene),
      judge_(renderer_),
      reference_(methods::create_device_method("none", renderer_)) {
  for (const std::string& specification : specifications) {
    contestants_.push_back({specification, methods::create_device_method(specification, renderer_)});
  }
}

device::FrameTimes Workbench::draw(methods::DeviceMethod& method, const View& view,
                                   device::Renderer::Timed timed) {
  const device::FrameTimes times = renderer_.frame(
      view, [&](device::Recorder& frame) { method.record(frame); }, timed);
  method.took(times.frame_ms);
  return times;
}

std::optional<oracle::ItemBuffer> Workbench::judge_own(methods::DeviceMethod& method, const View& view) {
  std::optional<std::vector<ObjectId>> seen = method.everything_seen(view);
  if (!seen) return std::nullopt;
  oracle::ItemBuffer out;
  out.width = view.width, out.height = view.height;
  out.ids = std::move(*seen);
  out.pixels.resize(scene_.size());
  for (const ObjectId id : out.ids) {
    if (id != kNoObject) ++out.pixels[id];
  }
  return out;
}

device::Picture Workbench::own_picture(methods::DeviceMethod& method, const View& view,
                                       methods::DeviceMethod::Order order) {
  renderer_.frame(view, [&](device::Recorder& frame) { method.record_everything(frame, order); });
  return renderer_.picture();
}

oracle::ItemBuffer Workbench::judge(const View& view) {
  device::ItemBuffer seen = judge_.render(view);
  oracle::ItemBuffer out;
  out.width = seen.width;
  out.height = seen.height;
  out.ids = std::move(seen.ids);
  out.pixels.resize(scene_.size());
  for (const ObjectId id : out.ids) {
    if (id != kNoObject) ++out.pixels[id];
  }
  // Of a transparent object the rasteriser says that it is seen, not in how many pixels.
  for (ObjectId object = 0; object < scene_.size(); ++object) {
    out.pixels[object] = std::max<std::uint32_t>(out.pixels[object], seen.visible[object]);
  }
  return out;
}

void Workbench::update(std::span<const ObjectId> moved) {
  renderer_.update(moved);
  reference_->update(moved);
  for (DeviceContestant& contestant : contestants_) contestant.method->update(moved);
}

Mover::Mover(Scene& scene, double share, std::uint64_t seed)
    : scene_(scene),
      count_(static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * static_cast<double>(scene.size()))),
      seed_(seed),
      home_(scene.transform),
      order_(scene.size()) {
  std::iota(order_.begin(), order_.end(), ObjectId{0});
}

std::span<const ObjectId> Mover::move() {
  scene::Random random(seed_++);
  const auto size = static_cast<std::uint32_t>(scene_.size());
  for (std::uint32_t i = 0; i < count_; ++i) {
    std::swap(order_[i], order_[i + random.below(size - i)]);
    const ObjectId object = order_[i];
    Affine transform = home_[object];
    const float reach = std::max(scene_.radius[object], 1e-3f);
    for (Vec4& row : transform.rows) row.w += random.between(-reach, reach);
    scene_.move_object(object, transform);
  }
  return std::span(order_).first(count_);
}

}  // namespace sightline::measure
