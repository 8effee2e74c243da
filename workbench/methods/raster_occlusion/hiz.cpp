// Two-pass hierarchical z (Haar & Aaltonen 2015): the boxes of all objects in view against a pyramid of the
// depth that last frame's visible objects lay down.
#include "workbench/methods/raster_occlusion/depth_pyramid.hpp"
#include "workbench/methods/raster_occlusion/two_phase.hpp"

namespace sightline::methods {

namespace {

constexpr std::uint32_t kHizTest[] =
#include "shaders/hiz_test.comp.inc"
    ;
struct TestPush {
  vk::DeviceAddress boxes, state, pyramid;
  std::uint32_t objects, stamp;
};

class Hiz final : public TwoPhase {
public:
  Hiz(device::Renderer& renderer, const Parameters& parameters)
      : TwoPhase(renderer, submission::contribution_from(parameters)),
        test_(renderer.device(), kHizTest, shader_constants(contribution_)),
        pyramid_(renderer.device()) {}

  void do_update(std::span<const ObjectId>) override {}

private:
  void test(device::Recorder& frame) override {
    pyramid_.build(frame);
    const device::SceneBuffers& scene = renderer_.buffers();
    frame.dispatch(
        test_,
        TestPush{scene.box_data.address(), state_.address(), pyramid_.address(), scene.objects, stamp_},
        scene.objects);
  }

  void count(CullStats& stats) override { stats.cull_vertices = stats.objects; }

  device::ComputePipeline test_;
  DepthPyramid pyramid_;
};

}  // namespace

extern const MethodInfo kHiz{
    .name = "hiz",
    .paper = "E: Haar & Aaltonen 2015",
    .summary = "boxes against a pyramid of last frame's visible objects' depth, in two passes",
    .device = on_device<Hiz>(Guarantee::exact, kOcclusionParameters)};

}  // namespace sightline::methods
