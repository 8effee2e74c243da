#include "workbench/methods/drawn_on_device.hpp"

#include <optional>

#include "workbench/device/triangle_draws.hpp"

namespace sightline::methods {

namespace {

class DrawnOnDevice final : public Method {
public:
  DrawnOnDevice(std::unique_ptr<Method> method, device::Renderer& renderer)
      : Method(renderer.scene()), renderer_(renderer), method_(std::move(method)) {
    copy_triangles();
  }

  [[nodiscard]] Guarantee guarantee() const noexcept override { return method_->guarantee(); }
  [[nodiscard]] Coverage coverage() const noexcept override { return method_->coverage(); }
  void do_update(std::span<const ObjectId> objects) override {
    if (objects.empty()) return;
    method_->update(objects);
    copy_triangles();
  }
  void report_frame_time(double milliseconds) noexcept override { method_->report_frame_time(milliseconds); }
  [[nodiscard]] const TriangleGeometry* geometry() const noexcept override { return method_->geometry(); }

  void do_record(FrameContext& context) override {
    sightline::cull(*method_, context.view, context.output);
    const auto pass = context.recorder->pass("draw", device::PassKind::draw);
    const Frame& frame = context.output;
    if (triangles_) {
      triangles_->draw(*context.recorder, frame.draws, geometry()->submission);
    } else {
      renderer_.draw(*context.recorder, frame.visible, frame.draws, frame.one_by_one);
    }
  }

private:
  void copy_triangles() {
    triangles_.reset();
    if (geometry()) triangles_.emplace(renderer_, *geometry());
  }

  device::Renderer& renderer_;
  std::unique_ptr<Method> method_;
  std::optional<device::TriangleDraws> triangles_;
};

}  // namespace

std::unique_ptr<Method> draw_on_device(std::unique_ptr<Method> method, device::Renderer& renderer) {
  return std::make_unique<DrawnOnDevice>(std::move(method), renderer);
}

}  // namespace sightline::methods
