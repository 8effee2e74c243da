// After Li, Liu, Ma, Liu, Xing & Zhang 2023: coarse groups of a tree of boxes against hierarchical z, level
// by level in compute shaders; of the objects that are left the boxes are rasterised, all by one indirect
// draw.
#include "workbench/methods/raster_occlusion/depth_pyramid.hpp"
#include "workbench/methods/raster_occlusion/device_box_tree.hpp"
#include "workbench/methods/raster_occlusion/occlusion.hpp"

namespace sightline::methods {

namespace {

constexpr std::uint32_t kRefine[] =
#include "shaders/ihzb.comp.inc"
    ;

struct IhzbPush {
  vk::DeviceAddress boxes, nodes, children, list, next_list, levels, fine, test, pyramid;
  std::uint32_t interior, level, widest;
};

/// As in ihzb.comp.
struct Level {
  vk::DispatchIndirectCommand groups{0, 1, 1};
  std::uint32_t count = 0;
};

class Ihzb final : public MarkAndDraw {
public:
  Ihzb(device::Renderer& renderer, const Parameters& parameters)
      : MarkAndDraw(renderer, parameters),
        tree_(renderer),
        pyramid_(renderer.device()),
        refine_(renderer.device(), kRefine, shader_constants(contribution_)),
        boxes_(make_box_pipeline(renderer.device(), contribution_)),
        no_levels_(std::size_t{tree_.levels()} + 1),
        marks_(make_marks(renderer)),
        fine_(renderer.device(), renderer.scene().size() * 4, device::Memory::device, "objects to test"),
        levels_(renderer.device(), no_levels_.size() * sizeof(Level), device::Memory::device, "dispatches"),
        test_(renderer.device(), sizeof(vk::DrawIndirectCommand), device::Memory::device, "a draw command"),
        lists_{tree_.words(), tree_.words()} {
    no_levels_.front() = {{1, 1, 1}, 1};  // the root
  }

  void do_update(std::span<const ObjectId> objects) override { tree_.update(objects); }

private:
  void test(device::Recorder& frame) override {
    {
      const auto pass = frame.pass("depth pyramid", device::PassKind::cull);
      pyramid_.build(frame);
    }
    {
      const auto pass = frame.pass("coarse test", device::PassKind::cull);
      refine(frame);
    }
    const auto pass = frame.pass("fine test", device::PassKind::cull);
    frame.begin_rendering({});
    frame.bind(boxes_, device::Recorder::Compare::nearer_or_equal, device::kTestBias,
               vk::CullModeFlagBits::eBack);
    frame.push(BoxPush{renderer_.buffers().box_data.address(), marks_.address(), fine_.address(), 1, 0, 1});
    frame.commands.drawIndirect(test_.handle(), 0, 1, sizeof(vk::DrawIndirectCommand));
    frame.end_rendering();
  }

  // From the root, node 0, down; each level's list is made by the one above.
  void refine(device::Recorder& frame) {
    frame.commands.fillBuffer(marks_.handle(), 0, VK_WHOLE_SIZE, 0);
    frame.commands.updateBuffer<Level>(levels_.handle(), 0, no_levels_);
    frame.commands.fillBuffer(lists_[0].handle(), 0, 4, 0);
    frame.commands.updateBuffer<vk::DrawIndirectCommand>(test_.handle(), 0,
                                                         vk::DrawIndirectCommand{0, 1, 0, 0});
    device::full_barrier(frame.commands);
    for (std::uint32_t level = 0; level < tree_.levels(); ++level) {
      const IhzbPush push{tree_.boxes(),
                          tree_.nodes(),
                          tree_.children(),
                          lists_[level % 2].address(),
                          lists_[(level + 1) % 2].address(),
                          levels_.address(),
                          fine_.address(),
                          test_.address(),
                          pyramid_.address(),
                          tree_.interior(),
                          level,
                          frame.widest_dispatch()};
      frame.dispatch(refine_, push, {levels_, level * sizeof(Level)});
    }
  }

  [[nodiscard]] vk::DeviceAddress marks() const noexcept override { return marks_.address(); }
  [[nodiscard]] std::vector<std::uint32_t> read_marks() override {
    return read_words(renderer_.device(), marks_, renderer_.buffers().objects);
  }

  void count(CullStats& stats) override {
    const std::vector<std::uint32_t> levels =
        read_words(renderer_.device(), levels_, tree_.levels() * sizeof(Level) / 4);
    for (std::size_t i = 3; i < levels.size(); i += 4) stats.nodes_visited += levels[i];
    stats.cull_vertices = read_words(renderer_.device(), test_, 1)[0];
    stats.tested = stats.cull_vertices / kBoxVertices;
  }

  DeviceBoxTree tree_;
  DepthPyramid pyramid_;
  device::ComputePipeline refine_;
  device::GraphicsPipeline boxes_;
  std::vector<Level> no_levels_;
  device::Buffer marks_, fine_, levels_, test_;
  std::array<device::Buffer, 2> lists_;
};

}  // namespace

extern const MethodInfo kIhzb{
    .name = "ihzb",
    .paper = "Li et al. 2023",
    .summary = "a tree's boxes level by level against hierarchical z, then rasterised object by object",
    .device = on_device<Ihzb>(Guarantee::exact, kOcclusionParameters)};

}  // namespace sightline::methods
