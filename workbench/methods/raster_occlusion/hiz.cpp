// Two-pass hierarchical z (Haar & Aaltonen 2015): the boxes of all objects in view against a pyramid of the
// depth that last frame's visible objects lay down.
#include "workbench/methods/raster_occlusion/two_phase.hpp"

namespace sightline::methods {

namespace {

constexpr std::uint32_t kHizTest[] =
#include "shaders/hiz_test.comp.inc"
    ;
constexpr std::uint32_t kPyramid[] =
#include "shaders/pyramid.comp.inc"
    ;

struct TestPush {
  vk::DeviceAddress boxes, state, pyramid;
  std::uint32_t objects, stamp;
};

struct PyramidPush {
  vk::DeviceAddress from, to;
  std::uint32_t from_width, from_height, to_width, to_height, reversed;
};

class Hiz final : public TwoPhase {
public:
  Hiz(device::Renderer& renderer, const Parameters& parameters)
      : TwoPhase(renderer, submission::contribution_from(parameters)),
        test_(renderer.device(), kHizTest, shader_constants(contribution_)),
        reduce_(renderer.device(), kPyramid) {}

  void do_update(std::span<const ObjectId>) override {}

private:
  void test(device::Recorder& frame) override {
    std::uint32_t width = frame.targets.depth.width(), height = frame.targets.depth.height();
    const std::uint64_t most = 4 * (std::uint64_t{width} * height * 3 / 2 + width + height + 64);
    if (pyramid_.size() < most)
      pyramid_ = device::Buffer(renderer_.device(), most, device::Memory::device, "the depth pyramid");
    frame.targets.depth.copy_to(frame.commands, pyramid_);
    vk::DeviceAddress from = pyramid_.address();
    while (width > 1 || height > 1) {
      const std::uint32_t to_width = (width + 1) / 2, to_height = (height + 1) / 2;
      const vk::DeviceAddress to = from + 4 * std::uint64_t{width} * height;
      frame.dispatch(reduce_, PyramidPush{from, to, width, height, to_width, to_height, frame.reversed()},
                     to_width * to_height);
      from = to;
      width = to_width;
      height = to_height;
    }
    const device::SceneBuffers& scene = renderer_.buffers();
    frame.dispatch(
        test_,
        TestPush{scene.box_data.address(), state_.address(), pyramid_.address(), scene.objects, stamp_},
        scene.objects);
  }

  void count(CullStats& stats) override { stats.cull_vertices = stats.objects; }

  device::ComputePipeline test_, reduce_;
  device::Buffer pyramid_;
};

}  // namespace

extern const MethodInfo kHiz{
    .name = "hiz",
    .paper = "E: Haar & Aaltonen 2015",
    .summary = "boxes against a pyramid of last frame's visible objects' depth, in two passes",
    .device = on_device<Hiz>(Guarantee::exact, kOcclusionParameters)};

}  // namespace sightline::methods
