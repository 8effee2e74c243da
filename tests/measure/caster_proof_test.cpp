// No shadow caster is dropped whose shadow shows in a picture, and one that is would be noticed.
#include "workbench/measure/caster_proof.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/worlds.hpp>

#include "device/fixtures.hpp"
#include "workbench/camera/random_views.hpp"

namespace sightline::measure {
namespace {

class LitPictures : public DeviceTest {};
class CasterProof : public DeviceTest,
                    public testing::WithParamInterface<std::tuple<const char*, LightKind>> {};

TEST_P(CasterProof, DroppedCastersChangeNoLitPicture) {
  const auto& [world, light] = GetParam();
  const Scene scene = generate_world(world);
  device::Renderer renderer(device(), scene);
  const CasterEvidence found = prove_casters(renderer, camera::random_cameras(scene, 12, 7),
                                             {.light = light, .width = 96, .height = 72, .map = 256});
  EXPECT_GE(found.views, 10u);
  EXPECT_EQ(found.different_pixels, 0u) << "view " << found.first_different.value_or(0);
  EXPECT_GT(found.shaded_pixels, found.pixels / 20);
  EXPECT_LE(found.towards_it, found.in_light);
  EXPECT_LT(10 * found.kept, 9 * found.in_light);
  EXPECT_GT(std::ranges::count(found.picture.pixels, 0xffe6d4c2u), 0) << "a sky";
  EXPECT_EQ(std::ranges::count(found.picture.pixels, 0xff000000u), 0);
}

INSTANTIATE_TEST_SUITE_P(Scenes, CasterProof,
                         testing::Combine(testing::Values("city?objects=1500", "foliage?plants=200"),
                                          testing::Values(LightKind::directional, LightKind::spot)));

// Houses on a field at noon in autumn: without any caster the field is lit, and each house's shadow is seen.
TEST_F(LitPictures, TellEachCasterThatIsMissing) {
  const Scene scene = generate_world("city?objects=100");
  device::Renderer renderer(device(), scene);
  oracle::LitPictures pictures(renderer);
  const Box all = extent(scene);
  const Vec3 middle{0.5f * (all.min.x + all.max.x), all.max.y + 60, 0.5f * (all.min.z + all.max.z)};
  const View above =
      or_throw(make_view({.eye = middle, .forward = {0.01f, -1, 0}, .far_plane = 400}, 200, 200));
  const WorldView sun =
      or_throw(shadow_view({.direction = {1, -1, 0.3f}, .reach = 300}, {above, {}}, {}, 1024));
  std::vector<ObjectId> casters(scene.size());
  std::iota(casters.begin(), casters.end(), 0u);
  const std::vector<std::uint32_t> truth = pictures.draw(above, sun, {}).pixels;
  EXPECT_EQ(pictures.draw(above, sun, {}, casters).pixels, truth);
  std::size_t told = 0;
  for (std::size_t i = 0; i < casters.size(); ++i) {
    std::vector<ObjectId> others = casters;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    told += pictures.draw(above, sun, {}, others).pixels != truth;
  }
  EXPECT_GT(told, 15u);
}

TEST_F(LitPictures, AreNoneOfPointLights) {
  const Scene scene = generate_world("city?objects=100");
  device::Renderer renderer(device(), scene);
  EXPECT_THROW(prove_casters(renderer, {}, {.light = LightKind::point}), Error);
}

}  // namespace
}  // namespace sightline::measure
