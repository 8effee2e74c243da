// A method that walks through a level with its triangles on the device.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <sightline/workbench/method.hpp>

#include "workbench/device/triangle_draws.hpp"
#include "workbench/reproduce/draw_calls/draw_calls.hpp"

namespace sightline::reproduce {

class Walker {
public:
  /// "none" submits all triangles in one call, "nothing" not one.
  Walker(device::Renderer& renderer, const std::string& specification);

  /// Culls and draws a frame, and tells the method what it took. Returns what was measured.
  struct Times {
    double frame_ms = 0, cull_ms = 0, record_ms = 0;
    double typical_ms = 0;  ///< of several frames: the mean of the quicker four fifths
  };
  Times draw(device::Renderer& renderer, const View& view);

  /// What the last frame drew.
  [[nodiscard]] const Frame& frame() const noexcept { return frame_; }
  [[nodiscard]] Method& method() const noexcept { return *method_; }
  [[nodiscard]] bool culls() const noexcept { return what_ == What::method; }

  WalkRow row;

private:
  enum class What : std::uint8_t { method, everything, nothing } what_;
  std::unique_ptr<Method> method_;
  std::unique_ptr<device::TriangleDraws> draws_;
  Frame frame_;
};

/// All walkers in one view by turns, in an order that is drawn anew each round. A turn is two frames, of
/// which the second counts: the first finds the caches full of what the others left there, as no frame of a
/// program with one method does. Medians of the rounds, a walker each.
std::vector<Walker::Times> draw_by_turns(std::span<Walker* const> walkers, device::Renderer& renderer,
                                         const View& view, std::size_t turn, std::size_t rounds);

}  // namespace sightline::reproduce
