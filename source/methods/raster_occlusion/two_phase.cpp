#include "methods/raster_occlusion/two_phase.hpp"

namespace sightline::methods {

namespace {

constexpr std::uint32_t kNewTiles[] =
#include "shaders/new_tiles.comp.inc"
    ;
constexpr std::uint32_t kTiedComp[] =
#include "shaders/tied.comp.inc"
    ;
constexpr std::uint32_t kTiedFrag[] =
#include "shaders/tied.frag.inc"
    ;
constexpr std::uint32_t kObjectVert[] =
#include "shaders/object.vert.inc"
    ;

using vulkan::PassKind;
using vulkan::Renderer;
using vulkan::VisibleDraws;

// As in state.h.
constexpr std::uint32_t kInView = 1, kDrawnEarly = 2, kSeen = 4, kTied = 8;
constexpr std::uint32_t kTile = 64;
constexpr std::uint32_t kFrames = 1u << 28;  ///< as many as a state can tell apart

/// Of this frame's states, those with `bits` of `mask`.
VisibleDraws::Condition among(std::uint32_t stamp, std::uint32_t mask, std::uint32_t bits) {
  return {~15u | mask, stamp << 4 | bits};
}
constexpr VisibleDraws::Condition kNever{0, 1};

struct Push {
  vk::DeviceAddress boxes, objects, marks, state, tiles;
  std::uint32_t count, stamp;
};

vulkan::Buffer zeros(vulkan::Device& device, std::size_t words) {
  return upload(device, std::vector<std::uint32_t>(words), "marks");
}

}  // namespace

TwoPhase::TwoPhase(Renderer& renderer, const culling::Contribution& contribution)
    : renderer_(renderer),
      contribution_(contribution),
      state_(zeros(renderer.device(), renderer.scene().size())),
      marks_(zeros(renderer.device(), renderer.scene().size())),
      new_tiles_(renderer.device(), kNewTiles, shader_constants(contribution)),
      tied_(renderer.device(), kTiedComp, shader_constants(contribution)),
      tied_pipeline_(renderer.device(), {.vertex = kObjectVert,
                                         .fragment = kTiedFrag,
                                         .input = vulkan::Input::mesh,
                                         .colour = vulkan::kColourFormat,
                                         .depth_write = false}),
      early_(renderer.draws().make_buffers(renderer.device())),
      late_(renderer.draws().make_buffers(renderer.device())) {}

void TwoPhase::record(vulkan::Recorder& frame) {
  begin_frame(frame);
  const auto sort = renderer_.transparent_order();
  {
    const auto pass = frame.pass("what is in view", PassKind::cull);
    find_in_view(frame);
    renderer_.draws().build(frame, state_.address(), among(stamp_, kDrawnEarly, kDrawnEarly), kNever, 0,
                            early_);
  }
  {
    const auto pass = frame.pass("draw last frame's visible objects", PassKind::draw);
    renderer_.draw_opaque(frame, early_, Renderer::Style::lit, Renderer::Clear::both);
  }
  {
    const auto pass = frame.pass("occlusion test", PassKind::cull);
    test(frame);
  }
  {
    const auto pass = frame.pass("what is new", PassKind::cull);
    settle_ties(frame);
    renderer_.draws().build(frame, state_.address(), among(stamp_, kDrawnEarly | kSeen, kSeen),
                            among(stamp_, kSeen, kSeen), sort, late_, among(stamp_, kTied, kTied), &early_);
  }
  const auto pass = frame.pass("draw new objects", PassKind::draw);
  renderer_.draw_opaque(frame, late_, Renderer::Style::lit, Renderer::Clear::nothing);
  renderer_.draw_opaque(frame, early_, tied_pipeline_, tiles_.address(), vulkan::Recorder::Compare::equal);
  renderer_.draw_transparent(frame, late_);
}

void TwoPhase::begin_frame(const vulkan::Recorder& frame) {
  const std::uint64_t tiles = 1 + std::uint64_t{(frame.targets.depth.width() + kTile - 1) / kTile} *
                                      ((frame.targets.depth.height() + kTile - 1) / kTile);
  const bool grown = tiles_.size() < 4 * tiles;
  if (grown) tiles_ = vulkan::Buffer(renderer_.device(), 4 * tiles, vulkan::Memory::device, "tiles");
  const bool over = ++stamp_ == kFrames;
  if (grown || over) frame.fill(tiles_, 0, tiles_.size());
  if (!over) return;
  frame.fill(state_, 0, state_.size());
  frame.fill(marks_, 0, marks_.size());
  stamp_ = 2;
}

void TwoPhase::settle_ties(vulkan::Recorder& frame) {
  const vulkan::SceneBuffers& scene = renderer_.buffers();
  const Push push{scene.box_data.address(),
                  scene.object_data.address(),
                  marks_.address(),
                  state_.address(),
                  tiles_.address(),
                  scene.objects,
                  stamp_};
  frame.dispatch(new_tiles_, push, scene.objects);
  frame.dispatch(tied_, push, scene.objects);
}

void TwoPhase::read_back(Frame& frame) {
  const std::vector<std::uint32_t> state = read_words(renderer_.device(), state_, renderer_.scene().size());
  std::vector<std::uint32_t> drawn(state.size());
  std::uint64_t in_view = 0;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const bool blended = renderer_.scene().surface[i] == Surface::transparent;
    const std::uint32_t bits = state[i] >> 4 == stamp_ ? state[i] : 0;
    drawn[i] = (bits & (blended ? kSeen : kSeen | kDrawnEarly)) != 0;
    in_view += bits & kInView;
  }
  report_visible(renderer_, drawn, {}, {}, frame);
  frame.stats.tested = in_view;
  frame.stats.culled_occlusion = in_view - frame.visible.size();
  count(frame.stats);
}

}  // namespace sightline::methods
