#include "workbench/methods/raster_occlusion/two_phase.hpp"

namespace sightline::methods {

namespace {

constexpr std::uint32_t kNewTiles[] =
#include "shaders/new_tiles.comp.inc"
    ;
constexpr std::uint32_t kEqualDepthComp[] =
#include "shaders/equal_depth.comp.inc"
    ;
constexpr std::uint32_t kEqualDepthFrag[] =
#include "shaders/equal_depth.frag.inc"
    ;
constexpr std::uint32_t kObjectVert[] =
#include "shaders/object.vert.inc"
    ;

using device::PassKind;
using device::Renderer;
using device::VisibleDraws;

// As in state.h.
constexpr std::uint32_t kInView = 1, kDrawnEarly = 2, kSeen = 4, kEqualDepth = 8;
constexpr std::uint32_t kTile = 64;
constexpr std::uint32_t kFrames = 1u << 28;  ///< as many as a state can tell apart

/// Of this frame's states, those with `bits` of `mask`.
VisibleDraws::Condition among(std::uint32_t stamp, std::uint32_t mask, std::uint32_t bits) {
  return {~15u | mask, stamp << 4 | bits};
}
constexpr VisibleDraws::Condition kNever{0, 1};

struct NewTilesPush {
  vk::DeviceAddress boxes, late, follow_up, listed, tiles;
  std::uint32_t objects, scan_groups, stamp, widest;
};

struct EqualDepthPush {
  vk::DeviceAddress boxes, objects, state, tiles;
  std::uint32_t count, stamp;
};

// What follows from there being something new: two VkDispatchIndirectCommands, as in new_tiles.comp.
constexpr vk::DeviceSize kEqualDepthGroups = 0, kScanGroups = 12, kFollowUpSize = 24;

}  // namespace

TwoPhase::TwoPhase(Renderer& renderer, const submission::Contribution& contribution)
    : Method(renderer.scene()),
      renderer_(renderer),
      contribution_(contribution),
      state_(upload(renderer.device(), std::vector<std::uint32_t>(renderer.scene().size()), "states")),
      new_tiles_(renderer.device(), kNewTiles, shader_constants(contribution)),
      equal_depth_(renderer.device(), kEqualDepthComp, shader_constants(contribution)),
      equal_depth_pipeline_(renderer.device(), {.vertex = kObjectVert,
                                                .fragment = kEqualDepthFrag,
                                                .input = device::Input::mesh,
                                                .colour = device::kColourFormat,
                                                .depth_write = false}),
      follow_up_(renderer.device(), kFollowUpSize, device::Memory::device, "dispatches"),
      early_(renderer.draws().make_buffers(renderer.device())),
      late_(renderer.draws().make_buffers(renderer.device())),
      again_(renderer.draws().make_buffers(renderer.device())),
      next_(renderer.draws().make_buffers(renderer.device())) {}

void TwoPhase::do_record(FrameContext& context) {
  device::Recorder& frame = *context.recorder;
  begin_frame(frame);
  {
    const auto pass = frame.pass("draw last frame's visible objects", PassKind::draw);
    renderer_.draw_solid(frame, early_, Renderer::Style::lit, Renderer::Clear::both);
  }
  {
    const auto pass = frame.pass("occlusion test", PassKind::cull);
    frame.commands.fillBuffer(follow_up_.handle(), 0, VK_WHOLE_SIZE, 0);
    frame.commands.fillBuffer(again_.commands.handle(), 0, VK_WHOLE_SIZE, 0);
    test(frame);
  }
  {
    const auto pass = frame.pass("what is new", PassKind::cull);
    list_what_is_new(frame);
  }
  {
    const auto pass = frame.pass("draw new objects", PassKind::draw);
    renderer_.draw_solid(frame, late_, Renderer::Style::lit, Renderer::Clear::nothing);
    renderer_.draw_solid(frame, again_, equal_depth_pipeline_, tiles_.address(),
                         device::Recorder::Compare::equal);
    renderer_.draw_rest(frame, late_);
  }
  std::swap(early_, next_);
}

void TwoPhase::begin_frame(const device::Recorder& frame) {
  const std::uint64_t tiles = 1 + std::uint64_t{(frame.targets.depth.width() + kTile - 1) / kTile} *
                                      ((frame.targets.depth.height() + kTile - 1) / kTile);
  const bool grown = tiles_.size() < 4 * tiles;
  if (grown) tiles_ = device::Buffer(renderer_.device(), 4 * tiles, device::Memory::device, "tiles");
  const bool over = ++stamp_ == kFrames;
  if (grown || over) frame.fill(tiles_, 0, tiles_.size());
  if (!over) return;
  frame.fill(state_, 0, state_.size());
  stamp_ = 2;
}

void TwoPhase::list_what_is_new(device::Recorder& frame) {
  const device::SceneBuffers& scene = renderer_.buffers();
  const VisibleDraws& draws = renderer_.draws();
  const VisibleDraws::Condition seen = among(stamp_, kSeen, kSeen);
  const VisibleDraws::List late{among(stamp_, kDrawnEarly | kSeen, kSeen), seen, &late_},
      next{seen, kNever, &next_};
  draws.build(frame, state_.address(), late, renderer_.transparent_order(), &next, listed_among());
  // Where nothing new is solid, what follows has no groups to run.
  const device::Recorder::Groups fresh = draws.listed(), equal_depth{follow_up_, kEqualDepthGroups},
                                 scan{follow_up_, kScanGroups};
  frame.dispatch(new_tiles_,
                 NewTilesPush{scene.box_data.address(), late_.list.address(), follow_up_.address(),
                              fresh.address(), tiles_.address(), scene.objects, draws.groups(), stamp_,
                              renderer_.device().widest_dispatch()},
                 fresh);
  frame.dispatch(equal_depth_,
                 EqualDepthPush{scene.box_data.address(), scene.object_data.address(), state_.address(),
                                tiles_.address(), scene.objects, stamp_},
                 equal_depth);
  draws.build_where(frame, state_.address(), {among(stamp_, kEqualDepth, kEqualDepth), kNever, &again_},
                    scan);
}

void TwoPhase::read_back(Frame& frame) {
  const std::vector<std::uint32_t> state = read_words(renderer_.device(), state_, renderer_.scene().size());
  std::vector<std::uint32_t> drawn(state.size());
  std::uint64_t in_view = 0, culled = 0;
  for (std::size_t i = 0; i < state.size(); ++i) {
    const std::uint32_t stamp = state[i] >> 4, bits = stamp == stamp_ ? state[i] : 0;
    // What was seen last frame was drawn at once, in view or not.
    const bool early = (bits & kDrawnEarly) != 0 || (stamp + 1 == stamp_ && (state[i] & kSeen) != 0);
    drawn[i] = (bits & kSeen) != 0 || (early && renderer_.buffers().is_solid(static_cast<ObjectId>(i)));
    in_view += bits & kInView;
    culled += (bits & kInView) != 0 && !drawn[i];
  }
  report_visible(renderer_, drawn, {}, {}, frame);
  frame.stats.tested = in_view;
  frame.stats.culled_occlusion = culled;
  count(frame.stats);
}

}  // namespace sightline::methods
