// VFC+VC of Lee & Shin 2023, section 4, on the CPU and on the GPU: each object's bounding volume against the
// six planes, then contribution culling of what is left.
#include <array>
#include <numeric>

#include "workbench/methods/raster_occlusion/occlusion.hpp"
#include "workbench/submission/contribution.hpp"
#include "workbench/submission/draw_list.hpp"
#include "workbench/submission/object_bounds.hpp"

namespace sightline::methods {

namespace {

using submission::Contribution;

constexpr std::array kVfcVcParameters{
    submission::kBoundsParameter,
    submission::kContributionParameter,
    submission::kThresholdParameter,
};

class VfcVc final : public CpuMethod {
public:
  VfcVc(const Scene& scene, const Parameters& parameters)
      : CpuMethod(scene),
        contribution_(submission::contribution_from(parameters)),
        bounds_(submission::volume_from(parameters)),
        draw_list_(scene),
        extent_(submission::volume_extent(scene)) {
    std::vector<ObjectId> order(scene.size());
    std::iota(order.begin(), order.end(), ObjectId{0});
    bounds_.assign(scene, order);
  }

  [[nodiscard]] Guarantee guarantee() const noexcept override {
    return contribution_.test == Contribution::Test::area ? Guarantee::approximate : Guarantee::conservative;
  }
  [[nodiscard]] Coverage coverage() const noexcept override { return coverage_of(contribution_); }

  void do_update(std::span<const ObjectId> objects) override {
    for (const ObjectId object : objects) bounds_.refresh(scene_, object);
    extent_ = submission::volume_extent(scene_);
  }

  void cull(const View& view, Frame& frame) noexcept override {
    frame.clear();
    CullStats& stats = frame.stats;
    stats.objects = stats.tested = stats.cull_vertices = scene_.size();
    frame.visible.resize(scene_.size() + kCullPadding);

    const std::size_t in_view = bounds_.cull(make_frustum(view), 0, scene_.size(), frame.visible);
    stats.culled_frustum = scene_.size() - in_view;
    const std::size_t kept =
        contribution_.filter(scene_, make_projector(view, extent_), std::span(frame.visible).first(in_view));
    stats.culled_contribution = in_view - kept;

    frame.visible.resize(kept);
    draw_list_.build(scene_, view, frame);
  }

private:
  Contribution contribution_;
  submission::ObjectBounds bounds_;
  submission::DrawList draw_list_;
  Box extent_;
};

constexpr std::uint32_t kVfcVcShader[] =
#include "shaders/vfc_vc.comp.inc"
    ;

struct VfcVcPush {
  vk::DeviceAddress boxes, marks, counters;
  std::uint32_t objects;
};

class VfcVcOnDevice final : public Method {
public:
  VfcVcOnDevice(device::Renderer& renderer, const Parameters& parameters)
      : Method(renderer.scene()),
        renderer_(renderer),
        contribution_(submission::contribution_from(parameters)),
        test_(renderer.device(), kVfcVcShader, shader_constants(contribution_)),
        marks_(renderer.device(), renderer.scene().size() * 4, device::Memory::device, "marks"),
        counters_(renderer.device(), 8, device::Memory::device, "counters"),
        draws_(renderer.draws().make_buffers(renderer.device())) {}

  [[nodiscard]] Guarantee guarantee() const noexcept override { return guarantee_of(contribution_); }
  [[nodiscard]] Coverage coverage() const noexcept override { return coverage_of(contribution_); }
  void do_update(std::span<const ObjectId>) override {}

  void do_record(FrameContext& context) override {
    device::Recorder& frame = *context.recorder;
    const device::SceneBuffers& scene = renderer_.buffers();
    {
      const auto pass = frame.pass("frustum and contribution", device::PassKind::cull);
      frame.fill(counters_, 0, 8);
      frame.dispatch(
          test_, VfcVcPush{scene.box_data.address(), marks_.address(), counters_.address(), scene.objects},
          scene.objects);
      renderer_.draws().build(frame, marks_.address(), {}, renderer_.transparent_order(), draws_);
    }
    const auto pass = frame.pass("draw", device::PassKind::draw);
    renderer_.draw_solid(frame, draws_, device::Renderer::Style::lit, device::Renderer::Clear::both);
    renderer_.draw_rest(frame, draws_);
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

extern const MethodInfo kVfcVc{.name = "vfc-vc",
                               .paper = "A: Lee & Shin 2023",
                               .summary = "every object against the view frustum, then contribution",
                               .cpu = on_cpu<VfcVc>(Guarantee::conservative, kVfcVcParameters),
                               .device = on_device<VfcVcOnDevice>(Guarantee::exact, kOcclusionParameters)};

}  // namespace sightline::methods
