// Draws every object: the picture that all others are compared with.
#include "workbench/methods/raster_occlusion/occlusion.hpp"

namespace sightline::methods {

namespace {

class NoneOnDevice final : public DeviceMethod {
public:
  NoneOnDevice(device::Renderer& renderer, const Parameters&)
      : renderer_(renderer),
        flags_(renderer.device(), renderer.scene().size() * 4, device::Memory::device, "flags"),
        draws_(renderer.draws().make_buffers(renderer.device())) {}

  [[nodiscard]] Guarantee guarantee() const noexcept override { return Guarantee::exact; }
  void update(std::span<const ObjectId>) override {}

  void record(device::Recorder& frame) override {
    const auto pass = frame.pass("draw", device::PassKind::draw);
    // Opaque objects are listed once; transparent ones are sorted anew for each view.
    if (!listed_ || renderer_.transparent_order()) {
      renderer_.draws().build(frame, flags_.address(), device::VisibleDraws::kAll,
                              renderer_.transparent_order(), draws_);
      listed_ = true;
    }
    renderer_.draw_opaque(frame, draws_, device::Renderer::Style::lit, device::Renderer::Clear::both);
    renderer_.draw_transparent(frame, draws_);
  }

  void read_back(Frame& frame) override {
    const std::vector<std::uint32_t> flags(renderer_.scene().size());
    report_visible(renderer_, flags, device::VisibleDraws::kAll, device::VisibleDraws::kAll, frame);
  }

private:
  device::Renderer& renderer_;
  device::Buffer flags_;
  device::DrawBuffers draws_;
  bool listed_ = false;
};

}  // namespace

const DeviceMethodInfo kNoneOnDevice{"none", "", "draws every object",        Guarantee::exact,
                                     "",     {}, make_on_device<NoneOnDevice>};

}  // namespace sightline::methods
