#include "workbench/methods/ray_pvs/ray_device_method.hpp"

namespace sightline::methods {

namespace {

class RayDeviceMethod final : public Method {
public:
  RayDeviceMethod(device::Renderer& renderer, std::uint32_t side, std::unique_ptr<DeviceRays> rays)
      : Method(renderer.scene()),
        renderer_(renderer),
        side_(side),
        rays_(std::move(rays)),
        draws_(renderer.draws().make_buffers(renderer.device())) {}

  [[nodiscard]] Guarantee guarantee() const noexcept override { return Guarantee::approximate; }
  void do_update(std::span<const ObjectId>) override { rays_->update(); }

  void do_record(FrameContext& context) override {
    device::Recorder& frame = *context.recorder;
    grid_.make(frame.view, side_, side_);
    rays_->prepare(grid_);
    {
      const auto pass = frame.pass("rays", device::PassKind::cull);
      rays_->record(frame.commands);
      renderer_.draws().build(frame, rays_->marks().address(), {}, renderer_.transparent_order(), draws_);
    }
    const auto pass = frame.pass("draw", device::PassKind::draw);
    renderer_.draw_solid(frame, draws_, device::Renderer::Style::lit, device::Renderer::Clear::both);
    renderer_.draw_rest(frame, draws_);
  }

  void read_back(Frame& frame) override {
    frame.clear();
    const std::size_t objects = renderer_.scene().size();
    const auto* marks = rays_->marks().mapped<std::uint32_t>();
    for (ObjectId object = 0; object < objects; ++object) {
      if (marks[object] == 0) continue;
      frame.visible.push_back(object);
      frame.stats.triangles += renderer_.scene().triangles(object);
    }
    frame.stats.objects = objects;
    frame.stats.draw_calls = frame.visible.size();
    frame.stats.rays = rays_->ray_count();
    frame.stats.culled_occlusion = objects - frame.visible.size();
  }

private:
  device::Renderer& renderer_;
  std::uint32_t side_;
  std::unique_ptr<DeviceRays> rays_;
  device::DrawBuffers draws_;
  rays::RayGrid grid_;
};

}  // namespace

std::unique_ptr<Method> make_ray_device_method(device::Renderer& renderer, const Parameters& parameters,
                                               std::unique_ptr<DeviceRays> rays) {
  return std::make_unique<RayDeviceMethod>(renderer, parameters.count(kRaysParameter.name), std::move(rays));
}

}  // namespace sightline::methods
