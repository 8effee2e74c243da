// Rays against the triangles themselves, on a grid as fine as the paper's, or guided to where they tell
// something.
#include <algorithm>
#include <array>
#include <bit>

#include "workbench/methods/ray_pvs/guided_rays.hpp"
#include "workbench/methods/ray_pvs/ray_method.hpp"
#include "workbench/submission/draw_list.hpp"

namespace sightline::methods {

namespace {

constexpr std::array kGridParameters{kRaysParameter};
constexpr std::array kGuidedParameters{
    ParameterInfo{"target", "share of the pixels that may show what is not drawn", "0.0001", 1e-7, 1},
    ParameterInfo{"spacing", "pixels between the first rays, rounded down to a power of two", "16", 1, 256,
                  true}};

class TriangleMethod : public CpuMethod {
public:
  explicit TriangleMethod(const Scene& scene)
      : CpuMethod(scene), rays_(scene), draw_list_(scene), seen_(scene.size()) {}

  [[nodiscard]] Guarantee guarantee() const noexcept final { return Guarantee::approximate; }
  void do_update(std::span<const ObjectId>) final { rays_.update(); }

  void cull(const View& view, Frame& frame) noexcept final {
    frame.clear();
    std::fill(seen_.begin(), seen_.end(), std::uint8_t{0});
    rays::RayStats stats;
    cast(view, stats);
    for (ObjectId object = 0; object < scene_.size(); ++object) {
      if (seen_[object]) frame.visible.push_back(object);
    }
    frame.stats.objects = scene_.size();
    frame.stats.rays = stats.rays;
    frame.stats.nodes_visited = stats.nodes;
    frame.stats.tested = stats.boxes;
    frame.stats.culled_occlusion = scene_.size() - frame.visible.size();
    draw_list_.build(scene_, view, frame);
  }

protected:
  virtual void cast(const View& view, rays::RayStats& stats) noexcept = 0;
  partition::TriangleRays rays_;
  partition::TriangleRays::Stack stack_;
  submission::DrawList draw_list_;
  std::vector<std::uint8_t> seen_;
};

class TrianglePvs final : public TriangleMethod {
public:
  TrianglePvs(const Scene& scene, const Parameters& parameters)
      : TriangleMethod(scene), side_(parameters.count(kRaysParameter.name)) {}

private:
  void cast(const View& view, rays::RayStats& stats) noexcept override {
    grid_.make(view, side_, side_);
    nearest_.resize(grid_.size());
    rays_.cast(grid_.rays, nearest_, seen_, stack_, stats);
  }

  std::uint32_t side_;
  rays::RayGrid grid_;
  std::vector<ObjectId> nearest_;
};

class Guided final : public TriangleMethod {
public:
  Guided(const Scene& scene, const Parameters& parameters)
      : TriangleMethod(scene),
        options_{parameters.number("target"), std::bit_floor(parameters.count("spacing"))} {}

private:
  void cast(const View& view, rays::RayStats& stats) noexcept override {
    guided_.cast(view, rays_, options_, seen_, stack_, stats);
  }

  methods::GuidedRays::Options options_;
  methods::GuidedRays guided_;
};

}  // namespace

extern const MethodInfo kTrianglePvs{.name = "triangle-pvs",
                                     .paper = "",
                                     .summary = "100 x 100 rays against the triangles themselves",
                                     .cpu = on_cpu<TrianglePvs>(Guarantee::approximate, kGridParameters)};

extern const MethodInfo kGuided{
    .name = "guided",
    .paper = "",
    .summary = "rays against triangles, more where neighbours disagree, until a target is met",
    .cpu = on_cpu<Guided>(Guarantee::approximate, kGuidedParameters)};

}  // namespace sightline::methods
