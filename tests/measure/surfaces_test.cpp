// Cut-outs and sides: nothing that a standard renderer would show is lost, and what hides, hides.
#include <gtest/gtest.h>

#include <algorithm>

#include "device/fixtures.hpp"
#include "support/cards.hpp"
#include "workbench/camera/random_views.hpp"
#include "workbench/measure/verify.hpp"

namespace sightline {
namespace {

using SurfacesTest = DeviceTest;

std::vector<Scene> scenes() {
  std::vector<Scene> out = test::card_scenes();
  out.push_back(generate_world("foliage?size=30"));
  return out;
}

// From the scene's own places and from anywhere.
std::vector<Camera> cameras_of(const Scene& scene, std::size_t random) {
  std::vector<Camera> out = camera::random_cameras(scene, random, 5);
  for (const Viewpoint& at : scene.viewpoints) out.push_back({.eye = at.eye, .forward = at.forward});
  return out;
}

void expect_all_hold(const measure::Verification& result) {
  for (const measure::MethodVerdict& m : result.methods) {
    EXPECT_TRUE(m.holds()) << result.scene << ": " << m.method << " lost " << m.lost_pixels << " pixels, "
                           << m.different_pixels << " differ";
    if (m.guarantee != Guarantee::approximate) EXPECT_EQ(m.lost_pixels, 0u) << result.scene << m.method;
    EXPECT_GT(m.visible, 0u) << result.scene;
  }
}

TEST_F(SurfacesTest, NoMethodLosesAPixelOnTheCpu) {
  for (Scene& scene : scenes()) {
    for (const RasterState state :
         {RasterState::materials, RasterState::both_sides, RasterState::front_faces}) {
      set_raster_state(scene, state);
      measure::Bench bench(scene, measure::promising_methods(scene));
      expect_all_hold(measure::verify(bench, cameras_of(scene, 12), 96, 72));
      expect_all_hold(measure::verify(bench, cameras_of(scene, 4), 96, 72, 0.1));
    }
  }
}

TEST_F(SurfacesTest, NoMethodLosesAPixelOnADeviceAndPicturesAreEqual) {
  for (Scene& scene : scenes()) {
    measure::Bench bench(scene, measure::promising_methods(scene, true), &device());
    expect_all_hold(measure::verify(bench, cameras_of(scene, 4), 96, 72));
    expect_all_hold(measure::verify(bench, cameras_of(scene, 2), 96, 72, 0.1));
    measure::Bench handed(
        scene, std::vector<std::string>{"masked", "zhang-octree", "cluster-cone", "adaptive"}, &device());
    expect_all_hold(measure::verify(handed, cameras_of(scene, 2), 96, 72));
  }
}

// Where leaves are, the card is drawn; where none are, what is behind it.
TEST_F(SurfacesTest, CutOutsAreDrawnByTheirAlpha) {
  const auto picture = [&](std::uint8_t of_all, bool as_it_is) {
    Scene scene = generate_world("cards?show=leaves");
    for (AlphaImage& image : scene.alpha_images) {
      if (!as_it_is) std::ranges::fill(image.alpha, of_all);
    }
    measure::Bench bench(scene, std::vector<std::string>{"none"}, &device());
    const Viewpoint& from = scene.viewpoints[0];
    bench.run(bench.subjects()[0], view_of({.eye = from.eye, .forward = from.forward}, 160, 120));
    return bench.renderer()->picture().pixels;
  };
  const auto leaves = picture(0, true), whole = picture(255, false), nothing = picture(0, false);
  std::size_t drawn = 0, open = 0;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    ASSERT_TRUE(leaves[i] == whole[i] || leaves[i] == nothing[i]) << i;
    if (whole[i] == nothing[i]) continue;
    ++(leaves[i] == whole[i] ? drawn : open);
  }
  EXPECT_GT(drawn, 500u);
  EXPECT_GT(open, 500u);
}

std::vector<ObjectId> kept(const Scene& scene, const std::string& method, const Viewpoint& from) {
  Frame frame;
  cull(*create_method(method, scene), view_of({.eye = from.eye, .forward = from.forward}, 320, 240), frame);
  std::vector<ObjectId> out = frame.visible;
  std::ranges::sort(out);
  return out;
}

// Three cards, each before a box: seen from behind a single-sided one shows what is beyond it, a double-sided
// one does not; a mirrored one has its front where its mesh has it.
TEST_F(SurfacesTest, ACardHidesWhatItIsDrawnOver) {
  const Scene scene = generate_world("cards?show=sides");
  const auto has = [](const std::vector<ObjectId>& ids, ObjectId id) {
    return std::ranges::binary_search(ids, id);
  };
  const std::vector<ObjectId> front = kept(scene, "masked?pixels=1", scene.viewpoints[0]);
  EXPECT_TRUE(has(front, 1));
  EXPECT_FALSE(has(front, 2));
  EXPECT_FALSE(has(front, 3));
}

// Whoever takes everything for an occluder loses what is seen through and past it, and is told so.
TEST_F(SurfacesTest, WhatIsTakenForSolidCostsPixels) {
  for (Scene& scene : test::card_scenes()) {
    measure::Bench bench(scene, std::vector<std::string>{"masked?pixels=1&solid=all"});
    std::vector<Camera> cameras;
    for (const Viewpoint& from : scene.viewpoints)
      cameras.push_back({.eye = from.eye, .forward = from.forward});
    const measure::Verification result = measure::verify(bench, cameras, 320, 240);
    EXPECT_EQ(result.methods[0].guarantee, Guarantee::approximate);
    EXPECT_GT(result.methods[0].lost_pixels, 100u) << scene.name;
  }
}

// Rays at boxes and at triangles go on through what hides nothing.
TEST_F(SurfacesTest, RaysGoOnThroughLeaves) {
  const Scene scene = generate_world("cards");
  for (const char* method : {"toca", "boca", "wide-rays", "triangle-pvs", "guided"}) {
    const std::vector<ObjectId> seen = kept(scene, method, scene.viewpoints[0]);
    for (ObjectId object = 1; object < scene.size(); ++object)
      EXPECT_TRUE(std::ranges::binary_search(seen, object)) << method << ' ' << object;
  }
}

}  // namespace
}  // namespace sightline
