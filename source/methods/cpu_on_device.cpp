// Any CPU method, drawn by the renderer.
#include <algorithm>

#include "culling/draw_list.hpp"
#include "methods/device_method.hpp"

namespace sightline::methods {

namespace {

class CpuOnDevice final : public DeviceMethod {
public:
  CpuOnDevice(std::unique_ptr<Method> method, vulkan::Renderer& renderer)
      : renderer_(renderer), method_(std::move(method)), draw_list_(renderer.scene()) {}

  [[nodiscard]] Guarantee guarantee() const noexcept override { return method_->guarantee(); }
  void update(std::span<const ObjectId> objects) override { method_->update(objects); }

  void record(vulkan::Recorder& frame) override {
    method_->cull(frame.view, frame_);
    if (method_->geometry()) {
      // The renderer holds whole objects: a method that draws triangles of its own is drawn object by object.
      draw_list_.build(renderer_.scene(), frame.view, frame_);
    }
    const auto pass = frame.pass("draw", vulkan::PassKind::draw);
    renderer_.draw(frame, frame_.visible, frame_.draws);
  }

  void read_back(Frame& frame) override {
    frame = frame_;
    std::ranges::sort(frame.visible);
    frame.draws.clear();
  }

private:
  vulkan::Renderer& renderer_;
  std::unique_ptr<Method> method_;
  culling::DrawList draw_list_;
  Frame frame_;
};

}  // namespace

std::unique_ptr<DeviceMethod> draw_by_device(std::unique_ptr<Method> method, vulkan::Renderer& renderer) {
  return std::make_unique<CpuOnDevice>(std::move(method), renderer);
}

}  // namespace sightline::methods
