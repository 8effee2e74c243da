// Occlusion on the CPU, after masked software occlusion culling (Hasselgren, Andersson & Akenine-Möller
// 2016): the frustum's objects first, of these the largest on the image as occluders into the depth tiles
// (round ones as spheres, which are cheap, so nearly all of them), then all against the tiles by box and
// sphere. Where a scene is one built thing of few triangles, like a game level, all of it occludes, and what
// its box leaves of an object is tested triangle by triangle.
#include <array>
#include <vector>

#include <sightline/world.hpp>

#include "library/geometry/mutant.h"
#include "workbench/methods/methods.hpp"
#include "workbench/methods/raster_occlusion/buffer_parameters.hpp"
#include "workbench/methods/raster_occlusion/scene_occluders.hpp"
#include "workbench/submission/draw_list.hpp"

namespace sightline::methods {

namespace {

constexpr std::array kMaskedParameters{
    ParameterInfo{"occluders", "at most so many objects occlude as meshes, the largest on the image", "512",
                  0, 100000, true},
    ParameterInfo{"pixels", "px², the least area of such an occluder's bounding sphere", "150", 0, 1e9},
    ParameterInfo{"spheres", "px², the least area of an object that occludes by the sphere inside it", "5", 0,
                  1e9},
    ParameterInfo{"whole", "most triangles of a scene that occludes as one", "150000", 0, 1e9, true},
    ParameterInfo{"solid",
                  "what occludes: opaque surfaces from the sides that are drawn, or everything, cut-outs "
                  "and both sides, as many engines have it: loses what is seen through and past them",
                  "opaque", 0, 0, false, "opaque|all"},
    kCoverageParameter,
    kResolutionParameter,
};

OccluderChoice choice_from(const Parameters& parameters) {
  return {.most = parameters.count("occluders"),
          .least_area = static_cast<float>(parameters.number("pixels")),
          .least_sphere = static_cast<float>(parameters.number("spheres")),
          .whole = parameters.count("whole"),
          .all_solid = parameters.word("solid") == "all",
          .buffer = buffer_from(parameters)};
}

class Masked final : public CpuMethod {
public:
  Masked(const Scene& scene, const Parameters& parameters)
      : CpuMethod(scene),
        all_solid_(parameters.word("solid") == "all"),
        coverage_(buffer_from(parameters).coverage),
        occluders_(scene, choice_from(parameters)),
        draw_list_(scene),
        handles_(scene.size()) {
    usable_ = static_cast<bool>(world_.insert(scene.bounds.view(), handles_));
  }

  [[nodiscard]] Guarantee guarantee() const noexcept override {
    return all_solid_ ? Guarantee::approximate : Guarantee::conservative;
  }
  [[nodiscard]] Coverage coverage() const noexcept override { return coverage_; }

  void do_update(std::span<const ObjectId> objects) override {
    for (const ObjectId o : objects)
      usable_ = usable_ && world_.move({&handles_[o], 1}, scene_.bounds.view().part(o, 1));
    occluders_.update(objects);
  }

  void cull(const View& view, Frame& frame) noexcept override {
    frame.clear();
    CullStats& stats = frame.stats;
    stats.objects = scene_.size();
    frame.visible.resize(cull_capacity(world_));
    const WorldView at{view, {}};
    CullResult result;
    // What is in view at all, from which occluders are picked.
    const bool as_one = occluders_.as_one(), usable = usable_ && occluders_.usable();
    bool culled = !as_one && cull_world({.view = at}, frame, result);
    const bool worth_it = as_one || (culled && result.count > 1);
    // A world or view beyond what the tiles hold is culled by frustum alone, or not at all.
    if (usable && worth_it && !SIGHTLINE_MUTANT(masked_by_frustum) &&
        occluders_.draw(at, std::span(frame.visible).first(result.count))) {
      culled = cull_world({.view = at, .occlusion = &occluders_.buffer()}, frame, result);
      const auto left = std::span(frame.visible).first(result.count);
      const std::size_t kept = occluders_.keep_seen(left);
      result.culled_occlusion += left.size() - kept;
      result.count = kept;
    } else if (as_one) {
      culled = cull_world({.view = at}, frame, result);
    }
    if (!usable || !culled) {
      frame.visible.resize(scene_.size());
      for (ObjectId o = 0; o < scene_.size(); ++o) frame.visible[o] = o;
    } else {
      frame.visible.resize(result.count);
      stats.culled_occlusion = result.culled_occlusion;
    }
    stats.tested = result.tested;
    stats.nodes_visited = result.nodes_visited;
    stats.culled_frustum = scene_.size() - frame.visible.size() - stats.culled_occlusion;
    draw_list_.build(scene_, view, frame);
  }

private:
  bool cull_world(const CullView& view, Frame& frame, CullResult& result) noexcept {
    const Result<CullResult> culled = culler_.cull(world_, view, frame.visible);
    result = culled ? *culled : CullResult{};
    return static_cast<bool>(culled);
  }

  bool all_solid_;
  Coverage coverage_;
  SceneOccluders occluders_;
  submission::DrawList draw_list_;
  World world_;
  Culler culler_;
  std::vector<Handle> handles_;
  bool usable_ = false;
};

}  // namespace

extern const MethodInfo kMasked{
    .name = "masked",
    .paper = "Hasselgren et al. 2016",
    .summary = "occluders into a hierarchical depth buffer on the CPU, then boxes against it",
    .cpu = on_cpu<Masked>(Guarantee::conservative, kMaskedParameters)};

}  // namespace sightline::methods
