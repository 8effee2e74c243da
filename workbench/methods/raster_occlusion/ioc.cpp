// Iterative occlusion culling with a BVH (Lee & Lee 2020): the boxes of a tree, level by level; only the
// children of a visible node go on. Starts from last frame's visible nodes; nothing is read back.
#include "workbench/methods/raster_occlusion/device_box_tree.hpp"
#include "workbench/methods/raster_occlusion/occlusion.hpp"

namespace sightline::methods {

namespace {

constexpr std::uint32_t kIocFront[] =
#include "shaders/ioc_front.comp.inc"
    ;
constexpr std::uint32_t kIocExpand[] =
#include "shaders/ioc_expand.comp.inc"
    ;
constexpr std::uint32_t kIocLift[] =
#include "shaders/ioc_lift.comp.inc"
    ;

struct IocPush {
  vk::DeviceAddress nodes, children, parents, marks, seen, list, next_list, test, next_test;
  std::uint32_t interior, total;
};

class Ioc final : public MarkAndDraw {
public:
  Ioc(device::Renderer& renderer, const Parameters& parameters)
      : MarkAndDraw(renderer, parameters),
        tree_(renderer),
        boxes_(make_box_pipeline(renderer.device(), contribution_)),
        front_(renderer.device(), kIocFront),
        expand_(renderer.device(), kIocExpand),
        lift_(renderer.device(), kIocLift),
        marks_(tree_.words()),
        seen_(upload(renderer.device(), std::vector<std::uint32_t>(tree_.interior()), "the tree's marks")),
        tests_(renderer.device(), 16 * std::uint64_t{tree_.levels() + 1}, device::Memory::device,
               "draw commands"),
        lists_{tree_.words(), tree_.words()} {}

  void do_update(std::span<const ObjectId> objects) override { tree_.update(objects); }

private:
  [[nodiscard]] vk::DeviceAddress test_address(std::uint32_t level) const noexcept {
    return tests_.address() + 16 * level;
  }

  void test(device::Recorder& frame) override {
    const auto pass = frame.pass("box tests level by level", device::PassKind::cull);
    frame.fill(marks_, 0, marks_.size());
    // Draw commands {0 vertices, 1 instance, 0, 0} a level.
    first_commands_.assign(4 * std::size_t{tree_.levels() + 1}, 0);
    for (std::size_t i = 1; i < first_commands_.size(); i += 4) first_commands_[i] = 1;
    frame.commands.updateBuffer<std::uint32_t>(tests_.handle(), 0, first_commands_);
    device::full_barrier(frame.commands);
    IocPush push{tree_.nodes(),       tree_.children(),
                 tree_.parents(),     marks_.address(),
                 seen_.address(),     0,
                 lists_[0].address(), 0,
                 test_address(0),     tree_.interior(),
                 tree_.total()};
    frame.dispatch(front_, push, tree_.total());
    for (std::uint32_t level = 0; level < tree_.levels(); ++level) {
      frame.begin_rendering({});
      frame.bind(boxes_, device::Recorder::Compare::nearer_or_equal, device::kTestBias,
                 vk::CullModeFlagBits::eBack);
      frame.push(
          BoxPush{tree_.boxes(), marks_.address(), lists_[level % 2].address(), 1, tree_.interior(), 1});
      frame.commands.drawIndirect(tests_.handle(), 16 * level, 1, 16);
      frame.end_rendering();
      device::full_barrier(frame.commands);
      push.list = lists_[level % 2].address();
      push.next_list = lists_[(level + 1) % 2].address();
      push.test = test_address(level);
      push.next_test = test_address(level + 1);
      frame.dispatch(expand_, push, 32 * 64, 64);
    }
    frame.fill(seen_, 0, seen_.size());
    frame.dispatch(lift_, push, renderer_.buffers().objects);
  }

  [[nodiscard]] vk::DeviceAddress marks() const noexcept override {
    return marks_.address() + 4 * std::uint64_t{tree_.interior()};
  }

  [[nodiscard]] std::vector<std::uint32_t> read_marks() override {
    std::vector<std::uint32_t> all = read_words(renderer_.device(), marks_, tree_.total());
    all.erase(all.begin(), all.begin() + tree_.interior());
    return all;
  }

  void count(CullStats& stats) override {
    const std::vector<std::uint32_t> commands =
        read_words(renderer_.device(), tests_, 4 * std::size_t{tree_.levels()});
    for (std::size_t i = 0; i < commands.size(); i += 4) stats.cull_vertices += commands[i];
    stats.nodes_visited = stats.cull_vertices / kBoxVertices;
    stats.tested = std::min<std::uint64_t>(stats.nodes_visited, stats.objects);
  }

  DeviceBoxTree tree_;
  device::GraphicsPipeline boxes_;
  device::ComputePipeline front_, expand_, lift_;
  device::Buffer marks_, seen_, tests_;
  std::array<device::Buffer, 2> lists_;
  std::vector<std::uint32_t> first_commands_;
};

}  // namespace

extern const MethodInfo kIoc{
    .name = "ioc",
    .paper = "Lee & Lee 2020",
    .summary = "roc on the boxes of a tree, level by level from last frame's visible nodes",
    .device = on_device<Ioc>(Guarantee::exact, kOcclusionParameters)};

}  // namespace sightline::methods
