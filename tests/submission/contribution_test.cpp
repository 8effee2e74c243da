#include "workbench/submission/contribution.hpp"

#include <gtest/gtest.h>

#include <sightline/workbench/worlds.hpp>

#include <numeric>

#include "library/geometry/linear.hpp"
#include "support/random_views.hpp"

namespace sightline::submission {
namespace {

using Kind = Contribution::Test;

std::vector<ObjectId> filtered(const Scene& scene, const View& view, Contribution contribution) {
  std::vector<ObjectId> ids(scene.size());
  std::iota(ids.begin(), ids.end(), ObjectId{0});
  ids.resize(contribution.filter(scene, make_projector(view, extent(scene)), ids));
  return ids;
}

// Whether a pixel centre lies in the rectangle that the box's vertices span, in double precision.
bool may_cover(const Scene& scene, const View& view, ObjectId object) {
  const glm::dmat4 clip = geometry::to_double(view.eye_to_clip) * geometry::to_double(view.world_to_eye);
  double low_x = 1e30, low_y = 1e30, high_x = -1e30, high_y = -1e30;
  const Mesh& mesh = scene.meshes[scene.mesh[object]];
  for (std::uint32_t i = 0; i < mesh.vertex_count; ++i) {
    const Vec3 p = transform_point(scene.transform[object], scene.positions[mesh.first_vertex + i]);
    const glm::dvec4 c = clip * glm::dvec4(geometry::to_double(p), 1);
    if (c.w <= 0) return true;
    const double x = (c.x / c.w + 1) * 0.5 * view.width, y = (1 - c.y / c.w) * 0.5 * view.height;
    low_x = std::min(low_x, x), high_x = std::max(high_x, x);
    low_y = std::min(low_y, y), high_y = std::max(high_y, y);
  }
  return std::ceil(low_x - 0.5) + 0.5 <= high_x && std::ceil(low_y - 0.5) + 0.5 <= high_y && high_x >= 0.5 &&
         high_y >= 0.5 && low_x <= view.width - 0.5 && low_y <= view.height - 0.5;
}

TEST(Contribution, OffKeepsEverything) {
  const Scene scene = generate_world("irregular?spheres=500&detail=1");
  const View view = *make_view({.eye = {0, 5, 200}}, 320, 200);
  EXPECT_EQ(filtered(scene, view, {}).size(), 500u);
}

TEST(Contribution, ExactDropsOnlyWhatCoversNoSample) {
  const Scene scene = generate_world("irregular?spheres=800&detail=1");
  scene::Random random(4);
  std::size_t dropped = 0;
  for (int v = 0; v < 40; ++v) {
    View view = test::random_view(random, {{-300, 1, -300}, {300, 40, 300}});
    view.width = 1 + random.below(200), view.height = 1 + random.below(120);
    const std::vector<ObjectId> kept = filtered(scene, view, {Kind::exact});
    dropped += scene.size() - kept.size();
    std::size_t next = 0;
    for (ObjectId id = 0; id < scene.size(); ++id) {
      const bool is_kept = next < kept.size() && kept[next] == id;
      next += is_kept;
      if (!is_kept) ASSERT_FALSE(may_cover(scene, view, id)) << "view " << v << " object " << id;
    }
  }
  EXPECT_GT(dropped, 5000u);
}

TEST(Contribution, AreaDropsWhatIsSmallerThanThePixelsAskedFor) {
  const Scene scene = generate_world("regular?columns=3&rows=100&detail=1");
  const View view = *make_view({.eye = {0, 1, 140}, .far_plane = 5000}, 200, 100);
  const std::size_t all = filtered(scene, view, {Kind::area, 0}).size();
  const std::size_t one = filtered(scene, view, {Kind::area, 1}).size();
  const std::size_t many = filtered(scene, view, {Kind::area, 20}).size();
  EXPECT_EQ(all, scene.size());
  EXPECT_LE(one, all);
  EXPECT_LT(many, one);
  EXPECT_GT(many, 0u);
}

}  // namespace
}  // namespace sightline::submission
