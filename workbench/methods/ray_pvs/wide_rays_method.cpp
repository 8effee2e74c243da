// The same rays and the same answer by our own tree: eight boxes at once, packets of rays, nearest first.
#include <sightline/tbb.hpp>

#include "library/rays/wide_rays.hpp"
#include "workbench/methods/ray_pvs/ray_method.hpp"

namespace sightline::methods {

namespace {

constexpr ParameterInfo kThreads{"threads", "that cast; 0: one a core", "0", 0, 256, true};
constexpr std::array kWideRaysParameters{kRaysParameter, kThreads};

class WideRays final : public RayMethod {
public:
  WideRays(const Scene& scene, const Parameters& parameters)
      : RayMethod(scene, parameters),
        jobs_(tbb_jobs(static_cast<std::uint32_t>(parameters.count(kThreads.name)))),
        stacks_(jobs_.threads) {
    bvh_.build(targets_.solid());
  }
  void do_update(std::span<const ObjectId> objects) override {
    RayMethod::do_update(objects);
    bvh_.refit(targets_.solid());
  }

private:
  void cast(const rays::RayGrid& grid, rays::RayHits& hits) noexcept override {
    rays::cast_wide(bvh_, grid, jobs_, stacks_, hits);
  }

  rays::WideBvh bvh_;
  JobSystem jobs_;
  std::vector<rays::WideStack> stacks_;
};

}  // namespace

extern const MethodInfo kWideRays{
    .name = "wide-rays",
    .paper = "",
    .summary = "the PVS of toca and boca by a wide SIMD tree and packets of rays, on all cores",
    .cpu = on_cpu<WideRays>(Guarantee::approximate, kWideRaysParameters)};

}  // namespace sightline::methods
