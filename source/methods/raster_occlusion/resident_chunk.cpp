// Beyond Lee & Shin 2023: the chunks stay on the GPU. Each frame sends only which chunks are in and what
// moved; objects are tested in compute; at most the three faces that look at the eye are restored; objects
// that were visible last frame are drawn once, before the test.
#include <cstring>

#include "methods/raster_occlusion/ground_chunks.hpp"
#include "methods/raster_occlusion/two_phase.hpp"

namespace sightline::methods {

namespace {

constexpr std::uint32_t kTest[] =
#include "shaders/resident_test.comp.inc"
    ;
constexpr std::uint32_t kFace[] =
#include "shaders/face.vert.inc"
    ;
constexpr std::uint32_t kDepthTiles[] =
#include "shaders/depth_tiles.comp.inc"
    ;
constexpr std::uint32_t kFilter[] =
#include "shaders/resident_filter.comp.inc"
    ;
constexpr std::uint32_t kMark[] =
#include "shaders/mark.frag.inc"
    ;

constexpr std::uint32_t kDepthTile = 8;
constexpr std::uint32_t kWords = partition::ChunkMap::kCapacity + 1;  ///< a chunk: how many, ids
constexpr std::uint32_t kWhollyIn = 0x80000000u;

struct Push {
  vk::DeviceAddress boxes, marks, candidates, state, chunks_in, chunk_objects, test;
  std::uint32_t stamp;
};

struct TilesPush {
  vk::DeviceAddress depth, tiles;
  std::uint32_t width, height, reversed;
};

struct FilterPush {
  vk::DeviceAddress boxes, marks, candidates, list, depth, tiles, test;
  std::uint32_t stamp;
};

constexpr std::array kParameters{culling::kContributionParameter, culling::kThresholdParameter,
                                 kRegionDepthParameter};

class ResidentChunk final : public TwoPhase {
public:
  ResidentChunk(vulkan::Renderer& renderer, const Parameters& parameters)
      : TwoPhase(renderer, culling::contribution_from(parameters)),
        chunks_(renderer.scene(), parameters.count("depth")),
        in_view_(renderer.device(), kTest, shader_constants(contribution_)),
        faces_(renderer.device(), {.vertex = kFace,
                                   .fragment = kMark,
                                   .constants = shader_constants(contribution_),
                                   .depth_write = false}),
        depth_tiles_(renderer.device(), kDepthTiles),
        filter_(renderer.device(), kFilter, shader_constants(contribution_)),
        candidates_(renderer.device(), renderer.scene().size() * 4, vulkan::Memory::device,
                    "objects in view"),
        list_(renderer.device(), renderer.scene().size() * 4, vulkan::Memory::device, "objects to test"),
        test_(renderer.device(), 20, vulkan::Memory::device, "a draw command") {
    send_changes();
  }

  void update(std::span<const ObjectId> objects) override {
    chunks_.update(renderer_.scene(), objects);
    send_changes();
  }

private:
  void send_changes() {
    partition::ChunkMap& map = chunks_.map();
    vulkan::Device& device = renderer_.device();
    const std::uint32_t limit = map.chunk_limit();
    if (limit > room_) {
      room_ = limit + limit / 2;
      resident_ = vulkan::Buffer(device, std::uint64_t{room_} * kWords * 4, vulkan::Memory::device, "chunks");
      chunks_in_ =
          vulkan::Buffer(device, std::uint64_t{room_} * 4, vulkan::Memory::upload, "which chunks are in");
      changed_.resize(limit);
      for (std::uint32_t chunk = 0; chunk < limit; ++chunk) changed_[chunk] = chunk;
    } else {
      changed_.assign(map.changed_chunks().begin(), map.changed_chunks().end());
    }
    map.acknowledge_changes();
    if (changed_.empty()) return;
    const std::size_t bytes = std::size_t{kWords} * 4;
    if (staging_.size() < changed_.size() * bytes) {
      staging_ = vulkan::Buffer(device, changed_.size() * bytes, vulkan::Memory::upload, "changed chunks");
    }
    regions_.clear();
    auto* words = staging_.mapped<std::uint32_t>();
    for (std::size_t i = 0; i < changed_.size(); ++i, words += kWords) {
      const partition::ChunkMap::ChunkView chunk = map.chunk(changed_[i]);
      words[0] = chunk.count;
      if (chunk.count > 0) std::memcpy(words + 1, chunk.objects, chunk.count * sizeof(ObjectId));
      regions_.push_back({i * bytes, changed_[i] * bytes, bytes});
    }
    device.run([&](const vk::raii::CommandBuffer& commands) {
      commands.copyBuffer(staging_.handle(), resident_.handle(), regions_);
      vulkan::full_barrier(commands);
    });
  }

  void find_in_view(vulkan::Recorder& frame) override {
    chunks_.select(frame.view, contribution_);
    auto* entry = chunks_in_.mapped<std::uint32_t>();
    for (const std::uint32_t chunk : chunks_.inside()) *entry++ = chunk | kWhollyIn;
    for (const std::uint32_t chunk : chunks_.crossing()) *entry++ = chunk;
    const auto count = static_cast<std::uint32_t>(chunks_.inside().size() + chunks_.crossing().size());
    chunks_in_count_ = count;
    const std::array<std::uint32_t, 5> empty{0, 1, 0, 0, 0};
    frame.commands.updateBuffer<std::uint32_t>(test_.handle(), 0, empty);
    vulkan::full_barrier(frame.commands);
    if (count == 0) return;
    frame.dispatch(in_view_,
                   Push{renderer_.buffers().box_data.address(), marks_.address(), candidates_.address(),
                        state_.address(), chunks_in_.address(), resident_.address(), test_.address(), stamp_},
                   count, 1);
  }

  void test(vulkan::Recorder& frame) override {
    if (chunks_in_count_ == 0) return;
    // What lies behind whole tiles of depth needs no raster test, by far the dearer one.
    const std::uint32_t width = frame.targets.depth.width(), height = frame.targets.depth.height();
    const std::uint32_t tiles =
        ((width + kDepthTile - 1) / kDepthTile) * ((height + kDepthTile - 1) / kDepthTile);
    if (depth_.size() < std::uint64_t{4} * width * height) {
      depth_ = vulkan::Buffer(renderer_.device(), std::uint64_t{4} * width * height, vulkan::Memory::device,
                              "depth");
    }
    if (tiles_of_depth_.size() < std::uint64_t{4} * tiles) {
      tiles_of_depth_ =
          vulkan::Buffer(renderer_.device(), std::uint64_t{4} * tiles, vulkan::Memory::device, "depth tiles");
    }
    const vk::DeviceAddress boxes = renderer_.buffers().box_data.address(),
                            farthest = tiles_of_depth_.address();
    frame.targets.depth.copy_to(frame.commands, depth_);
    frame.dispatch(depth_tiles_, TilesPush{depth_.address(), farthest, width, height, frame.reversed()},
                   tiles, 64);
    frame.dispatch(filter_,
                   FilterPush{boxes, marks_.address(), candidates_.address(), list_.address(),
                              depth_.address(), farthest, test_.address(), stamp_},
                   chunks_in_count_, 1);
    frame.begin_rendering({});
    frame.bind(faces_, vulkan::Recorder::Compare::nearer_or_equal, vulkan::kTestBias);
    frame.push(BoxPush{boxes, marks_.address(), list_.address(), 0, 0, stamp_});
    frame.commands.drawIndirect(test_.handle(), 0, 1, 16);
    frame.end_rendering();
    vulkan::full_barrier(frame.commands);
  }

  void count(CullStats& stats) override {
    stats.cull_vertices = read_words(renderer_.device(), test_, 5)[4];
    stats.nodes_visited = chunks_.nodes_visited();
  }

  GroundChunks chunks_;
  vulkan::ComputePipeline in_view_;
  vulkan::GraphicsPipeline faces_;
  vulkan::ComputePipeline depth_tiles_, filter_;
  vulkan::Buffer candidates_, list_, test_;
  vulkan::Buffer resident_, chunks_in_, staging_, depth_, tiles_of_depth_;
  std::uint32_t chunks_in_count_ = 0;
  std::uint32_t room_ = 0;  ///< chunks that the buffers hold
  std::vector<std::uint32_t> changed_;
  std::vector<vk::BufferCopy> regions_;
};

}  // namespace

const DeviceMethodInfo kResidentChunk{
    "resident-chunk",
    "beyond A",
    "vertex chunks kept on the GPU, facing faces tested, nothing drawn twice",
    Guarantee::exact,
    "",
    kParameters,
    make_on_device<ResidentChunk>};

}  // namespace sightline::methods
