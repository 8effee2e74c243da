// Beyond Lee & Shin 2023: the chunks stay on the GPU. Each frame sends only which chunks are in and what
// moved; chunks, and of those that may show objects, are tested in compute; at most the three faces that look
// at the eye are restored; objects that were visible last frame are drawn once, before the test.
#include <algorithm>
#include <cstring>
#include <numeric>
#include <span>
#include <utility>

#include <sightline/projection.hpp>

#include "library/geometry/mutant.h"
#include "workbench/methods/raster_occlusion/ground_chunks.hpp"
#include "workbench/methods/raster_occlusion/two_phase.hpp"

namespace sightline::methods {

namespace {

constexpr std::uint32_t kResidentChunks[] =
#include "shaders/resident_chunks.comp.inc"
    ;
constexpr std::uint32_t kResidentTest[] =
#include "shaders/resident_test.comp.inc"
    ;
constexpr std::uint32_t kFace[] =
#include "shaders/face.vert.inc"
    ;
constexpr std::uint32_t kDepthTiles[] =
#include "shaders/depth_tiles.comp.inc"
    ;
constexpr std::uint32_t kSeenBox[] =
#include "shaders/seen_box.frag.inc"
    ;

// As in the shaders.
constexpr std::uint32_t kDepthTile = 4, kBlock = 8, kFaceVertices = 18;
constexpr std::uint32_t kWords = world::ChunkMap::kCapacity + 1;  ///< a chunk: how many, ids
constexpr std::uint32_t kPart = 32;                               ///< objects that a workgroup takes
constexpr std::uint32_t kParts = (world::ChunkMap::kCapacity + kPart - 1) / kPart;
constexpr std::uint32_t kWhollyIn = 0x80000000u;

struct ResidentPush {
  vk::DeviceAddress boxes, state, chunks_in, chunk_objects, parts, tiles, slots, candidates, list, test;
  std::uint32_t stamp, chunks, widest;
  std::array<std::uint32_t, 4> blocks;  ///< the first, and how many across and down
  std::uint32_t ordered;
};

/// A chunk that is in.
struct ChunkIn {
  device::shared::BoxData bounds;
  std::uint32_t chunk, parts;
};

/// What the device finds out in a frame, as in resident.h.
struct TestData {
  std::array<vk::DrawIndirectCommand, 2> draws;
  vk::DispatchIndirectCommand part_groups;
  std::uint32_t parts;
};
static_assert(sizeof(TestData) == 48);

struct FacesPush {
  vk::DeviceAddress boxes, state, list;
  std::uint32_t across_edge;
};

/// The blocks of which tiles are worth making: those that chunks touch, but for chunks so small that their
/// pixels are looked at one by one, and for those that fill much of the picture, which are hardly ever
/// hidden: their objects cost less than the tiles. Chunks that come one after the other are near each other:
/// of most runs of them one look shows that they touch no more than those before.
class BlocksToMake {
public:
  BlocksToMake(const View& view, const Box& extent) : projector_(make_projector(view, extent)) {}

  void add(const Box& box) {
    run_[length_] = box;
    if (++length_ == run_.size()) end_run();
  }

  /// The first, and how many across and down.
  [[nodiscard]] std::array<std::uint32_t, 4> blocks() {
    end_run();
    if (!(touched_.min_x < touched_.max_x && touched_.min_y < touched_.max_y)) return {};
    const auto block = [](float at) { return static_cast<std::uint32_t>(at) / (kBlock * kDepthTile); };
    const std::uint32_t column = block(touched_.min_x), row = block(touched_.min_y);
    return {column, row, block(touched_.max_x) - column + 1, block(touched_.max_y) - row + 1};
  }

private:
  static constexpr float kFew = 256;     ///< pixels, as kMostPixels in resident_tiles.h
  static constexpr float kMuch = 0.01f;  ///< of the picture

  void end_run() {
    const std::span run = std::span(run_).first(std::exchange(length_, 0));
    if (run.empty()) return;
    const Box all = std::accumulate(run.begin() + 1, run.end(), run.front(), both);
    if (with(touched_, image_of(all)) == touched_) return;
    for (const Box& box : run) {
      const Rect image = image_of(box);
      const float area = (image.max_x - image.min_x) * (image.max_y - image.min_y);
      if (area > kFew && area < kMuch * projector_.width * projector_.height)
        touched_ = with(touched_, image);
    }
  }

  // Its image, of what lies in the picture.
  [[nodiscard]] Rect image_of(const Box& box) const {
    const Rect rect = projected_rect(projector_, box);
    const float right = projector_.width - 1, bottom = projector_.height - 1;
    return {std::clamp(rect.min_x, 0.0f, right), std::clamp(rect.min_y, 0.0f, bottom),
            std::clamp(rect.max_x, 0.0f, right), std::clamp(rect.max_y, 0.0f, bottom)};
  }

  static Box both(const Box& a, const Box& b) {
    return {{std::min(a.min.x, b.min.x), std::min(a.min.y, b.min.y), std::min(a.min.z, b.min.z)},
            {std::max(a.max.x, b.max.x), std::max(a.max.y, b.max.y), std::max(a.max.z, b.max.z)}};
  }

  static Rect with(const Rect& a, const Rect& b) {
    return {std::min(a.min_x, b.min_x), std::min(a.min_y, b.min_y), std::max(a.max_x, b.max_x),
            std::max(a.max_y, b.max_y)};
  }

  Projector projector_;
  std::array<Box, 8> run_;
  std::size_t length_ = 0;
  Rect touched_{1e9f, 1e9f, -1e9f, -1e9f};
};

constexpr std::array kResidentChunkParameters{submission::kContributionParameter,
                                              submission::kThresholdParameter, kRegionDepthParameter};

class ResidentChunk final : public TwoPhase {
public:
  ResidentChunk(device::Renderer& renderer, const Parameters& parameters)
      : TwoPhase(renderer, submission::contribution_from(parameters)),
        chunks_(renderer.scene(), parameters.count("depth")),
        tiles_(renderer.device(), kDepthTiles),
        coarse_(renderer.device(), kResidentChunks),
        objects_(renderer.device(), kResidentTest, shader_constants(contribution_)),
        faces_(renderer.device(), {.vertex = kFace,
                                   .fragment = kSeenBox,
                                   .constants = shader_constants(contribution_),
                                   .depth_write = false}),
        list_(renderer.device(), renderer.scene().size() * 4, device::Memory::device, "objects to test"),
        test_(renderer.device(), sizeof(TestData), device::Memory::device, "draw commands") {
    send_changes();
  }

  void do_update(std::span<const ObjectId> objects) override {
    chunks_.update(renderer_.scene(), objects);
    if (SIGHTLINE_MUTANT(stale_resident_chunks)) return;
    send_changes();
  }

private:
  void send_changes() {
    world::ChunkMap& map = chunks_.map();
    device::Device& device = renderer_.device();
    const std::uint32_t limit = map.chunk_limit();
    if (limit > room_) {
      room_ = limit + limit / 2;
      resident_ = device::Buffer(device, std::uint64_t{room_} * kWords * 4, device::Memory::device, "chunks");
      chunks_in_ = device::Buffer(device, std::uint64_t{room_} * sizeof(ChunkIn), device::Memory::upload,
                                  "which chunks are in");
      parts_ = device::Buffer(device, std::uint64_t{room_} * kParts * 4, device::Memory::device,
                              "what the tiles leave of them");
      changed_.resize(limit);
      for (std::uint32_t chunk = 0; chunk < limit; ++chunk) changed_[chunk] = chunk;
    } else {
      changed_.assign(map.changed_chunks().begin(), map.changed_chunks().end());
    }
    map.acknowledge_changes();
    if (changed_.empty()) return;
    const std::size_t bytes = std::size_t{kWords} * 4;
    if (staging_.size() < changed_.size() * bytes) {
      staging_ = device::Buffer(device, changed_.size() * bytes, device::Memory::upload, "changed chunks");
    }
    regions_.clear();
    auto* words = staging_.mapped<std::uint32_t>();
    for (std::size_t i = 0; i < changed_.size(); ++i, words += kWords) {
      const world::ChunkMap::ChunkView chunk = map.chunk(changed_[i]);
      words[0] = chunk.count;
      if (chunk.count > 0) std::memcpy(words + 1, chunk.objects, chunk.count * sizeof(ObjectId));
      if (i > 0 && changed_[i] == changed_[i - 1] + 1) {
        regions_.back().size += bytes;
      } else {
        regions_.push_back({i * bytes, changed_[i] * bytes, bytes});
      }
    }
    device.run([&](const vk::raii::CommandBuffer& commands) {
      commands.copyBuffer(staging_.handle(), resident_.handle(), regions_);
      device::full_barrier(commands);
    });
  }

  struct Entered {
    std::uint32_t chunks;
    std::array<std::uint32_t, 4> blocks;
  };
  /// Writes which chunks are in.
  Entered enter_chunks(const View& view) {
    BlocksToMake blocks(view, chunks_.extent());
    chunks_.select(view, contribution_);
    auto* const first = chunks_in_.mapped<ChunkIn>();
    auto* entry = first;
    const auto enter = [&](std::uint32_t chunk, std::uint32_t mark) {
      const std::uint32_t parts = (chunks_.map().chunk(chunk).count + kPart - 1) / kPart;
      const Box bounds = chunks_.map().chunk_bounds(chunk);
      blocks.add(bounds);
      *entry++ = {device::box_data(bounds, 0), chunk | mark, parts};
    };
    for (const std::uint32_t chunk : chunks_.inside()) enter(chunk, kWhollyIn);
    for (const std::uint32_t chunk : chunks_.crossing()) enter(chunk, 0);
    return {static_cast<std::uint32_t>(entry - first), blocks.blocks()};
  }

  void test(device::Recorder& frame) override {
    const auto [count, blocks] = enter_chunks(frame.view);
    if (count == 0) return;
    const TestData nothing{{vk::DrawIndirectCommand{0, 1, 0, 0},
                            vk::DrawIndirectCommand{0, 1, kFaceVertices * renderer_.buffers().objects, 0}},
                           {0, 1, 1},
                           0};
    frame.commands.updateBuffer<TestData>(test_.handle(), 0, nothing);
    make_room(frame.targets.depth.width(), frame.targets.depth.height());
    frame.targets.depth.begin_reading(frame.commands);
    const vk::DeviceAddress boxes = renderer_.buffers().box_data.address();
    const ResidentPush push{boxes,
                            state_.address(),
                            chunks_in_.address(),
                            resident_.address(),
                            parts_.address(),
                            farthest_.address(),
                            renderer_.buffers().object_slots.address(),
                            renderer_.draws().candidates(),
                            list_.address(),
                            test_.address(),
                            stamp_,
                            count,
                            frame.widest_dispatch(),
                            blocks,
                            renderer_.buffers().ordered};
    // What lies behind whole tiles of depth needs no raster test, by far the dearer one.
    frame.dispatch(tiles_, push, blocks[2] * blocks[3] * kBlock * kBlock, kBlock * kBlock);
    frame.dispatch(coarse_, push, count, kPart);
    frame.dispatch(objects_, push, {test_, offsetof(TestData, part_groups)});
    frame.targets.depth.end_reading(frame.commands);
    frame.begin_rendering({});
    frame.bind(faces_, device::Recorder::Compare::nearer_or_equal, device::kTestBias);
    for (const std::uint32_t across_edge : {0, 1}) {
      frame.push(FacesPush{boxes, state_.address(), list_.address(), across_edge});
      frame.commands.drawIndirect(test_.handle(), 16 * across_edge, 1, 16);
    }
    frame.end_rendering();
  }

  [[nodiscard]] device::VisibleDraws::Among listed_among() const noexcept override {
    return device::VisibleDraws::Among::candidates;
  }

  /// Room for the tiles of a picture.
  void make_room(std::uint64_t width, std::uint64_t height) {
    const auto tiles = [](std::uint64_t pixels) { return (pixels + kDepthTile - 1) / kDepthTile; };
    const std::uint64_t bytes = 4 * tiles(width) * tiles(height);
    if (farthest_.size() < bytes)
      farthest_ = device::Buffer(renderer_.device(), bytes, device::Memory::device, "depth tiles");
  }

  void count(CullStats& stats) override {
    stats.cull_vertices = stats.tested;
    stats.nodes_visited = chunks_.nodes_visited();
  }

  GroundChunks chunks_;
  device::ComputePipeline tiles_, coarse_, objects_;
  device::GraphicsPipeline faces_;
  device::Buffer list_, test_;
  device::Buffer resident_, chunks_in_, parts_, staging_, farthest_;
  std::uint32_t room_ = 0;  ///< chunks that the buffers hold
  std::vector<std::uint32_t> changed_;
  std::vector<vk::BufferCopy> regions_;
};

}  // namespace

extern const MethodInfo kResidentChunk{
    .name = "resident-chunk",
    .paper = "beyond A",
    .summary = "vertex chunks kept on the GPU, facing faces tested, nothing drawn twice but ties",
    .device = on_device<ResidentChunk>(Guarantee::exact, kResidentChunkParameters)};

}  // namespace sightline::methods
