// The invariants of paper C: object-frustum keeps exactly what a test of every object keeps, and its BLi and
// BLc are those of the paper's own walk when the grid is turned to the view.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <set>

#include <sightline/workbench/method.hpp>
#include <sightline/workbench/worlds.hpp>

#include "support/random_views.hpp"
#include "workbench/partition/object_grid.hpp"

namespace sightline {
namespace {

std::vector<ObjectId> kept(Method& method, const View& view) {
  Frame frame;
  cull(method, view, frame);
  std::sort(frame.visible.begin(), frame.visible.end());
  return frame.visible;
}

struct Case {
  const char *world, *parameters;
};

TEST(ObjectFrustum, KeepsExactlyWhatTestingEveryObjectKeeps) {
  constexpr std::array kCases{
      Case{"forest?trees=3000&size=300", ""}, Case{"forest?trees=3000&size=300", "?bounds=box"},
      Case{"irregular?spheres=2000&detail=0", "?bounds=sphere"}, Case{"soup?triangles=40000", "?bounds=box"}};
  scene::Random random(21);
  for (const Case& c : kCases) {
    const Scene scene = generate_world(c.world);
    const std::string parameters = c.parameters;
    const auto fine = create_method("object-frustum" + parameters, scene);
    const auto flat = create_method("vfc-vc" + parameters, scene);
    const auto coarse = create_method("grid-cell" + parameters, scene);
    const Box all = extent(scene);
    std::size_t some = 0;
    for (int v = 0; v < 2500; ++v) {
      const View view = test::random_view(random, all);
      const std::vector<ObjectId> expected = kept(*flat, view);
      ASSERT_EQ(kept(*fine, view), expected) << c.world << c.parameters << " view " << v;
      some += !expected.empty() && expected.size() < scene.size();
      if (v % 10 == 0) {
        const std::vector<ObjectId> cells = kept(*coarse, view);
        ASSERT_TRUE(std::includes(cells.begin(), cells.end(), expected.begin(), expected.end())) << v;
      }
    }
    EXPECT_GT(some, 1200u);
  }
}

using Cell = std::pair<std::uint32_t, std::uint32_t>;

struct Lists {
  std::set<Cell> inside, crossing;  // BLi, BLc
  bool operator==(const Lists&) const = default;
};

// Section 3 as printed, for a view along -z over a grid: rows from the viewpoint's near to far until a row's
// nearest distance passes the sight limit; in each row from the viewpoint's column to the left and to the
// right until the angle limit leaves the grid. A cell is inside where its farthest distance stays within
// every limit.
class PaperWalk {
public:
  PaperWalk(const partition::ObjectGrid& grid, const Frustum& frustum) : grid_(grid), frustum_(frustum) {}

  Lists walk(const Vec3& eye) {
    const std::uint32_t start = nearest_row(eye.z), middle = nearest_column(eye.x);
    for (std::uint32_t row = start + 1; row-- > 0;) {  // -z is ahead
      if (row_is_empty(row)) continue;
      if (beyond_distance_limit(row)) break;
      for (std::uint32_t column = middle; column < grid_.columns(); ++column) {
        if (beyond_angle_limit(row, column, Frustum::right)) break;
        sort_in(row, column);
      }
      for (std::uint32_t column = middle; column-- > 0;) {
        if (beyond_angle_limit(row, column, Frustum::left)) break;
        sort_in(row, column);
      }
    }
    return lists_;
  }

private:
  [[nodiscard]] std::uint32_t nearest_row(float z) const {
    std::uint32_t row = 0;
    for (std::uint32_t r = 0; r < grid_.rows(); ++r) {
      if (!row_is_empty(r) && grid_.cell_bounds(r, 0).min.z <= z) row = r;
    }
    return row;
  }
  [[nodiscard]] std::uint32_t nearest_column(float x) const {
    std::uint32_t column = 0;
    for (std::uint32_t c = 0; c < grid_.columns(); ++c) {
      const Box cell = grid_.cell_bounds(0, c);
      if (0.5f * (cell.min.x + cell.max.x) <= x) column = c;
    }
    return column;
  }
  [[nodiscard]] bool row_is_empty(std::uint32_t row) const {
    const auto [begin, end] = grid_.slots(row, 0, grid_.columns());
    return begin == end;
  }
  // The largest and the smallest distance of a cell's corners inwards from a limit.
  [[nodiscard]] std::pair<float, float> distances(std::uint32_t row, std::uint32_t column,
                                                  std::size_t side) const {
    const Box cell = grid_.cell_bounds(row, column);
    float low = INFINITY, high = -INFINITY;
    for (int corner = 0; corner < 8; ++corner) {
      const float d =
          signed_distance(frustum_.planes[side], corner & 1 ? cell.max.x : cell.min.x,
                          corner & 2 ? cell.max.y : cell.min.y, corner & 4 ? cell.max.z : cell.min.z);
      low = std::min(low, d), high = std::max(high, d);
    }
    return {low, high};
  }
  [[nodiscard]] bool beyond_distance_limit(std::uint32_t row) const {
    return distances(row, 0, Frustum::back).second < 0;
  }
  [[nodiscard]] bool beyond_angle_limit(std::uint32_t row, std::uint32_t column, std::size_t side) const {
    return distances(row, column, side).second < 0;
  }
  void sort_in(std::uint32_t row, std::uint32_t column) {
    bool inside = true;
    for (std::size_t side = 0; side < Frustum::sides; ++side) {
      const auto [low, high] = distances(row, column, side);
      if (high < 0) return;
      inside = inside && low >= 0;
    }
    (inside ? lists_.inside : lists_.crossing).insert({row, column});
  }

  const partition::ObjectGrid& grid_;
  const Frustum& frustum_;
  Lists lists_;
};

TEST(ObjectFrustum, SortsCellsLikeThePapersWalkOnAGridTurnedToTheView) {
  scene::Random random(22);
  std::size_t inside = 0, crossing = 0;
  for (int round = 0; round < 30; ++round) {
    const Scene scene = generate_world("forest?trees=4000&size=1000&seed=" + std::to_string(round));
    partition::ObjectGrid grid;
    grid.build(scene.bounds, random.between(15, 60));
    for (int v = 0; v < 50; ++v) {
      // As in the paper: level, over the trees, somewhere on the grid, heading along it.
      const Camera camera{
          .eye = {random.between(-450, 450), random.between(9, 40), random.between(-450, 450)},
          .vertical_fov = random.between(0.3f, 1.2f),
          .far_plane = random.between(100, 1500)};
      const View view = *make_view(camera, 1600, 900);
      const Frustum frustum = make_frustum(view);
      std::vector<partition::ObjectGrid::Run> runs;
      grid.classify(frustum, runs);
      Lists found;
      for (const auto& run : runs) {
        for (std::uint32_t c = run.first_column; c < run.last_column; ++c) {
          (run.overlap == Overlap::inside ? found.inside : found.crossing).insert({run.row, c});
        }
      }
      const Lists expected = PaperWalk(grid, frustum).walk(camera.eye);
      ASSERT_EQ(found.inside, expected.inside) << "round " << round << " view " << v;
      ASSERT_EQ(found.crossing, expected.crossing) << "round " << round << " view " << v;
      inside += found.inside.size(), crossing += found.crossing.size();
    }
  }
  EXPECT_GT(inside, 1000u);
  EXPECT_GT(crossing, 1000u);
}

TEST(ObjectFrustum, TestsOnlyObjectsOfCrossingCells) {
  const Scene scene = generate_world("forest");
  const auto method = create_method("object-frustum", scene);
  Frame frame;
  cull(*method, *make_view({.eye = {0, 8.9f, 0}, .far_plane = 600}, 1280, 720), frame);
  EXPECT_GT(frame.visible.size(), 500u);
  EXPECT_LT(frame.stats.tested, frame.visible.size());
}

// A column straight ahead is all that the printed walk keeps beyond the cells that the limits cross.
TEST(ObjectFrustum, ThePrintedWalkLosesObjectsAndSaysSo) {
  const Scene scene = generate_world("forest?trees=4000");
  const auto exact = create_method("object-frustum?cell=100", scene),
             printed = create_method("object-frustum?cell=100&walk=printed", scene);
  EXPECT_EQ(exact->guarantee(), Guarantee::conservative);
  EXPECT_EQ(printed->guarantee(), Guarantee::approximate);
  for (const Vec3 forward : {Vec3{0, 0, -1}, Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{-1, 0, 0}}) {
    const View view = *make_view({.eye = {0, 8.9f, 0}, .forward = forward, .far_plane = 420}, 1280, 720);
    const std::vector<ObjectId> all = kept(*exact, view), some = kept(*printed, view);
    std::vector<ObjectId> lost, both;
    std::ranges::set_difference(all, some, std::back_inserter(lost));
    std::ranges::set_intersection(all, some, std::back_inserter(both));
    EXPECT_GT(lost.size(), all.size() / 4) << forward.x << " " << forward.z;
    EXPECT_GT(both.size(), all.size() / 8) << forward.x << " " << forward.z;
  }
}

TEST(ObjectFrustum, LeavesOutLayersThatNobodyAsksFor) {
  Scene scene = generate_world("forest?trees=3000&size=300");
  scene.layers[5] = 6;
  const View view = *make_view({.eye = {0, 8.9f, 120}}, 1280, 720);
  for (const std::string name : {"grid-cell", "object-frustum"}) {
    const std::vector<ObjectId> all = kept(*create_method(name, scene), view);
    EXPECT_EQ(kept(*create_method(name + "?layers=7", scene), view), all);
    for (const std::uint32_t layers : {1u, 2u, 4u, 8u}) {
      const auto method = create_method(name + "?layers=" + std::to_string(layers), scene);
      EXPECT_EQ(method->guarantee(), Guarantee::approximate);
      std::vector<ObjectId> expected;
      std::ranges::copy_if(all, std::back_inserter(expected),
                           [&](ObjectId o) { return (scene.layers[o] & layers) != 0; });
      EXPECT_EQ(kept(*method, view), expected) << name << layers;
      EXPECT_LT(expected.size(), all.size());
    }
  }
}

TEST(ObjectFrustum, DrawsObjectByObjectWhereAskedTo) {
  const Scene scene = generate_world("forest?trees=3000&size=300");
  const View view = *make_view({.eye = {0, 8.9f, 120}}, 1280, 720);
  for (const std::string name : {"grid-cell", "object-frustum"}) {
    Frame instanced, objects;
    cull(*create_method(name, scene), view, instanced);
    cull(*create_method(name + "?submission=objects", scene), view, objects);
    EXPECT_FALSE(instanced.one_by_one);
    EXPECT_TRUE(objects.one_by_one);
    ASSERT_EQ(objects.draws.size(), objects.visible.size());
    EXPECT_EQ(objects.stats.draw_calls, objects.visible.size());
    EXPECT_LT(instanced.stats.draw_calls, objects.stats.draw_calls);
    EXPECT_EQ(objects.stats.triangles, instanced.stats.triangles);
    float last = -INFINITY;
    for (std::uint32_t i = 0; i < objects.draws.size(); ++i) {
      const DrawCommand& draw = objects.draws[i];
      const ObjectId object = objects.visible[i];
      ASSERT_EQ(draw.first_instance, i);
      ASSERT_EQ(draw.instance_count, 1u);
      ASSERT_EQ(draw.first_index, scene.meshes[scene.mesh[object]].first_index);
      // Front to back whatever the mesh, then back to front.
      const float ahead = 120 - scene.sphere(object).centre.z;
      const bool starts_over = i > 0 && scene.surface[object] != scene.surface[objects.visible[i - 1]];
      if (!starts_over && scene.surface[object] == Surface::opaque) ASSERT_GE(ahead, last - 1e-3f);
      if (!starts_over && scene.surface[object] != Surface::opaque) ASSERT_LE(ahead, last + 1e-3f);
      last = ahead;
    }
    std::ranges::sort(instanced.visible);
    std::ranges::sort(objects.visible);
    EXPECT_EQ(instanced.visible, objects.visible);
  }
}

TEST(ObjectFrustum, KeepsTheSameOverAnyGrid) {
  const Scene scene = generate_world("forest?trees=3000&size=300");
  const View view = *make_view({.eye = {0, 8.9f, 0}}, 1280, 720);
  const std::vector<ObjectId> all = kept(*create_method("object-frustum", scene), view);
  for (const std::string cells : {"?rows=4&columns=5", "?rows=6&columns=7", "?cell=60&rows=1"}) {
    EXPECT_EQ(kept(*create_method("object-frustum" + cells, scene), view), all) << cells;
    EXPECT_GT(kept(*create_method("grid-cell" + cells, scene), view).size(), all.size()) << cells;
  }
}

}  // namespace
}  // namespace sightline
