// TOCA, Ye et al. 2023: every ray against every box, on the CPU.
#include "workbench/methods/ray_pvs/nearest_box.hpp"
#include "workbench/methods/ray_pvs/ray_method.hpp"

namespace sightline::methods {

namespace {

constexpr std::array kTocaParameters{kRaysParameter};

class Toca final : public RayMethod {
public:
  using RayMethod::RayMethod;

private:
  void cast(const rays::RayGrid& grid, rays::RayHits& hits) noexcept override {
    methods::cast_at_all_boxes(targets_.solid(), grid.prepared, hits);
  }
};

}  // namespace

extern const MethodInfo kToca{.name = "toca",
                              .paper = kRayPaper,
                              .summary = "100 x 100 rays, each against every box",
                              .cpu = on_cpu<Toca>(Guarantee::approximate, kTocaParameters)};

}  // namespace sightline::methods
