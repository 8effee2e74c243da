// What the methods of Ye et al. 2023 share: a grid of rays through the viewport, the objects that are a ray's
// nearest or that it passes through, and the draw list of those.
#pragma once

#include <array>
#include <vector>

#include "library/rays/ray_grid.hpp"
#include "library/rays/ray_hits.hpp"
#include "workbench/methods/methods.hpp"
#include "workbench/methods/ray_pvs/ray_targets.hpp"
#include "workbench/submission/draw_list.hpp"

namespace sightline::methods {

inline constexpr std::string_view kRayPaper = "B: Ye et al. 2023";
/// The parameter `rays`: the paper casts 100 × 100.
inline constexpr ParameterInfo kRaysParameter{"rays", "along each side of the viewport", "100", 1, 4096,
                                              true};

/// Approximate by nature: things fall between rays, and a near box hides what its own geometry does not.
class RayMethod : public CpuMethod {
public:
  RayMethod(const Scene& scene, const Parameters& parameters)
      : CpuMethod(scene), targets_(scene), side_(parameters.count(kRaysParameter.name)), draw_list_(scene) {}

  [[nodiscard]] Guarantee guarantee() const noexcept final { return Guarantee::approximate; }
  void do_update(std::span<const ObjectId>) override { targets_.update(); }

  void cull(const View& view, Frame& frame) noexcept final {
    frame.clear();
    grid_.make(view, side_, side_);
    cast(grid_, hits_);
    targets_.collect(grid_.prepared, hits_, seen_, frame.visible);
    frame.stats.objects = scene_.size();
    frame.stats.rays = hits_.stats.rays;
    frame.stats.nodes_visited = hits_.stats.nodes;
    frame.stats.tested = hits_.stats.boxes;
    frame.stats.culled_occlusion = scene_.size() - frame.visible.size();
    draw_list_.build(scene_, view, frame);
  }

protected:
  /// Casts at targets_.solid(), and tells hits by its numbers.
  virtual void cast(const rays::RayGrid& grid, rays::RayHits& hits) noexcept = 0;

  RayTargets targets_;

private:
  std::uint32_t side_;
  submission::DrawList draw_list_;
  rays::RayGrid grid_;
  rays::RayHits hits_;
  std::vector<std::uint8_t> seen_;
};

}  // namespace sightline::methods
