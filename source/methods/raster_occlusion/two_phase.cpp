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
constexpr VisibleDraws::Condition kEarly{kDrawnEarly, kDrawnEarly}, kLate{kDrawnEarly | kSeen, kSeen},
    kAnySeen{kSeen, kSeen}, kAnyTied{kTied, kTied}, kNever{0, 1};

struct Push {
  vk::DeviceAddress boxes, objects, marks, state, tiles;
  std::uint32_t count;
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
      last_marks_(zeros(renderer.device(), renderer.scene().size())),
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
  std::swap(marks_, last_marks_);
  const auto sort = renderer_.transparent_order();
  {
    const auto pass = frame.pass("what is in view", PassKind::cull);
    find_in_view(frame);
    renderer_.draws().build(frame, state_.address(), kEarly, kNever, 0, early_);
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
    renderer_.draws().build(frame, state_.address(), kLate, kAnySeen, sort, late_, kAnyTied, &early_);
  }
  const auto pass = frame.pass("draw new objects", PassKind::draw);
  renderer_.draw_opaque(frame, late_, Renderer::Style::lit, Renderer::Clear::nothing);
  renderer_.draw_opaque(frame, early_, tied_pipeline_, tiles_.address(), vulkan::Recorder::Compare::equal);
  renderer_.draw_transparent(frame, late_);
}

void TwoPhase::settle_ties(vulkan::Recorder& frame) {
  const vulkan::SceneBuffers& scene = renderer_.buffers();
  const std::uint64_t columns = (frame.targets.depth.width() + kTile - 1) / kTile;
  const std::uint64_t rows = (frame.targets.depth.height() + kTile - 1) / kTile;
  if (tiles_.size() < columns * rows * 4) {
    tiles_ = vulkan::Buffer(renderer_.device(), columns * rows * 4, vulkan::Memory::device, "tiles");
  }
  frame.fill(tiles_, 0, columns * rows * 4);
  const Push push{scene.box_data.address(), scene.object_data.address(),
                  marks_.address(),         state_.address(),
                  tiles_.address(),         scene.objects};
  frame.dispatch(new_tiles_, push, scene.objects);
  frame.dispatch(tied_, push, scene.objects);
}

void TwoPhase::read_back(Frame& frame) {
  const std::vector<std::uint32_t> state = read_words(renderer_.device(), state_, renderer_.scene().size());
  std::vector<std::uint32_t> drawn(state.size());
  std::uint64_t in_view = 0;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const bool blended = renderer_.scene().surface[i] == Surface::transparent;
    drawn[i] = (state[i] & (blended ? kSeen : kSeen | kDrawnEarly)) != 0;
    in_view += state[i] & kInView;
  }
  report_visible(renderer_, drawn, {}, {}, frame);
  frame.stats.tested = in_view;
  frame.stats.culled_occlusion = in_view - frame.visible.size();
  count(frame.stats);
}

}  // namespace sightline::methods
