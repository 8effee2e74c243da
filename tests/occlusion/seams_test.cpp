// Where triangles of a mesh meet, no pixel stays open, whatever the near plane cuts; and none is covered that
// the triangles do not cover.
#include <gtest/gtest.h>

#include <sightline/occlusion.hpp>

#include <algorithm>

#include "support/exact_rays.hpp"
#include "workbench/scene/random.hpp"

namespace sightline {
namespace {

using scene::Random;
using test::ExactRays;

struct Shape {
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> indices;

  // Counter-clockwise from its front.
  void add_quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, bool turned = false) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    positions.insert(positions.end(), {a, b, c, d});
    for (const std::uint32_t k : {0, 1, 2, 0, 2, 3}) indices.push_back(first + k);
    if (turned) std::swap(indices[indices.size() - 5], indices[indices.size() - 4]);
    if (turned) std::swap(indices[indices.size() - 2], indices[indices.size() - 1]);
  }
};

struct Counted {
  std::size_t open = 0, beyond = 0, covered = 0;
};

// Pixels that stay open though a triangle covers them, and the reverse.
Counted count(const Shape& shape, const View& view, TJunctions junctions = TJunctions::open) {
  OcclusionBuffer buffer;
  EXPECT_TRUE(buffer.begin({view, {}}, {Coverage::centres}));
  EXPECT_TRUE(buffer.draw_mesh(*OccluderMesh::make(shape.positions, shape.indices, Sides::both, junctions)));
  std::vector<float> nearness(std::size_t{view.width} * view.height);
  EXPECT_TRUE(buffer.read_nearness(nearness));
  const ExactRays rays(view);
  Counted out;
  for (std::size_t pixel = 0; pixel < nearness.size(); ++pixel) {
    double truth = ExactRays::kMiss;
    for (std::size_t i = 0; i < shape.indices.size(); i += 3) {
      truth =
          std::max(truth, rays.hit(pixel % view.width + 0.5, pixel / view.width + 0.5,
                                   {shape.positions[shape.indices[i]], shape.positions[shape.indices[i + 1]],
                                    shape.positions[shape.indices[i + 2]]}));
    }
    const bool drawn = nearness[pixel] > ExactRays::kMiss;
    out.open += truth > ExactRays::kMiss && !drawn;
    out.beyond += nearness[pixel] > truth;
    out.covered += drawn;
  }
  return out;
}

View looking(Random& random, const Box& from, const Vec3& at) {
  Camera camera;
  camera.eye = random.inside(from);
  camera.forward = {at.x - camera.eye.x, at.y - camera.eye.y, at.z - camera.eye.z};
  camera.near_plane = 0.2f;
  camera.vertical_fov = random.between(0.8f, 1.6f);
  return *make_view(camera, 160, 100);
}

// A room seen from inside: floor, ceiling and four walls, `parts` quads to a side: a power of two, so that
// walls share their corners to the bit.
Shape room(int parts) {
  Shape out;
  const auto side = [&](const Vec3& o, const Vec3& u, const Vec3& v) {
    const auto at = [&](int i, int k) {
      const float s = static_cast<float>(i) / static_cast<float>(parts),
                  t = static_cast<float>(k) / static_cast<float>(parts);
      return Vec3{o.x + s * u.x + t * v.x, o.y + s * u.y + t * v.y, o.z + s * u.z + t * v.z};
    };
    for (int i = 0; i < parts; ++i) {
      for (int k = 0; k < parts; ++k) out.add_quad(at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1));
    }
  };
  side({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}), side({-4, 4, -4}, {8, 0, 0}, {0, 0, 8});
  side({-4, 0, -4}, {8, 0, 0}, {0, 4, 0}), side({4, 0, 4}, {-8, 0, 0}, {0, 4, 0});
  side({-4, 0, 4}, {0, 0, -8}, {0, 4, 0}), side({4, 0, -4}, {0, 0, 8}, {0, 4, 0});
  return out;
}

TEST(Seams, ARoomStaysClosedWhereTheNearPlaneCutsIt) {
  Random random(5);
  std::size_t open = 0;
  for (int round = 0; round < 24; ++round) {
    const Shape shape = room(1 << round % 3);
    const View view = looking(random, {{-3.5f, 0.3f, -3.5f}, {3.5f, 3.7f, 3.5f}}, random.direction());
    const Counted counted = count(shape, view);
    open += counted.open;
    EXPECT_EQ(counted.beyond, 0u) << "round " << round;
  }
  EXPECT_EQ(open, 0u);
}

TEST(Seams, LevelViewsHaveEdgesAlongPixelsBorders) {
  Camera camera{.eye = {0.25f, 1.7f, 0.125f}, .forward = {0, 0, -1}};
  const Counted counted = count(room(4), *make_view(camera, 160, 100));
  EXPECT_EQ(counted.open, 0u);
  EXPECT_EQ(counted.beyond, 0u);
}

// A wall of one wide quad, and beside each of its sides a row of narrow ones.
Shape uneven_wall(float slant) {
  Shape out;
  out.add_quad({-8, 0, 0}, {8, 0, slant}, {8, 4, slant}, {-8, 4, 0});
  for (int i = 0; i < 8; ++i) {
    const auto at = [&](int k) { return static_cast<float>(2 * k - 8); };
    const auto deep = [&](int k) { return slant * static_cast<float>(k) / 8; };
    out.add_quad({at(i), -4, deep(i)}, {at(i + 1), -4, deep(i + 1)}, {at(i + 1), 0, deep(i + 1)},
                 {at(i), 0, deep(i)});
    out.add_quad({at(i), 4, deep(i)}, {at(i + 1), 4, deep(i + 1)}, {at(i + 1), 8, deep(i + 1)},
                 {at(i), 8, deep(i)});
  }
  return out;
}

TEST(Seams, EdgesInARowCloseALongOne) {
  Random random(6);
  std::size_t open = 0, covered = 0, left_open = 0;
  for (int round = 0; round < 20; ++round) {
    const View view = looking(random, {{-6, -3, 4}, {6, 7, 14}}, {random.between(-3, 3), 2, 0});
    const Shape wall = uneven_wall(round % 2 == 0 ? 0.0f : 2.0f);
    const Counted counted = count(wall, view, TJunctions::closed);
    left_open += count(wall, view).open;
    EXPECT_EQ(counted.beyond, 0u) << "round " << round;
    open += counted.open, covered += counted.covered;
  }
  // What is open lies along the wall's outline.
  EXPECT_LT(open, covered / 2000);
  EXPECT_GT(left_open, open);
}

TEST(Seams, TellWhichEdgesStayOpen) {
  const Shape wall = uneven_wall(2);
  const auto made = [&](TJunctions junctions) {
    return *OccluderMesh::make(wall.positions, wall.indices, Sides::both, junctions);
  };
  // The ends of the wide quad and of both rows, and the rows' far sides; and without T-junctions the near
  // ones and the wide quad's long sides.
  EXPECT_EQ(made(TJunctions::closed).open_edges(), 2u + 2 * (2 + 8));
  EXPECT_EQ(made(TJunctions::open).open_edges(), 2u + 2 * (2 + 8) + 2 * (8 + 1));
  std::array<OccluderEdge, 3> first;
  EXPECT_EQ(made(TJunctions::closed).open_edges(first), 22u);
  for (const OccluderEdge& edge : first) EXPECT_NE(edge.from, edge.to);
}

TEST(Seams, AWallOnASeamOfTheFloorLeavesItClosed) {
  Shape shape;
  for (int i = -4; i < 4; ++i) {
    const auto x = static_cast<float>(2 * i);
    shape.add_quad({x, 0, 8}, {x + 2, 0, 8}, {x + 2, 0, 0}, {x, 0, 0});
    shape.add_quad({x, 0, 0}, {x + 2, 0, 0}, {x + 2, 0, -30}, {x, 0, -30});
  }
  shape.add_quad({0, 0, 0}, {2, 0, 0}, {2, 0.5f, 0}, {0, 0.5f, 0});  // a third at one edge
  Random random(7);
  std::size_t open = 0, covered = 0;
  for (int round = 0; round < 20; ++round) {
    const View view =
        looking(random, {{-5, 1, 2}, {5, 4, 7}}, {random.between(-2, 2), 0, random.between(-6, 0)});
    const Counted counted = count(shape, view);
    EXPECT_EQ(counted.beyond, 0u) << "round " << round;
    open += counted.open, covered += counted.covered;
  }
  EXPECT_LT(open, covered / 2000);
}

TEST(Seams, AFoldOfTrianglesWoundAlikeIsAnOutline) {
  Random random(8);
  for (int round = 0; round < 20; ++round) {
    Shape shape;
    for (int i = 0; i < 60; ++i) {
      const Vec3 a = random.inside({{-4, -3, -9}, {4, 3, -3}}), b = random.inside({{-4, -3, -9}, {4, 3, -3}});
      const Vec3 c = random.inside({{-4, -3, -9}, {4, 3, -3}}), d = random.inside({{-4, -3, -9}, {4, 3, -3}});
      const auto first = static_cast<std::uint32_t>(shape.positions.size());
      shape.positions.insert(shape.positions.end(), {a, b, c, d});
      for (const std::uint32_t k : {0, 1, 2, 0, 1, 3}) shape.indices.push_back(first + k);
    }
    EXPECT_EQ(count(shape, *make_view({}, 160, 100)).beyond, 0u) << "round " << round;
  }
}

// As what was exported twice does: each edge has all the others beside it, which took minutes.
TEST(Seams, BoxesThatLieUponEachOtherAreOne) {
  const auto pile = [](int boxes) {
    Shape out;
    for (int i = 0; i < boxes; ++i) {
      for (const float s : {-1.0f, 1.0f}) {
        out.add_quad({s, -1, -6}, {s, 1, -6}, {s, 1, -4}, {s, -1, -4}, s < 0);
        out.add_quad({-1, s, -6}, {-1, s, -4}, {1, s, -4}, {1, s, -6}, s < 0);
        out.add_quad({-1, -1, s - 5}, {1, -1, s - 5}, {1, 1, s - 5}, {-1, 1, s - 5}, s < 0);
      }
    }
    return out;
  };
  const auto drawn = [](const Shape& shape) {
    const OccluderMesh mesh = *OccluderMesh::make(shape.positions, shape.indices, Sides::both);
    OcclusionBuffer buffer;
    EXPECT_TRUE(buffer.begin({*make_view({}, 160, 100), {}}, {Coverage::centres}));
    EXPECT_TRUE(buffer.draw_mesh(mesh));
    std::vector<float> nearness(160 * 100);
    EXPECT_TRUE(buffer.read_nearness(nearness));
    return std::ranges::count_if(nearness, [](float at) { return at > ExactRays::kMiss; });
  };
  const auto many = drawn(pile(150));
  EXPECT_EQ(many, drawn(pile(1)));
  EXPECT_GT(many, 500);
  EXPECT_EQ(count(pile(3), *make_view({}, 160, 100)).beyond, 0u);
}

}  // namespace
}  // namespace sightline
