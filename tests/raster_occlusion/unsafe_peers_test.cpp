// What engines ship loses something, and the oracle says so; the proven form beside it loses nothing.
#include <gtest/gtest.h>

#include <array>

#include "device/fixtures.hpp"
#include "workbench/camera/random_views.hpp"
#include "workbench/measure/verify.hpp"

namespace sightline {
namespace {

class UnsafePeers : public DeviceTest {};

TEST_F(UnsafePeers, LoseWhereTheCameraCutsAndKeepEverythingWhereItStands) {
  Scene scene = generate_world("city?objects=800");
  const std::array methods{std::string("hiz"), std::string("hiz-unsafe")};
  measure::Bench bench(scene, methods, &device());
  const std::vector<Camera> cameras = camera::random_cameras(scene, 30, 1);
  const measure::Verification seen = measure::verify(bench, cameras, 160, 120);
  EXPECT_EQ(seen.methods[0].lost_pixels, 0u);
  EXPECT_GT(seen.methods[1].lost_pixels, 0u);
  EXPECT_LT(seen.methods[1].kept, 0.95 * static_cast<double>(seen.methods[0].kept))
      << "it culls more, and wrongly";
  EXPECT_TRUE(seen.passed()) << "it promises nothing";

  // The first frame has no depth to go by: everything in view.
  measure::Bench fresh(scene, methods, &device());
  const Viewpoint& from = scene.viewpoints.front();
  const View view = or_throw(make_view({.eye = from.eye, .forward = from.forward}, 160, 120));
  measure::Subject& unsafe = fresh.subjects()[1];
  fresh.run(unsafe, view);
  const oracle::Judgement first = fresh.judge(unsafe, view);
  const std::size_t in_view = unsafe.frame.visible.size();
  EXPECT_EQ(first.loss.lost_pixels, 0u);
  fresh.run(unsafe, view);
  fresh.judge(unsafe, view);
  EXPECT_LT(unsafe.frame.visible.size(), in_view);
}

}  // namespace
}  // namespace sightline
