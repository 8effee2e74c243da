// Draws every object: what all other methods are measured against.
#include <numeric>

#include "workbench/methods/raster_occlusion/occlusion.hpp"
#include "workbench/submission/draw_list.hpp"

namespace sightline::methods {

namespace {

class None final : public CpuMethod {
public:
  None(const Scene& scene, const Parameters&) : CpuMethod(scene), draw_list_(scene) {}

  [[nodiscard]] Guarantee guarantee() const noexcept override { return Guarantee::exact; }
  void do_update(std::span<const ObjectId>) override {}

  void cull(const View& view, Frame& frame) noexcept override {
    frame.clear();
    frame.visible.resize(scene_.size());
    std::iota(frame.visible.begin(), frame.visible.end(), ObjectId{0});
    frame.stats.objects = scene_.size();
    draw_list_.build(scene_, view, frame);
  }

private:
  submission::DrawList draw_list_;
};

class NoneOnDevice final : public Method {
public:
  NoneOnDevice(device::Renderer& renderer, const Parameters&)
      : Method(renderer.scene()),
        renderer_(renderer),
        flags_(renderer.device(), renderer.scene().size() * 4, device::Memory::device, "flags"),
        draws_(renderer.draws().make_buffers(renderer.device())) {}

  [[nodiscard]] Guarantee guarantee() const noexcept override { return Guarantee::exact; }
  void do_update(std::span<const ObjectId>) override {}

  void do_record(FrameContext& context) override {
    device::Recorder& frame = *context.recorder;
    const auto pass = frame.pass("draw", device::PassKind::draw);
    // Opaque objects are listed once; transparent ones are sorted anew for each view.
    if (!listed_ || renderer_.transparent_order()) {
      renderer_.draws().build(frame, flags_.address(), device::VisibleDraws::kAll,
                              renderer_.transparent_order(), draws_);
      listed_ = true;
    }
    renderer_.draw_solid(frame, draws_, device::Renderer::Style::lit, device::Renderer::Clear::both);
    renderer_.draw_rest(frame, draws_);
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

extern const MethodInfo kNone{.name = "none",
                              .paper = "",
                              .summary = "draws every object",
                              .cpu = on_cpu<None>(Guarantee::exact),
                              .device = on_device<NoneOnDevice>(Guarantee::exact)};

}  // namespace sightline::methods
