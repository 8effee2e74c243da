// Hierarchical z with the two shortcuts that engines ship, so that what they lose is seen: the level of the
// pyramid is chosen by the rectangle's larger side alone and four texels are looked at, where a rectangle
// across three needs more; and the pyramid is last frame's, asked with last frame's matrices, in one pass.
#include "workbench/device/view_data.hpp"
#include "workbench/methods/raster_occlusion/depth_pyramid.hpp"
#include "workbench/methods/raster_occlusion/occlusion.hpp"

namespace sightline::methods {

namespace {

constexpr std::uint32_t kTest[] =
#include "shaders/hiz_unsafe.comp.inc"
    ;

struct UnsafePush {
  vk::DeviceAddress boxes, marks, pyramid, last;
  std::uint32_t objects, has_last;
};

class HizUnsafe final : public Method {
public:
  HizUnsafe(device::Renderer& renderer, const Parameters& parameters)
      : Method(renderer.scene()),
        renderer_(renderer),
        contribution_(submission::contribution_from(parameters)),
        test_(renderer.device(), kTest, shader_constants(contribution_)),
        pyramid_(renderer.device()),
        marks_(renderer.device(), renderer.scene().size() * 4, device::Memory::device, "marks"),
        last_(renderer.device(), sizeof(device::shared::ViewData), device::Memory::upload,
              "last frame's view"),
        draws_(renderer.draws().make_buffers(renderer.device())) {}

  [[nodiscard]] Guarantee guarantee() const noexcept override { return Guarantee::approximate; }
  void do_update(std::span<const ObjectId>) override {}

  void do_record(FrameContext& context) override {
    device::Recorder& frame = *context.recorder;
    {
      const auto pass = frame.pass("box test", device::PassKind::cull);
      test(frame);
    }
    {
      const auto pass = frame.pass("draw commands", device::PassKind::cull);
      renderer_.draws().build(frame, marks_.address(), {}, renderer_.transparent_order(), draws_);
    }
    {
      const auto pass = frame.pass("draw", device::PassKind::draw);
      renderer_.draw_solid(frame, draws_, device::Renderer::Style::lit, device::Renderer::Clear::both);
    }
    {
      const auto pass = frame.pass("depth pyramid", device::PassKind::cull);
      pyramid_.build(frame);
    }
    last_view_ = context.view;
    const auto pass = frame.pass("draw what hides nothing", device::PassKind::draw);
    renderer_.draw_rest(frame, draws_);
  }

  void read_back(Frame& frame) override {
    report_visible(renderer_, read_words(renderer_.device(), marks_, renderer_.buffers().objects), {}, {},
                   frame);
    frame.stats.tested = frame.stats.cull_vertices = frame.stats.objects;
  }

private:
  void test(device::Recorder& frame) {
    const bool same_size =
        pyramid_.width() == frame.targets.depth.width() && pyramid_.height() == frame.targets.depth.height();
    const bool has_last = last_view_ && same_size;
    // The last frame is over: nobody reads what is written here.
    if (has_last)
      last_.mapped<device::shared::ViewData>()[0] = device::view_data(*last_view_, extent(scene_));
    const device::SceneBuffers& scene = renderer_.buffers();
    frame.fill(marks_, 0, marks_.size());
    frame.dispatch(test_,
                   UnsafePush{scene.box_data.address(), marks_.address(), has_last ? pyramid_.address() : 0,
                              last_.address(), scene.objects, has_last},
                   scene.objects);
  }

  device::Renderer& renderer_;
  submission::Contribution contribution_;
  device::ComputePipeline test_;
  DepthPyramid pyramid_;
  device::Buffer marks_, last_;
  device::DrawBuffers draws_;
  std::optional<View> last_view_;
};

}  // namespace

extern const MethodInfo kHizUnsafe{
    .name = "hiz-unsafe",
    .paper = "E: what engines ship",
    .summary = "boxes against last frame's depth with last frame's matrices, in a level chosen too coarsely",
    .device = on_device<HizUnsafe>(Guarantee::approximate, kOcclusionParameters)};

}  // namespace sightline::methods
