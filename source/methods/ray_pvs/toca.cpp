// TOCA, Ye et al. 2023, section 3.2: every ray against every box, on the CPU.
#include "methods/ray_pvs/ray_method.hpp"
#include "pvs/nearest_box.hpp"

namespace sightline::methods {

namespace {

constexpr std::array kParameters{kRaysParameter};

class Toca final : public RayMethod {
public:
  using RayMethod::RayMethod;

private:
  void cast(const pvs::RayGrid& grid, pvs::RayHits& hits) noexcept override {
    pvs::cast_at_all_boxes(scene_.bounds, grid.prepared, hits);
  }
};

}  // namespace

const MethodInfo kToca{"toca",
                       kRayPaper,
                       "100 x 100 rays, each against every box",
                       Guarantee::approximate,
                       "",
                       kParameters,
                       fits_any_scene,
                       make<Toca>};

}  // namespace sightline::methods
