// Hierarchical raster occlusion culling (Lee, Jeong, Seok & Lee 2021): coarse groups of a tree of boxes are
// rasterised once against the depth of what was visible last frame; inside their bounds a ray a pixel marks
// every object that it meets before that depth. A constant number of draws and dispatches.
#include <limits>

#include "library/rays/bvh.hpp"
#include "workbench/methods/raster_occlusion/occlusion.hpp"

namespace sightline::methods {

namespace {

constexpr std::uint32_t kHrocGroups[] =
#include "shaders/hroc_groups.comp.inc"
    ;
constexpr std::uint32_t kHrocLift[] =
#include "shaders/hroc_lift.comp.inc"
    ;
constexpr std::uint32_t kHrocVert[] =
#include "shaders/hroc_group.vert.inc"
    ;
constexpr std::uint32_t kHrocFrag[] =
#include "shaders/hroc_group.frag.inc"
    ;

struct HrocPush {
  vk::DeviceAddress boxes, nodes, parents, leaves, marks, seen, groups, test;
  std::uint32_t total, objects, most, everywhere;
};

/// As in hroc.h.
struct GroupTest {
  vk::DrawIndirectCommand draw{0, 1, 0, 0};
  std::uint32_t rays = 0, nodes = 0;
};

constexpr std::array kHrocParameters{
    submission::kContributionParameter,
    submission::kThresholdParameter,
    ParameterInfo{"leaf",
                  "what is rasterised: groups of the tree, or every object's box, wherever it lies, as Lee & "
                  "Shin count it",
                  "groups", 0, 0, false, "groups|boxes"},
    ParameterInfo{"most", "objects in a group", "64", 1, 1000000, true},
    ParameterInfo{"occluder", "px², the least area of an object that lays down depth", "16", 0, 1e9},
    ParameterInfo{"count", "rays and the nodes that they look at, which takes time", "off", 0, 0, false,
                  "off|on"}};

std::vector<std::uint32_t> constants_of(const submission::Contribution& contribution,
                                        const Parameters& parameters) {
  const auto [test, threshold] = shader_constants(contribution);
  return {test, threshold, parameters.word("count") == "on" ? 1u : 0u};
}

class Hroc final : public MarkAndDraw {
public:
  Hroc(device::Renderer& renderer, const Parameters& parameters)
      : MarkAndDraw(renderer, parameters, static_cast<float>(parameters.number("occluder"))),
        every_box_(parameters.word("leaf") == "boxes"),
        most_(every_box_ ? 1 : parameters.count("most")),
        find_groups_(renderer.device(), kHrocGroups, shader_constants(contribution_)),
        lift_(renderer.device(), kHrocLift),
        cast_(renderer.device(), {.vertex = kHrocVert,
                                  .fragment = kHrocFrag,
                                  .constants = constants_of(contribution_, parameters),
                                  .depth_write = false}) {
    device::Device& device = renderer.device();
    tree_.build(renderer.scene().bounds);
    upload_tree(device);
    const auto nothing = [&](std::size_t count) {
      return upload(device, std::vector<std::uint32_t>(count), "the tree's marks");
    };
    marks_ = make_marks(renderer);
    groups_ = nothing(tree_.nodes().size());
    seen_ = nothing(tree_.nodes().size());
    test_ = nothing(sizeof(GroupTest) / 4);
  }

  void do_update(std::span<const ObjectId> objects) override {
    if (objects.empty()) return;
    tree_.refit(renderer_.scene().bounds);
    const auto nodes = tree_.nodes();
    if (staging_.size() < nodes.size_bytes()) {
      staging_ =
          device::Buffer(renderer_.device(), nodes.size_bytes(), device::Memory::upload, "moved boxes");
    }
    std::ranges::copy(nodes, staging_.mapped<rays::BvhNode>());
    renderer_.device().run([&](const vk::raii::CommandBuffer& commands) {
      commands.copyBuffer(staging_.handle(), nodes_.handle(), vk::BufferCopy{0, 0, nodes.size_bytes()});
      device::full_barrier(commands);
    });
  }

private:
  void upload_tree(device::Device& device) {
    const auto nodes = tree_.nodes();
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> parents(nodes.size(), kNone), leaves(renderer_.scene().size());
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {
      if (nodes[i].descendants == 0) {
        leaves[nodes[i].object] = i;
        continue;
      }
      parents[i + 1] = i;
      parents[i + 2 + nodes[i + 1].descendants] = i;
    }
    nodes_ = device::upload_bytes(device, std::as_bytes(nodes), "the tree");
    parents_ = upload(device, parents, "the tree");
    leaves_ = upload(device, leaves, "the tree");
  }

  [[nodiscard]] HrocPush push() const {
    const device::SceneBuffers& scene = renderer_.buffers();
    return {scene.box_data.address(),
            nodes_.address(),
            parents_.address(),
            leaves_.address(),
            marks_.address(),
            seen_.address(),
            groups_.address(),
            test_.address(),
            static_cast<std::uint32_t>(tree_.nodes().size()),
            scene.objects,
            2 * (most_ - 1),
            every_box_ ? 1u : 0u};
  }

  void test(device::Recorder& frame) override {
    const auto pass = frame.pass("groups and rays", device::PassKind::cull);
    frame.fill(marks_, 0, marks_.size());
    frame.commands.updateBuffer<GroupTest>(test_.handle(), 0, GroupTest{});
    device::full_barrier(frame.commands);
    frame.dispatch(find_groups_, push(), static_cast<std::uint32_t>(tree_.nodes().size()));
    frame.targets.depth.begin_reading(frame.commands);
    frame.begin_rendering({.read_depth = true});
    frame.bind(cast_, device::Recorder::Compare::nearer_or_equal, device::kTestBias,
               vk::CullModeFlagBits::eBack);
    frame.push(push());
    frame.commands.drawIndirect(test_.handle(), 0, 1, sizeof(vk::DrawIndirectCommand));
    frame.end_rendering();
    frame.targets.depth.end_reading(frame.commands);
    device::full_barrier(frame.commands);
    frame.fill(seen_, 0, seen_.size());
    frame.dispatch(lift_, push(), renderer_.buffers().objects);
  }

  [[nodiscard]] vk::DeviceAddress marks() const noexcept override { return marks_.address(); }
  [[nodiscard]] std::vector<std::uint32_t> read_marks() override {
    return read_words(renderer_.device(), marks_, renderer_.buffers().objects);
  }

  void count(CullStats& stats) override {
    const std::vector<std::uint32_t> words = read_words(renderer_.device(), test_, sizeof(GroupTest) / 4);
    stats.cull_vertices = words[0];
    stats.tested = words[0] / kBoxVertices;
    stats.rays = words[4];
    stats.nodes_visited = words[5];
  }

  bool every_box_;
  std::uint32_t most_;
  rays::Bvh tree_;
  device::ComputePipeline find_groups_, lift_;
  device::GraphicsPipeline cast_;
  device::Buffer nodes_, parents_, leaves_, marks_, groups_, seen_, test_, staging_;
};

}  // namespace

extern const MethodInfo kHroc{
    .name = "hroc",
    .paper = "Lee, Jeong, Seok & Lee 2021",
    .summary = "groups of a tree rasterised once against last frame's visible objects, a ray a pixel inside",
    .device = on_device<Hroc>(Guarantee::exact, kHrocParameters)};

}  // namespace sightline::methods
