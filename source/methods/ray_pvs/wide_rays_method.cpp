// The same rays and the same answer by our own tree: eight boxes at once, packets of rays, nearest first.
#include "methods/ray_pvs/ray_method.hpp"
#include "pvs/wide_rays.hpp"

namespace sightline::methods {

namespace {

constexpr std::array kParameters{kRaysParameter};

class WideRays final : public RayMethod {
public:
  WideRays(const Scene& scene, const Parameters& parameters) : RayMethod(scene, parameters) {
    bvh_.build(scene.bounds);
  }
  void update(std::span<const ObjectId>) override { bvh_.refit(scene_.bounds); }

private:
  void cast(const pvs::RayGrid& grid, pvs::RayHits& hits) noexcept override {
    pvs::cast_wide(bvh_, grid, stack_, hits);
  }

  partition::WideBvh bvh_;
  pvs::WideStack stack_;
};

}  // namespace

const MethodInfo kWideRays{"wide-rays",
                           "",
                           "the PVS of toca and boca by a wide SIMD tree and packets of rays",
                           Guarantee::approximate,
                           "",
                           kParameters,
                           fits_any_scene,
                           make<WideRays>};

}  // namespace sightline::methods
