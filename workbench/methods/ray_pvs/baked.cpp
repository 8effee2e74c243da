// Draws what was baked for the eye's cell ('sightline bake'), then the view frustum. Approximate: the bake
// sampled.
#include <algorithm>

#include "workbench/methods/level/region_pvs.hpp"

namespace sightline::methods {

namespace {

struct BakedCells {
  const Scene& scene;

  explicit BakedCells(const Scene& of) : scene(of) {}
  [[nodiscard]] std::uint32_t region_at(const Vec3& eye) const noexcept { return scene.cells->cell_at(eye); }
  void mark(const Vec3&, std::uint32_t cell, std::span<std::uint8_t> mask) const noexcept {
    // Outside all open cells nothing is known, and everything may be seen.
    std::fill(mask.begin(), mask.end(), std::uint8_t{cell == kNoCell});
    if (cell == kNoCell) return;
    for (const ObjectId object : scene.cells->seen_from(cell)) mask[object] = 1;
  }
};

}  // namespace

extern const MethodInfo kBaked{.name = "baked",
                               .paper = "",
                               .summary = "the visible set baked for the eye's cell, then the frustum",
                               .cpu = {Guarantee::approximate,
                                       {},
                                       make_on_cpu<RegionPvs<BakedCells>>,
                                       "a baked PVS (sightline bake, --pvs FILE)",
                                       [](const Scene& scene) { return scene.cells != nullptr; }}};

}  // namespace sightline::methods
