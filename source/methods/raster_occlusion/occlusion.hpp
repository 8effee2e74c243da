// What the raster occlusion methods share: one mark an object, the depth of what was visible last frame, and
// drawing what is marked.
#pragma once

#include <array>

#include "culling/contribution.hpp"
#include "methods/raster_occlusion/device_methods.hpp"

namespace sightline::methods {

inline constexpr std::array kOcclusionParameters{culling::kContributionParameter,
                                                 culling::kThresholdParameter};

/// Exact, unless objects are dropped by their area.
Guarantee guarantee_of(const culling::Contribution& contribution) noexcept;
/// The constants of shaders that include boxes.h.
std::array<std::uint32_t, 2> shader_constants(const culling::Contribution& contribution) noexcept;

/// Push constants of every pass that tests boxes by rasterising them.
struct BoxPush {
  vk::DeviceAddress boxes, marks, list;
  std::uint32_t listed, first_leaf, mark;  ///< mark: the word that says seen
};

/// A pipeline that marks boxes: depth tested, nothing written but marks.
vulkan::GraphicsPipeline make_box_pipeline(const vulkan::Device& device,
                                           const culling::Contribution& contribution);

/// Lists the objects with (flags[o] & mask) == value, and counts draw calls and triangles.
void report_visible(const vulkan::Renderer& renderer, std::span<const std::uint32_t> flags,
                    vulkan::VisibleDraws::Condition opaque, vulkan::VisibleDraws::Condition transparent,
                    Frame& frame);

/// The frame of roc, hroc and vertex-chunk: last frame's visible objects lay down depth for this frame's
/// camera; boxes are tested against it; what is marked is drawn.
class MarkAndDraw : public DeviceMethod {
public:
  MarkAndDraw(vulkan::Renderer& renderer, const Parameters& parameters);

  [[nodiscard]] Guarantee guarantee() const noexcept override { return guarantee_of(contribution_); }
  void record(vulkan::Recorder& frame) final;
  void read_back(Frame& frame) final;

protected:
  /// Clears marks and tests boxes, each in a pass of its own.
  virtual void test(vulkan::Recorder& frame) = 0;
  /// Where object 0's mark lies.
  [[nodiscard]] virtual vk::DeviceAddress marks() const noexcept = 0;
  [[nodiscard]] virtual std::vector<std::uint32_t> read_marks() = 0;
  virtual void count(CullStats& stats) = 0;

  vulkan::Renderer& renderer_;
  culling::Contribution contribution_;

private:
  vulkan::DrawBuffers draws_;  ///< of the last frame until this frame's marks are known
};

}  // namespace sightline::methods
