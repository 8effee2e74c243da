// Hierarchical raster occlusion culling (Lee & Shin 2023, section 2): the boxes of a tree, level by level;
// only the children of a visible node go on. Starts from last frame's visible nodes; nothing is read back.
#include <bit>

#include "workbench/methods/raster_occlusion/box_tree.hpp"
#include "workbench/methods/raster_occlusion/occlusion.hpp"

namespace sightline::methods {

namespace {

constexpr std::uint32_t kFront[] =
#include "shaders/hroc_front.comp.inc"
    ;
constexpr std::uint32_t kExpand[] =
#include "shaders/hroc_expand.comp.inc"
    ;
constexpr std::uint32_t kLift[] =
#include "shaders/hroc_lift.comp.inc"
    ;

struct HrocPush {
  vk::DeviceAddress nodes, children, parents, marks, seen, list, next_list, test, next_test;
  std::uint32_t interior, total;
};

class Hroc final : public MarkAndDraw {
public:
  Hroc(device::Renderer& renderer, const Parameters& parameters)
      : MarkAndDraw(renderer, parameters),
        tree_(renderer.scene()),
        boxes_(make_box_pipeline(renderer.device(), contribution_)),
        front_(renderer.device(), kFront),
        expand_(renderer.device(), kExpand),
        lift_(renderer.device(), kLift) {
    device::Device& device = renderer.device();
    std::vector<device::shared::BoxData> boxes;
    for (std::uint32_t node = 0; node < tree_.total(); ++node) boxes.push_back(box_of(node));
    node_boxes_ = upload(device, boxes, "the tree's boxes");
    nodes_ = upload(device, tree_.nodes(), "the tree");
    children_ = upload(device, tree_.children(), "the tree");
    parents_ = upload(device, tree_.parents(), "the tree");
    const auto words = [&](std::uint64_t count) {
      return device::Buffer(device, count * 4, device::Memory::device, "the tree's marks");
    };
    marks_ = words(tree_.total());
    seen_ = upload(device, std::vector<std::uint32_t>(tree_.interior()), "the tree's marks");
    for (device::Buffer& list : lists_) list = words(tree_.total());
    tests_ = words(4 * std::uint64_t{tree_.levels() + 1});
  }

  void do_update(std::span<const ObjectId> objects) override {
    tree_.refit(renderer_.scene(), objects, changed_);
    if (changed_.empty()) return;
    device::Device& device = renderer_.device();
    const std::size_t each = sizeof(device::shared::BoxData);
    if (staging_.size() < changed_.size() * each) {
      staging_ = device::Buffer(device, changed_.size() * each, device::Memory::upload, "moved boxes");
    }
    regions_.clear();
    for (std::size_t i = 0; i < changed_.size(); ++i) {
      staging_.mapped<device::shared::BoxData>()[i] = box_of(changed_[i]);
      regions_.push_back({i * each, changed_[i] * each, each});
    }
    device.run([&](const vk::raii::CommandBuffer& commands) {
      commands.copyBuffer(staging_.handle(), node_boxes_.handle(), regions_);
      device::full_barrier(commands);
    });
  }

private:
  [[nodiscard]] device::shared::BoxData box_of(std::uint32_t node) const {
    return node < tree_.interior() ? device::box_data(tree_.box(node), 0)
                                   : device::box_data(renderer_.scene(), node - tree_.interior());
  }

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
    HrocPush push{nodes_.address(),    children_.address(),
                  parents_.address(),  marks_.address(),
                  seen_.address(),     0,
                  lists_[0].address(), 0,
                  test_address(0),     tree_.interior(),
                  tree_.total()};
    frame.dispatch(front_, push, tree_.total());
    for (std::uint32_t level = 0; level < tree_.levels(); ++level) {
      frame.begin_rendering({});
      frame.bind(boxes_, device::Recorder::Compare::nearer_or_equal, device::kTestBias,
                 vk::CullModeFlagBits::eBack);
      frame.push(BoxPush{node_boxes_.address(), marks_.address(), lists_[level % 2].address(), 1,
                         tree_.interior(), 1});
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

  BoxTree tree_;
  device::GraphicsPipeline boxes_;
  device::ComputePipeline front_, expand_, lift_;
  device::Buffer node_boxes_, nodes_, children_, parents_, marks_, seen_, tests_, staging_;
  std::array<device::Buffer, 2> lists_;
  std::vector<std::uint32_t> changed_, first_commands_;
  std::vector<vk::BufferCopy> regions_;
};

}  // namespace

extern const MethodInfo kHroc{
    .name = "hroc",
    .paper = "A: Lee & Shin 2023",
    .summary = "roc on the boxes of a tree, level by level from last frame's visible nodes",
    .device = on_device<Hroc>(Guarantee::exact, kOcclusionParameters)};

}  // namespace sightline::methods
