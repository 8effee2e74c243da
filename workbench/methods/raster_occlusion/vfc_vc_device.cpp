// VFC+VC of Lee & Shin 2023, section 4: each object's bounding sphere against six planes, then contribution,
// on the GPU.
#include "workbench/methods/raster_occlusion/occlusion.hpp"

namespace sightline::methods {

namespace {

constexpr std::uint32_t kVfcVc[] =
#include "shaders/vfc_vc.comp.inc"
    ;

struct Push {
  vk::DeviceAddress boxes, marks, counters;
  std::uint32_t objects;
};

class VfcVcOnDevice final : public DeviceMethod {
public:
  VfcVcOnDevice(device::Renderer& renderer, const Parameters& parameters)
      : renderer_(renderer),
        contribution_(submission::contribution_from(parameters)),
        test_(renderer.device(), kVfcVc, shader_constants(contribution_)),
        marks_(renderer.device(), renderer.scene().size() * 4, device::Memory::device, "marks"),
        counters_(renderer.device(), 8, device::Memory::device, "counters"),
        draws_(renderer.draws().make_buffers(renderer.device())) {}

  [[nodiscard]] Guarantee guarantee() const noexcept override { return guarantee_of(contribution_); }
  void update(std::span<const ObjectId>) override {}

  void record(device::Recorder& frame) override {
    const device::SceneBuffers& scene = renderer_.buffers();
    {
      const auto pass = frame.pass("frustum and contribution", device::PassKind::cull);
      frame.fill(counters_, 0, 8);
      frame.dispatch(test_,
                     Push{scene.box_data.address(), marks_.address(), counters_.address(), scene.objects},
                     scene.objects);
      renderer_.draws().build(frame, marks_.address(), {}, renderer_.transparent_order(), draws_);
    }
    const auto pass = frame.pass("draw", device::PassKind::draw);
    renderer_.draw_opaque(frame, draws_, device::Renderer::Style::lit, device::Renderer::Clear::both);
    renderer_.draw_transparent(frame, draws_);
  }

  void read_back(Frame& frame) override {
    const std::uint32_t objects = renderer_.buffers().objects;
    report_visible(renderer_, read_words(renderer_.device(), marks_, objects), {}, {}, frame);
    const std::vector<std::uint32_t> counters = read_words(renderer_.device(), counters_, 2);
    frame.stats.tested = frame.stats.cull_vertices = objects;
    frame.stats.culled_frustum = counters[0];
    frame.stats.culled_contribution = counters[1];
  }

private:
  device::Renderer& renderer_;
  submission::Contribution contribution_;
  device::ComputePipeline test_;
  device::Buffer marks_, counters_;
  device::DrawBuffers draws_;
};

}  // namespace

const DeviceMethodInfo kVfcVcOnDevice{"vfc-vc",
                                      "A: Lee & Shin 2023",
                                      "every object's sphere against the view frustum, then contribution",
                                      Guarantee::exact,
                                      "",
                                      kOcclusionParameters,
                                      make_on_device<VfcVcOnDevice>};

}  // namespace sightline::methods
