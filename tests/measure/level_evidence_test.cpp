// What rays see in real levels against the visibility that the levels carry.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/io.hpp>
#include <sightline/workbench/worlds.hpp>

#include "workbench/camera/camera_path.hpp"
#include "workbench/report/evidence_table.hpp"
#include "workbench/scene/level_space.hpp"

namespace sightline::measure {
namespace {

class RealLevel : public testing::TestWithParam<const char*> {
protected:
  Scene scene = load_scene(std::string("pak1-maps.pk3:maps/") + GetParam() + ".bsp");
};

TEST_P(RealLevel, EveryObjectSeenIsInThePvsButForAnExplainedRemainder) {
  set_raster_state(scene, RasterState::both_sides);  // walls are solid, whichever side is drawn
  const oracle::EmbreeJudge judge(scene);
  const LevelEvidence evidence = gather_level_evidence(scene, judge, 40, 48, 7);
  EXPECT_EQ(evidence.eyes, 40u);
  EXPECT_GT(evidence.objects_seen, 1000u);
  EXPECT_EQ(evidence.objects[static_cast<std::size_t>(PvsException::unexplained)], 0u);
  EXPECT_EQ(std::accumulate(evidence.objects.begin(), evidence.objects.end(), std::uint64_t{0}),
            evidence.objects_denied);
  EXPECT_LT(evidence.objects_denied * 10, evidence.objects_seen);
}

TEST_P(RealLevel, VisibilityThatDeniesTooMuchIsFoundOut) {
  LevelPvs& level = *scene.level;
  // Every cluster but its own is denied.
  for (std::uint32_t from = 0; from < level.clusters; ++from) {
    for (std::uint32_t byte = 0; byte < level.bytes_per_cluster; ++byte) {
      level.visibility[std::size_t{from} * level.bytes_per_cluster + byte] =
          byte == from / 8 ? static_cast<std::uint8_t>(1u << from % 8) : std::uint8_t{0};
    }
  }
  const oracle::EmbreeJudge judge(scene);
  const LevelEvidence evidence = gather_level_evidence(scene, judge, 5, 32, 7);
  EXPECT_GT(evidence.objects[static_cast<std::size_t>(PvsException::unexplained)], 20u);
  EXPECT_FALSE(evidence.unexplained.empty());
}

TEST_P(RealLevel, WalkStaysInOpenSpaceAndGoesSomewhere) {
  const camera::CameraPath path = camera::make_path(scene, "walk", 200);
  ASSERT_EQ(path.cameras.size(), 200u);
  std::size_t open = 0;
  float metres = 0;
  for (std::size_t i = 0; i < path.cameras.size(); ++i) {
    EXPECT_TRUE(make_view(path.cameras[i], 64, 64));
    open += scene::is_open(*scene.level, path.cameras[i].eye);
    if (i == 0) continue;
    const Vec3 &a = path.cameras[i - 1].eye, &b = path.cameras[i].eye;
    metres += std::hypot(b.x - a.x, b.y - a.y, b.z - a.z);
  }
  EXPECT_GT(open, 190u);
  EXPECT_GT(metres, 50);
}

INSTANTIATE_TEST_SUITE_P(OpenArena, RealLevel, testing::Values("oasago2", "oa_dm1", "aggressor"),
                         [](const auto& test) { return std::string(test.param); });

TEST(LevelEvidence, BeyondTheFarPlaneALevelSaysNothing) {
  const char* const name = "pak1-maps.pk3:maps/ctf_compromise.bsp";
  Scene scene = load_scene(name);
  EXPECT_FLOAT_EQ(scene.level->far_plane, 2048 * 0.0254f);
  const auto count = [&](const LevelEvidence& evidence, PvsException why) {
    return evidence.objects[static_cast<std::size_t>(why)];
  };
  const oracle::EmbreeJudge judge(scene);
  const LevelEvidence honoured = gather_level_evidence(scene, judge, 40, 48, 7);
  scene.level->far_plane = std::numeric_limits<float>::infinity();
  const LevelEvidence not_read = gather_level_evidence(scene, judge, 40, 48, 7);
  EXPECT_GT(count(honoured, PvsException::beyond_far_plane), 0u);
  EXPECT_EQ(count(not_read, PvsException::beyond_far_plane), 0u);
  EXPECT_LT(count(honoured, PvsException::unexplained), count(not_read, PvsException::unexplained));
  EXPECT_EQ(count(honoured, PvsException::unexplained), 0u);
  EXPECT_EQ(honoured.objects_denied, not_read.objects_denied);
}

TEST(LevelEvidence, TableHasEveryReason) {
  LevelEvidence evidence;
  evidence.eyes = 7, evidence.objects_seen = 1000, evidence.objects_denied = 15,
  evidence.objects = {1, 2, 3, 4, 5, 6};
  const report::Table table = report::evidence_table(evidence);
  ASSERT_EQ(table.rows.size(), 1 + kPvsExceptions);
  EXPECT_EQ(table.rows[0][1], "985");
  for (std::size_t i = 0; i < kPvsExceptions; ++i) EXPECT_EQ(table.rows[i + 1][1], std::to_string(i + 1));
}

TEST(LevelEvidence, NeedsALevel) {
  const Scene scene = generate_world("regular?columns=2&rows=2");
  const oracle::EmbreeJudge judge(scene);
  EXPECT_THROW(gather_level_evidence(scene, judge, 1, 8, 1), Error);
}

TEST(LevelEvidence, EveryReasonHasItsSentence) {
  std::vector<std::string_view> sentences;
  for (std::size_t i = 0; i < kPvsExceptions; ++i)
    sentences.push_back(explanation(static_cast<PvsException>(i)));
  std::sort(sentences.begin(), sentences.end());
  EXPECT_EQ(std::unique(sentences.begin(), sentences.end()), sentences.end());
  EXPECT_FALSE(sentences.front().empty());
}

}  // namespace
}  // namespace sightline::measure
