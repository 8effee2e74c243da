// BOCA, Ye et al. 2023, section 2.3: every ray down a bounding volume hierarchy, on the CPU.
#include "workbench/methods/ray_pvs/nearest_box.hpp"
#include "workbench/methods/ray_pvs/ray_method.hpp"

namespace sightline::methods {

namespace {

constexpr std::array kBocaParameters{kRaysParameter};

class Boca final : public RayMethod {
public:
  Boca(const Scene& scene, const Parameters& parameters) : RayMethod(scene, parameters) {
    bvh_.build(targets_.solid());
  }
  void do_update(std::span<const ObjectId> objects) override {
    RayMethod::do_update(objects);
    bvh_.refit(targets_.solid());
  }

private:
  void cast(const rays::RayGrid& grid, rays::RayHits& hits) noexcept override {
    methods::cast_down_bvh(bvh_, grid.prepared, hits);
  }

  rays::Bvh bvh_;
};

}  // namespace

extern const MethodInfo kBoca{.name = "boca",
                              .paper = kRayPaper,
                              .summary = "100 x 100 rays down a bounding volume hierarchy",
                              .cpu = on_cpu<Boca>(Guarantee::approximate, kBocaParameters)};

}  // namespace sightline::methods
