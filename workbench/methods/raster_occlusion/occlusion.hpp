// What the raster occlusion methods share: one mark an object, the depth of what was visible last frame, and
// drawing what is marked.
#pragma once

#include <array>
#include <optional>

#include "workbench/device/renderer.hpp"
#include "workbench/methods/methods.hpp"
#include "workbench/submission/contribution.hpp"

namespace sightline::methods {

inline constexpr std::array kOcclusionParameters{submission::kContributionParameter,
                                                 submission::kThresholdParameter};

/// Exact, unless objects are dropped by their area.
Guarantee guarantee_of(const submission::Contribution& contribution) noexcept;
/// Any place, unless objects are dropped that cover no pixel centre.
Coverage coverage_of(const submission::Contribution& contribution) noexcept;
/// The constants of shaders that include boxes.h.
std::array<std::uint32_t, 2> shader_constants(const submission::Contribution& contribution) noexcept;

/// Of a box's twelve triangles.
inline constexpr std::uint32_t kBoxVertices = 36;
/// Push constants of every pass that tests boxes by rasterising them.
struct BoxPush {
  vk::DeviceAddress boxes, marks, list;
  std::uint32_t listed, first_leaf, mark;  ///< mark: the word that says seen
};

/// A pipeline that marks boxes: depth tested, nothing written but marks.
device::GraphicsPipeline make_box_pipeline(const device::Device& device,
                                           const submission::Contribution& contribution);

/// A word an object, none of them seen yet.
device::Buffer make_marks(const device::Renderer& renderer);

/// Lists the objects with (flags[o] & mask) == value, and counts draw calls and triangles.
void report_visible(const device::Renderer& renderer, std::span<const std::uint32_t> flags,
                    device::VisibleDraws::Condition solid, device::VisibleDraws::Condition rest,
                    Frame& frame);

/// The frame of roc, hroc, ioc, ihzb and vertex-chunk: last frame's visible objects lay down depth for this
/// frame's camera; boxes are tested against it; what is marked is drawn.
class MarkAndDraw : public Method {
public:
  /// `least`: px², the area of an object that lays down depth; all do where none is given.
  MarkAndDraw(device::Renderer& renderer, const Parameters& parameters, std::optional<float> least = {});

  [[nodiscard]] Guarantee guarantee() const noexcept override { return guarantee_of(contribution_); }
  [[nodiscard]] Coverage coverage() const noexcept override { return Coverage::centres; }
  void do_record(FrameContext& context) final;
  void read_back(Frame& frame) final;

protected:
  /// Clears marks and tests boxes, each in a pass of its own.
  virtual void test(device::Recorder& frame) = 0;
  /// Where object 0's mark lies.
  [[nodiscard]] virtual vk::DeviceAddress marks() const noexcept = 0;
  [[nodiscard]] virtual std::vector<std::uint32_t> read_marks() = 0;
  virtual void count(CullStats& stats) = 0;

  device::Renderer& renderer_;
  submission::Contribution contribution_;

private:
  /// Of last frame's visible objects those that lay down depth, where not all do.
  struct Occluders {
    float least;
    device::ComputePipeline find;
    device::Buffer marks;
    device::DrawBuffers draws;
  };
  /// Who lays down depth.
  const device::DrawBuffers& find_occluders(device::Recorder& frame) const;

  device::DrawBuffers draws_;  ///< of the last frame until this frame's marks are known
  std::optional<Occluders> occluders_;
};

}  // namespace sightline::methods
