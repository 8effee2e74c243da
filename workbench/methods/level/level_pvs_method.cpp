// What a game level's own engine does: the potentially visible set of the eye's leaf, computed by the level's
// compiler, then the view frustum. Approximate: the compiler took undrawn (caulk) faces for walls.
#include "workbench/methods/level/region_pvs.hpp"

namespace sightline::methods {

namespace {

struct Leaves {
  const LevelPvs& level;

  explicit Leaves(const Scene& scene) : level(*scene.level) {}
  [[nodiscard]] std::uint32_t region_at(const Vec3& eye) const noexcept { return level.leaf_at(eye); }
  void mark(const Vec3& eye, std::uint32_t, std::span<std::uint8_t> mask) const noexcept {
    level.potentially_visible(eye, mask);
  }
};

}  // namespace

extern const MethodInfo kLevelPvs{.name = "level-pvs",
                                  .paper = "the level's compiler (Quake 3)",
                                  .summary = "the level's own visible set, then the frustum",
                                  .cpu = {Guarantee::approximate,
                                          {},
                                          make_on_cpu<RegionPvs<Leaves>>,
                                          "a level's PVS (a .bsp file)",
                                          [](const Scene& scene) { return scene.level.has_value(); }}};

}  // namespace sightline::methods
