// The bench on a device: methods are told what their frames took, and those with triangles of their own are
// drawn by them and judged by them.
#include <array>

#include <gmock/gmock.h>

#include "device/fixtures.hpp"
#include "support/refusal.hpp"
#include "support/triangles.hpp"
#include "workbench/camera/random_views.hpp"
#include "workbench/measure/compare.hpp"
#include "workbench/measure/verify.hpp"

namespace sightline {
namespace {

class BenchTest : public DeviceTest {};

// Keeps everything, and counts what it is told.
class Listener final : public Method {
public:
  Listener(const Scene& scene, std::vector<double>& told) : Method(scene), told_(told) {}
  [[nodiscard]] Guarantee guarantee() const noexcept override { return Guarantee::exact; }
  void do_update(std::span<const ObjectId>) override {}
  void do_record(FrameContext& context) override { context.output.clear(); }
  void report_frame_time(double milliseconds) noexcept override { told_.push_back(milliseconds); }

private:
  std::vector<double>& told_;
};

TEST_F(BenchTest, TellsMethodsWhatTheirFramesTook) {
  Scene scene = generate_world("soup?triangles=200&size=60");
  measure::Bench bench(scene, {}, &device());
  std::vector<double> told;
  measure::Subject& listener = bench.add("listener", std::make_unique<Listener>(scene, told));
  const View view = view_of({.eye = {0, 0, 90}, .forward = {0, 0, -1}}, 64, 40);
  for (int frame = 0; frame < 3; ++frame) {
    const double took = bench.run(listener, view).frame_ms;
    ASSERT_EQ(told.size(), static_cast<std::size_t>(frame) + 1);
    EXPECT_EQ(told.back(), took);
  }
  // A frame that timestamps made slower is none to choose by.
  bench.run(listener, view, device::Timed::passes);
  EXPECT_EQ(told.size(), 3u);
}

// On a device as on the CPU: nothing that is refused reaches the device.
TEST_F(BenchTest, RefusesWhatNoMethodCanWorkWith) {
  Scene scene = generate_world("soup?triangles=600&per-object=20&size=60");
  std::vector<std::string> names;
  for (const MethodInfo& info : all_methods()) {
    if (info.cpu.suits(scene) || info.device.suits(scene)) names.emplace_back(info.name);
  }
  ASSERT_GT(names.size(), 20u);
  measure::Bench bench(scene, names, &device());
  const View view = view_of({.eye = {0, 0, 90}}, 64, 40);
  View nowhere = view;
  nowhere.world_to_eye.m[13] = std::numeric_limits<float>::quiet_NaN();
  const ObjectId beyond[]{static_cast<ObjectId>(scene.size())};
  EXPECT_THAT(test::refusal([&] { bench.update(beyond); }), testing::HasSubstr("no such object"));
  EXPECT_THROW(bench.oracle().look(nowhere), Error);
  for (measure::Subject& subject : bench.subjects()) {
    EXPECT_THROW(bench.run(subject, nowhere), Error) << subject.name;
    EXPECT_NO_THROW(bench.run(subject, view)) << subject.name;
    EXPECT_EQ(bench.judge(subject, view).loss.lost.size() > 0 &&
                  subject.method->guarantee() != Guarantee::approximate,
              false)
        << subject.name;
  }
  scene.add_object(0, {});
  const auto says_so = testing::HasSubstr("make it anew");
  const ObjectId first[]{0};
  EXPECT_THAT(test::refusal([&] { bench.update(first); }), says_so);
  EXPECT_THAT(test::refusal([&] {
                return create_method("roc", MethodSite{scene, bench.renderer()});
              }),
              says_so);
  EXPECT_THAT(test::refusal([&] { bench.oracle().look(view_of({}, 64, 40)); }), says_so);
  for (measure::Subject& subject : bench.subjects()) {
    EXPECT_THAT(test::refusal([&] { subject.method->update(first); }), says_so) << subject.name;
    EXPECT_THAT(test::refusal([&] { return bench.run(subject, view).frame_ms; }), says_so) << subject.name;
  }
}

TEST(BenchOnTheCpu, RefusesWhatNoMethodCanWorkWith) {
  Scene scene = generate_world("soup?triangles=600&per-object=20&size=60");
  const std::vector<std::string> names{"vfc-vc", "zhang-octree"};
  measure::Bench bench(scene, names);
  Camera nowhere;
  nowhere.eye.x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(measure::verify(bench, {&nowhere, 1}, 64, 40), Error);
  View view = view_of({.eye = {0, 0, 90}}, 64, 40);
  scene.add_object(0, {});
  for (measure::Subject& subject : bench.subjects()) EXPECT_THROW(bench.run(subject, view), Error);
  EXPECT_THROW(bench.oracle().look(view), Error);
  view.eye_to_clip = {{}};
  for (measure::Subject& subject : bench.subjects()) EXPECT_THROW(bench.run(subject, view), Error);
}

TEST_F(BenchTest, ComparesDrawCallMethodsByTheirOwnDraws) {
  Scene scene = generate_world("soup?triangles=3000&size=60");
  const std::vector<std::string> names{"simple-octree", "drawcall-wise-octree", "zhang-octree"};
  measure::Bench bench(scene, names, &device());
  camera::CameraPath path;
  path.cameras = camera::random_cameras(scene, 3, 21);
  measure::MeasureOptions options;
  options.width = 96, options.height = 64;
  options.warm_up = 0, options.repeats = 1;
  const measure::Comparison result = measure::compare(bench, path, options);
  for (const measure::Row& row : result.rows) {
    const auto method = create_method(row.method, scene);
    Frame frame;
    cull(*method, view_of(path.cameras[row.view], 96, 64), frame);
    EXPECT_EQ(row.stats.draw_calls, frame.stats.draw_calls) << row.method;
    EXPECT_EQ(row.stats.triangles, frame.stats.triangles) << row.method;
    EXPECT_EQ(row.lost_objects, 0u) << row.method;
  }
}

// One triangle an object, so that objects show nothing but their backs to half of the views; transparent
// ones; three of the same place.
TEST_F(BenchTest, VerifiesDrawCallMethodsByTheTrianglesThatTheyDraw) {
  std::vector<Scene> scenes;
  scenes.push_back(generate_world("soup?triangles=2000&per-object=1&size=60"));
  scenes.push_back(test::scene_of(test::awkward_triangles()[0].triangles));
  scenes.push_back(test::scene_of(test::awkward_triangles()[4].triangles));
  const std::vector<std::string> names{"simple-kd-tree", "drawcall-wise-octree", "zhang-octree?height=5",
                                       "cluster-cone", "adaptive"};
  for (Scene& scene : scenes) {
    measure::Bench bench(scene, names, &device());
    const auto result = measure::verify(bench, camera::random_cameras(scene, 8, 22), 96, 64, 0);
    EXPECT_TRUE(result.passed());
    for (std::size_t m = 0; m < names.size(); ++m) {
      EXPECT_GT(result.methods[m].visible, 0u);
      EXPECT_EQ(result.methods[m].lost_objects, 0u) << names[m];
      EXPECT_EQ(result.methods[m].different_pixels, 0u) << names[m];
    }
  }
}

// Triangles a thousand times as large as what they are strewn over: depths meet in single pixels, three at a
// time.
TEST_F(BenchTest, LetsAnyOfTheSurfacesAtOneDepthShow) {
  Scene scene = generate_world("soup?triangles=3000&per-object=1&size=1&edge=1000");
  const std::vector<std::string> names{"simple-kd-tree", "cluster-cone"};
  measure::Bench bench(scene, names, &device());
  const auto result = measure::verify(bench, camera::random_cameras(scene, 8, 1), 97, 61, 0);
  for (std::size_t m = 0; m < names.size(); ++m)
    EXPECT_EQ(result.methods[m].different_pixels, 0u) << names[m];
}

TEST_F(BenchTest, FindsOutWhatThePrintedFacingRuleLoses) {
  Scene scene = generate_world("soup?triangles=2000&per-object=1&size=60");
  set_raster_state(scene, RasterState::front_faces);
  const std::vector<std::string> names{"zhang-octree?facing=printed"};
  measure::Bench bench(scene, names, &device());
  const auto result = measure::verify(bench, camera::random_cameras(scene, 20, 23), 96, 64, 0);
  EXPECT_GT(result.methods[0].lost_objects, 0u);
  EXPECT_GT(result.methods[0].different_pixels, 0u);
}

TEST_F(BenchTest, DrawCallMethodsFollowMovedObjects) {
  Scene scene = generate_world("soup?triangles=600&per-object=20&size=60");
  const std::vector<std::string> names{"drawcall-wise-octree", "adaptive"};
  measure::Bench bench(scene, names, &device());
  const auto result = measure::verify(bench, camera::random_cameras(scene, 6, 24), 96, 64, 0.3);
  EXPECT_TRUE(result.passed());
}

}  // namespace
}  // namespace sightline
