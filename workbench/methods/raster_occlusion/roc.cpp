// Raster occlusion culling (Lee & Shin 2023, section 2): every object's box, 36 vertices, against the depth
// of what was visible last frame.
#include "workbench/methods/raster_occlusion/occlusion.hpp"

namespace sightline::methods {

namespace {

class Roc final : public MarkAndDraw {
public:
  Roc(device::Renderer& renderer, const Parameters& parameters)
      : MarkAndDraw(renderer, parameters),
        boxes_(make_box_pipeline(renderer.device(), contribution_)),
        marks_(make_marks(renderer)) {}

  void do_update(std::span<const ObjectId>) override {}

private:
  void test(device::Recorder& frame) override {
    const auto pass = frame.pass("box test", device::PassKind::cull);
    frame.fill(marks_, 0, marks_.size());
    const device::SceneBuffers& scene = renderer_.buffers();
    frame.begin_rendering({});
    frame.bind(boxes_, device::Recorder::Compare::nearer_or_equal, device::kTestBias,
               vk::CullModeFlagBits::eBack);
    frame.push(BoxPush{scene.box_data.address(), marks_.address(), 0, 0, 0, 1});
    frame.commands.draw(kBoxVertices * scene.objects, 1, 0, 0);
    frame.end_rendering();
  }

  [[nodiscard]] vk::DeviceAddress marks() const noexcept override { return marks_.address(); }
  [[nodiscard]] std::vector<std::uint32_t> read_marks() override {
    return read_words(renderer_.device(), marks_, renderer_.buffers().objects);
  }
  void count(CullStats& stats) override {
    stats.tested = stats.objects;
    stats.cull_vertices = kBoxVertices * stats.objects;
  }

  device::GraphicsPipeline boxes_;
  device::Buffer marks_;
};

}  // namespace

extern const MethodInfo kRoc{.name = "roc",
                             .paper = "A: Lee & Shin 2023",
                             .summary = "every object's box rasterised against last frame's visible objects",
                             .device = on_device<Roc>(Guarantee::exact, kOcclusionParameters)};

}  // namespace sightline::methods
