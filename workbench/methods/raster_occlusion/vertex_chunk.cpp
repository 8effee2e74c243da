// Lee & Shin 2023, the paper's own method, in the order of its figure 2.
#include "workbench/methods/raster_occlusion/ground_chunks.hpp"
#include "workbench/methods/raster_occlusion/occlusion.hpp"

namespace sightline::methods {

namespace {

constexpr std::uint32_t kVert[] =
#include "shaders/vertex_chunk.vert.inc"
    ;
constexpr std::uint32_t kGeom[] =
#include "shaders/vertex_chunk.geom.inc"
    ;
constexpr std::uint32_t kFacingGeom[] =
#include "shaders/vertex_chunk_facing.geom.inc"
    ;
constexpr std::uint32_t kFrag[] =
#include "shaders/mark.frag.inc"
    ;

constexpr std::array kVertexChunkParameters{
    submission::kContributionParameter, submission::kThresholdParameter, kRegionDepthParameter,
    ParameterInfo{"faces", "what is restored of a box: all of it, or the faces that look at the eye", "all",
                  0, 0, false, "all|facing"}};

class VertexChunk final : public MarkAndDraw {
public:
  VertexChunk(device::Renderer& renderer, const Parameters& parameters)
      : MarkAndDraw(renderer, parameters),
        chunks_(renderer.scene(), parameters.count("depth")),
        facing_(parameters.word("faces") == "facing"),
        boxes_(renderer.device(), {.vertex = kVert,
                                   .geometry = facing_ ? device::Spirv(kFacingGeom) : device::Spirv(kGeom),
                                   .fragment = kFrag,
                                   .constants = shader_constants(contribution_),
                                   .input = device::Input::point,
                                   .topology = vk::PrimitiveTopology::ePointList,
                                   .depth_write = false}),
        marks_(make_marks(renderer)),
        input_(renderer.device(), renderer.scene().size() * sizeof(world::ChunkVertex),
               device::Memory::upload, "the input buffer of vertex chunks") {}

  void do_update(std::span<const ObjectId> objects) override {
    chunks_.update(renderer_.scene(), objects);
    chunks_.map().acknowledge_changes();
  }

private:
  void test(device::Recorder& frame) override {
    // CPU: the region hierarchy by frustum, chunks by frustum and contribution.
    chunks_.select(frame.view, contribution_);
    // The vertices of the chunks that are left become this frame's input buffer.
    auto* const input = input_.mapped<world::ChunkVertex>();
    const std::size_t room = renderer_.scene().size();
    vertices_ = 0;
    std::uint32_t inside = 0;
    for (const auto list : {chunks_.inside(), chunks_.crossing()}) {
      inside = vertices_;
      for (const std::uint32_t chunk : list) {
        vertices_ += chunks_.map().write_vertices(chunk, {input + vertices_, room - vertices_});
      }
    }
    // GPU: frustum and contribution in the vertex stage, the box in the geometry stage, early z, marks.
    const auto pass = frame.pass("box test", device::PassKind::cull);
    frame.fill(marks_, 0, marks_.size());
    frame.begin_rendering({});
    frame.bind(boxes_, device::Recorder::Compare::nearer_or_equal, device::kTestBias,
               facing_ ? vk::CullModeFlagBits::eNone : vk::CullModeFlagBits::eBack);
    frame.push(BoxPush{renderer_.buffers().box_data.address(), marks_.address(), 0, 0, 0, 1});
    frame.commands.bindVertexBuffers(0, input_.handle(), vk::DeviceSize{0});
    // Chunks wholly in view apart from those at its edges: a rasteriser that clips a batch as soon as one
    // vertex asks for it, as llvmpipe does, need not clip theirs.
    if (inside > 0) frame.commands.draw(inside, 1, 0, 0);
    if (vertices_ > inside) frame.commands.draw(vertices_ - inside, 1, inside, 0);
    frame.end_rendering();
  }

  [[nodiscard]] vk::DeviceAddress marks() const noexcept override { return marks_.address(); }
  [[nodiscard]] std::vector<std::uint32_t> read_marks() override {
    return read_words(renderer_.device(), marks_, renderer_.buffers().objects);
  }
  void count(CullStats& stats) override {
    stats.nodes_visited = chunks_.nodes_visited();
    stats.tested = stats.cull_vertices = vertices_;
  }

  GroundChunks chunks_;
  bool facing_;
  device::GraphicsPipeline boxes_;
  device::Buffer marks_, input_;
  std::uint32_t vertices_ = 0;
};

}  // namespace

extern const MethodInfo kVertexChunk{
    .name = "vertex-chunk",
    .paper = "A: Lee & Shin 2023",
    .summary = "chunks culled on the CPU; one vertex an object becomes its box, tested by early z",
    .device = {Guarantee::exact, kVertexChunkParameters, make_on_device<VertexChunk>, "geometryShader"}};

}  // namespace sightline::methods
