// Beyond paper D, which leaves open how fine a structure should be: several structures of several heights
// stand ready, and the frames themselves show which is quickest.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "workbench/methods/draw_calls/draw_call_method.hpp"
#include "workbench/methods/draw_calls/trials.hpp"

namespace sightline::methods {

class Adaptive final : public CpuMethod {
public:
  /// One of `plans`, submitted one way.
  struct Way {
    std::uint32_t plan;
    Submission submission;
  };
  /// Begins with ways[first].
  Adaptive(const Scene& scene, const std::vector<DrawCallPlan>& plans, std::vector<Way> ways,
           std::uint32_t first);

  [[nodiscard]] Guarantee guarantee() const noexcept override { return Guarantee::exact; }
  void do_update(std::span<const ObjectId> moved) override;
  void cull(const View& view, Frame& frame) noexcept override;
  void report_frame_time(double milliseconds) noexcept override { trials_.report_frame_time(milliseconds); }
  /// The triangles of all plans, one after the other; submission is that of the last frame's way.
  [[nodiscard]] const TriangleGeometry* geometry() const noexcept override { return &geometry_; }

  [[nodiscard]] bool settled() const noexcept { return trials_.settled(); }
  /// The way in use, as a method's specification: "cluster-cone?size=64&submission=merged".
  [[nodiscard]] std::string in_use() const;

private:
  struct Candidate {
    std::unique_ptr<DrawCallMethod> method;
    std::uint32_t first_triangle = 0;
  };

  void gather();

  std::vector<Candidate> candidates_;
  std::vector<Way> ways_;
  Trials trials_;
  std::vector<Vec3> positions_;
  std::vector<TextureCoordinate> texture_coordinates_;
  std::vector<std::uint32_t> indices_, sources_;
  std::vector<ObjectId> objects_;
  TriangleGeometry geometry_;
};

}  // namespace sightline::methods
