// Sets that are computed ahead: at their viewpoints they are boca's, anywhere else the nearest viewpoint's.
#include "workbench/methods/ray_pvs/break_time.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include <sightline/workbench/method.hpp>
#include <sightline/workbench/worlds.hpp>

namespace sightline::methods {
namespace {

View view_from(const Vec3& eye, const Vec3& forward) {
  return *make_view({.eye = eye, .forward = forward, .near_plane = 10, .far_plane = 1e5f}, 320, 180);
}

std::vector<ObjectId> kept(const BreakTimeSets& sets, const View& view) {
  const auto found = sets.look_up(view);
  return {found.begin(), found.end()};
}

TEST(BreakTime, KeepsWhatBocaFindsAtItsViewpoints) {
  Scene scene = generate_world("strata?triangles=20000");
  // What hides nothing is in boca's set, too.
  for (std::size_t i = 0; i < scene.size(); i += 5) scene.surface[i] = Surface::transparent;
  BreakTimeSets sets(scene, 40);
  const std::vector<View> views{view_from({40000, 0, 0}, {-1, 0, 0}),
                                view_from({0, 9000, 40000}, {0, -0.2f, -1}),
                                view_from({-30000, 20000, 0}, {1, -0.7f, 0})};
  EXPECT_TRUE(sets.look_up(views[0]).empty());
  for (const View& view : views) sets.add(view);
  EXPECT_EQ(sets.size(), views.size());
  const auto boca = create_method("boca?rays=40", scene);
  Frame frame;
  std::size_t objects = 0;
  for (const View& view : views) {
    cull(*boca, view, frame);
    std::ranges::sort(frame.visible);
    EXPECT_GT(frame.visible.size(), 50u);
    EXPECT_EQ(kept(sets, view), frame.visible);
    objects += frame.visible.size();
  }
  EXPECT_GE(sets.bytes(), objects * sizeof(ObjectId));
}

TEST(BreakTime, LooksUpTheNearestEyeAndOfEqualOnesTheNearestDirection) {
  const Scene scene = generate_world("strata?triangles=20000");
  BreakTimeSets sets(scene, 20);
  const View ahead = view_from({20000, 0, 0}, {-1, 0, 0}), aside = view_from({20000, 0, 0}, {-1, 0, 1}),
             elsewhere = view_from({0, 0, 30000}, {0, 0, -1});
  for (const View& view : {ahead, aside, elsewhere}) sets.add(view);
  EXPECT_NE(kept(sets, ahead), kept(sets, aside));
  EXPECT_EQ(kept(sets, view_from({19000, 100, 0}, {-1, 0, 0.9f})), kept(sets, aside));
  EXPECT_EQ(kept(sets, view_from({19000, 100, 0}, {-1, 0, -0.1f})), kept(sets, ahead));
  EXPECT_EQ(kept(sets, view_from({3000, 0, 25000}, {-1, 0, 0})), kept(sets, elsewhere));
}

}  // namespace
}  // namespace sightline::methods
