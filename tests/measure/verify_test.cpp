// The judge's verdicts: what counts as lost and as excess, that our methods hold, and that a broken one is
// found out and named.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include <sightline/frustum.hpp>
#include <sightline/workbench/error.hpp>
#include <sightline/workbench/worlds.hpp>

#include "workbench/camera/path_file.hpp"
#include "workbench/camera/random_views.hpp"
#include "workbench/measure/verify.hpp"
#include "workbench/oracle/loss.hpp"

namespace sightline::measure {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

oracle::ItemBuffer truth_of(std::vector<std::uint32_t> pixels) {
  oracle::ItemBuffer truth;
  truth.pixels = std::move(pixels);
  return truth;
}

TEST(Loss, CountsLostExcessAndPixels) {
  const oracle::ItemBuffer truth = truth_of({5, 0, 3, 0, 1});
  const oracle::Loss loss = oracle::compare_to_truth(truth, std::vector<ObjectId>{3, 4});
  EXPECT_THAT(loss.lost, ElementsAre(0u, 2u));
  EXPECT_EQ(loss.lost_pixels, 8u);
  EXPECT_THAT(loss.excess, ElementsAre(3u));
}

TEST(Loss, ExactSetLosesNothing) {
  const oracle::Loss loss = oracle::compare_to_truth(truth_of({1, 0, 2}), std::vector<ObjectId>{2, 0});
  EXPECT_THAT(loss.lost, IsEmpty());
  EXPECT_THAT(loss.excess, IsEmpty());
  EXPECT_EQ(loss.lost_pixels, 0u);
}

TEST(Loss, RefusesSetsThatNoMethodMayGive) {
  EXPECT_THROW(oracle::compare_to_truth(truth_of({1, 1}), std::vector<ObjectId>{0, 0}), Error);
  EXPECT_THROW(oracle::compare_to_truth(truth_of({1, 1}), std::vector<ObjectId>{2}), Error);
}

// A pixel that single precision alone gives to an object accuses nobody; one that double precision confirms
// does.
TEST(Loss, CountsOnlyWhatDoublePrecisionConfirms) {
  const Scene scene = generate_world("regular?columns=2&rows=1&spacing=10");
  const oracle::EmbreeJudge judge(scene);
  Camera camera;
  camera.eye = {scene.sphere(0).centre.x, scene.sphere(0).centre.y, scene.sphere(0).centre.z + 5};
  const View view = or_throw(make_view(camera, 40, 40));
  oracle::ItemBuffer truth = judge.render(view);
  ASSERT_GT(truth.pixels[0], 100u);
  ASSERT_EQ(truth.pixels[1], 0u);
  const std::uint32_t seen = truth.pixels[0];
  truth.ids[0] = 1, truth.pixels[1] = 1;    // a corner in which there is nothing
  truth.ids[39] = 0, truth.pixels[0] += 1;  // one pixel too many
  const oracle::Loss loss = oracle::confirmed_loss(judge, view, truth, {});
  EXPECT_THAT(loss.lost, ElementsAre(0u));
  EXPECT_EQ(loss.lost_pixels, seen);
}

/// Every box against the frustum, but the left plane has moved `metres` inwards.
class BrokenFrustum final : public Method {
public:
  BrokenFrustum(const Scene& scene, float metres, Guarantee guarantee)
      : Method(scene), metres_(metres), guarantee_(guarantee) {}
  [[nodiscard]] Guarantee guarantee() const noexcept override { return guarantee_; }
  void do_update(std::span<const ObjectId>) override {}
  void do_record(FrameContext& context) override {
    Frame& frame = context.output;
    frame.clear();
    Frustum frustum = make_frustum(context.view);
    frustum.planes[Frustum::left].distance -= metres_;
    for (ObjectId object = 0; object < scene_.size(); ++object) {
      if (overlaps(frustum, scene_.bounds[object])) frame.visible.push_back(object);
    }
  }

private:
  float metres_;
  Guarantee guarantee_;
};

Verification verify_broken(Scene& scene, float metres, Guarantee guarantee, std::span<const Camera> cameras) {
  Bench bench(scene, {});
  bench.add("broken", std::make_unique<BrokenFrustum>(scene, metres, guarantee));
  return verify(bench, cameras, 96, 64);
}

TEST(Verify, BrokenFrustumIsFoundAndViewAndObjectAreNamed) {
  Scene scene = generate_world("regular?columns=20&rows=20");
  const std::vector<Camera> cameras = camera::random_cameras(scene, 40, 3);
  const Verification sound = verify_broken(scene, 0, Guarantee::conservative, cameras);
  EXPECT_TRUE(sound.passed()) << describe(sound.methods[0], sound.methods[0].examples.at(0));

  const Verification result = verify_broken(scene, 1.5f, Guarantee::conservative, cameras);
  EXPECT_FALSE(result.passed());
  const MethodVerdict& verdict = result.methods[0];
  EXPECT_GT(verdict.lost_objects, 0u);
  EXPECT_GE(verdict.lost_pixels, verdict.lost_objects);
  ASSERT_FALSE(verdict.examples.empty());
  const LostObject& lost = verdict.examples[0];

  // What is named can be looked at again: the object has pixels in that very view.
  const View view = or_throw(make_view(lost.camera, lost.width, lost.height));
  EXPECT_GT(oracle::EmbreeJudge(scene).render(view).pixels[lost.object], 0u);
  const std::string sentence = describe(verdict, lost);
  EXPECT_THAT(sentence, HasSubstr("broken (conservative) lost object " + std::to_string(lost.object)));
  EXPECT_THAT(sentence, HasSubstr("in view " + std::to_string(lost.view)));
  EXPECT_THAT(sentence, HasSubstr("\"fov_degrees\""));

  const std::string numbers = "{\"views\": [" + sentence.substr(sentence.find('{')) + "]}";
  const std::vector<Camera> replayed = camera::parse_path("sentence", numbers);
  EXPECT_EQ(or_throw(make_view(replayed.at(0), lost.width, lost.height)), view);
}

TEST(Verify, SaysWhereAPictureDiffersThoughNothingIsLost) {
  measure::MethodVerdict verdict;
  verdict.method = "none";
  measure::LostObject where;
  where.view = 12, where.pixels = 2;
  EXPECT_NE(measure::describe(verdict, where).find("none (exact) drew 2 pixels otherwise in view 12"),
            std::string::npos);
  where.object = 3;
  EXPECT_NE(measure::describe(verdict, where).find("lost object 3 in view 12 (2 pixels"), std::string::npos);
}

TEST(Verify, ApproximateLossIsReportedAndIsNoFailure) {
  Scene scene = generate_world("regular?columns=20&rows=20");
  const std::vector<Camera> cameras = camera::random_cameras(scene, 40, 3);
  const Verification result = verify_broken(scene, 1.5f, Guarantee::approximate, cameras);
  EXPECT_TRUE(result.passed());
  EXPECT_GT(result.methods[0].lost_pixels, 0u);
}

class VerifyWorld : public testing::TestWithParam<const char*> {};

TEST_P(VerifyWorld, NoMethodLosesWhatItPromises) {
  Scene scene = generate_world(GetParam());
  Bench bench(scene, promising_methods(scene));
  const Verification result = verify(bench, camera::random_cameras(scene, 25, 7), 96, 64);
  EXPECT_EQ(result.views, 25u);
  ASSERT_GE(result.methods.size(), 4u);
  for (const MethodVerdict& verdict : result.methods) {
    EXPECT_TRUE(verdict.holds()) << describe(verdict, verdict.examples.at(0));
    EXPECT_GT(verdict.visible, 0u);
  }
}

INSTANTIATE_TEST_SUITE_P(Worlds, VerifyWorld,
                         testing::Values("regular?detail=2", "irregular?detail=2", "forest?trees=8000",
                                         "soup?triangles=40000"));

TEST(RandomViews, SameSeedSameCamerasAndEveryKind) {
  Scene scene = generate_world("regular?columns=20&rows=20");
  const std::vector<Camera> first = camera::random_cameras(scene, 400, 9),
                            second = camera::random_cameras(scene, 400, 9);
  std::size_t orthographic = 0, reversed = 0, infinite = 0, shifted = 0, rolled = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(camera::camera_json(first[i]), camera::camera_json(second[i]));
    orthographic += first[i].orthographic_height > 0;
    reversed += first[i].depth == Depth::reversed;
    infinite += std::isinf(first[i].far_plane);
    shifted += first[i].shift_x != 0;
    rolled += first[i].up != Vec3{0, 1, 0};
  }
  for (const std::size_t kind : {orthographic, reversed, infinite, shifted, rolled}) EXPECT_GT(kind, 10u);
  EXPECT_NE(camera::camera_json(camera::random_cameras(scene, 1, 10)[0]), camera::camera_json(first[0]));
}

TEST(Bench, UnknownMethodIsRefused) {
  Scene scene = generate_world("regular?columns=2&rows=2");
  EXPECT_THROW(Bench(scene, std::vector<std::string>{"nothing-like-it"}), Error);
}

// Centres see only what they see; at other places of the pixels more shows, which area keeps, at any
// resolution.
TEST(Verify, SamplesShowWhatCentresMissAndAreaKeepsIt) {
  Scene scene = generate_world("irregular?spheres=3000&detail=0");
  const std::vector<std::string> methods{"masked", "masked?coverage=area",
                                         "masked?coverage=area&resolution=half", "none"};
  const std::vector<Camera> cameras = camera::random_cameras(scene, 12, 11);
  Bench of_centres(scene, methods), of_samples(scene, methods, nullptr, 8);
  const Verification centres = verify(of_centres, cameras, 160, 120, 0),
                     samples = verify(of_samples, cameras, 160, 120, 0);
  EXPECT_TRUE(centres.passed());
  EXPECT_GT(samples.methods[0].visible, centres.methods[0].visible);
  // Whose promise is of centres, so that what it loses is no failure.
  EXPECT_GT(samples.methods[0].lost_objects, 0u);
  EXPECT_TRUE(samples.methods[0].of_centres && samples.methods[0].holds());
  EXPECT_EQ(samples.methods[0].examples.size(), 1u);
  EXPECT_FALSE(centres.methods[0].of_centres || samples.methods[3].of_centres);
  EXPECT_TRUE(samples.passed());
  for (const std::size_t by_area : {1u, 2u}) {
    const MethodVerdict& found = samples.methods[by_area];
    EXPECT_EQ(found.lost_objects, 0u) << found.method;
    EXPECT_FALSE(found.of_centres) << found.method;
    EXPECT_LT(found.kept, samples.methods[3].kept / 2) << found.method;
  }
}

}  // namespace
}  // namespace sightline::measure
