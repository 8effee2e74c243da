// The frame of resident-chunk and hiz: what was visible last frame is drawn at once, everything in view is
// tested against its depth, and only what is new is drawn after (Haar & Aaltonen 2015). Nothing is drawn
// twice, but for ties: where an object drawn late lies at another's very depth, the order of drawing decides
// the colour, so tiles that late objects touch are coloured once more in that order, at equal depth.
#pragma once

#include "workbench/methods/raster_occlusion/occlusion.hpp"

namespace sightline::methods {

class TwoPhase : public Method {
public:
  TwoPhase(device::Renderer& renderer, const submission::Contribution& contribution);

  [[nodiscard]] Guarantee guarantee() const noexcept override { return guarantee_of(contribution_); }
  [[nodiscard]] Coverage coverage() const noexcept override { return Coverage::centres; }
  void do_record(FrameContext& context) final;
  void read_back(Frame& frame) final;

protected:
  /// Sets the state (state.h) of every object that is in view, and whether the depth so far leaves it seen.
  virtual void test(device::Recorder& frame) = 0;
  virtual void count(CullStats& stats) = 0;
  /// Whether test() names as candidates whom it leaves seen, or asks the rasteriser about.
  [[nodiscard]] virtual device::VisibleDraws::Among listed_among() const noexcept {
    return device::VisibleDraws::Among::all;
  }

  device::Renderer& renderer_;
  submission::Contribution contribution_;
  device::Buffer state_;
  std::uint32_t stamp_ = 1;  ///< the frame's number, in states

private:
  void begin_frame(const device::Recorder& frame);
  void list_what_is_new(device::Recorder& frame);

  device::ComputePipeline new_tiles_, equal_depth_;
  device::GraphicsPipeline equal_depth_pipeline_;
  device::Buffer tiles_, follow_up_;
  device::DrawBuffers early_, late_, again_, next_;  ///< next: early in the frame that comes
};

}  // namespace sightline::methods
