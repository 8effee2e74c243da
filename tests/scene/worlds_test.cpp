#include <sightline/workbench/worlds.hpp>

#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>

#include "support/refusal.hpp"

namespace sightline {
namespace {

// Small versions of every world, so that a new one is tested the day it is added.
std::string small(std::string_view name) {
  if (name == "regular") return "regular?columns=7&rows=5";
  if (name == "irregular") return "irregular?spheres=300";
  if (name == "forest") return "forest?trees=300";
  if (name == "soup") return "soup?triangles=2000";
  if (name == "city") return "city?objects=1000";
  return std::string(name);
}

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST(Worlds, AreSoundAndReproducible) {
  for (const WorldInfo& world : worlds()) {
    const Scene a = generate_world(small(world.name)), b = generate_world(small(world.name));
    EXPECT_NO_THROW(check(a)) << world.name;
    EXPECT_TRUE(same_bytes(a.transform, b.transform)) << world.name;
    EXPECT_TRUE(same_bytes(a.positions, b.positions)) << world.name;
    EXPECT_GE(a.viewpoints.size(), 2u) << world.name;
  }
}

TEST(Worlds, HaveThePublishedSizes) {
  EXPECT_EQ(generate_world("regular").size(), 9024u);
  EXPECT_EQ(generate_world("irregular").size(), 9024u);
  EXPECT_EQ(generate_world("forest").size(), 30000u);
  EXPECT_EQ(triangle_count(generate_world("soup?triangles=12345")), 12345u);
  EXPECT_EQ(generate_world("regular?detail=2").triangles(0), 320u);
}

TEST(Worlds, SpheresStandInASquare) {
  EXPECT_EQ(generate_world("regular?spheres=120000&detail=0").size(), 120000u);
  EXPECT_EQ(generate_world("irregular?spheres=120000&detail=0").size(), 120000u);
  const Scene named = generate_world("regular?detail=0"),
              counted = generate_world("regular?spheres=9024&detail=0");
  EXPECT_TRUE(same_bytes(named.transform, counted.transform));
  const Scene prime = generate_world("regular?spheres=10007&detail=0");
  ASSERT_EQ(prime.size(), 10007u);
  const Box all = extent(prime);
  EXPECT_NEAR(all.max.x - all.min.x, all.max.z - all.min.z, 3 * 2.5);
  EXPECT_EQ(generate_world("regular?spheres=1&detail=0").size(), 1u);
}

TEST(Worlds, RefuseSpheresThatCannotBe) {
  for (const char* world : {"regular", "irregular"}) {
    for (const char* spheres : {"0", "-5", "1.5", "4000001", "many", ""}) {
      const std::string specification = std::string(world) + "?spheres=" + spheres;
      EXPECT_THAT(test::refusal([&] { generate_world(specification); }),
                  testing::HasSubstr("expected a whole number from 1 to 4000000"))
          << specification;
    }
  }
  EXPECT_THAT(test::refusal([] { generate_world("regular?spheres=400&rows=30"); }),
              testing::HasSubstr("'spheres' goes without 'columns' and 'rows'"));
}

TEST(Worlds, AForestStandsOnItsGround) {
  const Scene flat = generate_world("forest?trees=500"), hilly = generate_world("forest?trees=500&ground=64");
  ASSERT_EQ(hilly.size(), flat.size() + 1);
  EXPECT_EQ(hilly.triangles(500), 2u * 64 * 64);
  const std::span ground = std::span(hilly.positions).subspan(hilly.meshes.back().first_vertex);
  float lowest = 1e9f, highest = -1e9f;
  for (ObjectId tree = 0; tree < 500; ++tree) {
    const Vec3 was = transform_point(flat.transform[tree], {}),
               is = transform_point(hilly.transform[tree], {});
    EXPECT_EQ(was.x, is.x);
    EXPECT_EQ(was.z, is.z);
    EXPECT_EQ(was.y, 0);
    // Corners of the mesh are less than 16 m apart, and a hill rises less than a quarter of that.
    for (const Vec3& corner : ground) {
      if (std::hypot(corner.x - is.x, corner.z - is.z) < 8) ASSERT_NEAR(corner.y, is.y, 1.5f);
    }
    lowest = std::min(lowest, is.y), highest = std::max(highest, is.y);
    EXPECT_EQ(hilly.layers[tree], hilly.surface[tree] == Surface::opaque ? 1u : 2u);
  }
  EXPECT_GT(highest - lowest, 3);
  EXPECT_EQ(hilly.layers[500], 4u);
  EXPECT_FLOAT_EQ(flat.viewpoints[0].eye.y, 8.9f);
  EXPECT_GT(hilly.viewpoints[0].eye.y, 8.9f);
}

TEST(Worlds, FoliageIsOfEveryKind) {
  const Scene scene = generate_world("foliage");
  EXPECT_GT(scene.size(), 800u);
  EXPECT_LT(scene.size(), 1000u);
  for (const Surface surface : {Surface::opaque, Surface::cut_out}) {
    for (const Sides sides : {Sides::both, Sides::front}) {
      std::size_t count = 0;
      for (ObjectId o = 0; o < scene.size(); ++o)
        count += scene.surface[o] == surface && scene.sides[o] == sides;
      EXPECT_GT(count, 50u);
    }
  }
  ASSERT_EQ(scene.alpha_images.size(), 3u);
  for (const AlphaImage& image : scene.alpha_images) {
    const auto open = std::ranges::count_if(image.alpha, [](std::uint8_t alpha) { return alpha < 128; });
    EXPECT_GT(open, static_cast<std::ptrdiff_t>(image.alpha.size() / 8));
    EXPECT_LT(open, static_cast<std::ptrdiff_t>(image.alpha.size() * 3 / 4));
  }
}

TEST(Worlds, ACityHasAsManyObjectsAsAskedFor) {
  for (const std::uint32_t objects : {100u, 101u, 999u, 2000u, 12345u}) {
    const Scene scene = generate_world("city?objects=" + std::to_string(objects));
    EXPECT_EQ(scene.size(), objects);
    EXPECT_EQ(scene.meshes.size(), 16u) << "its parts are instances";
  }
  const Scene city = generate_world("city");
  EXPECT_EQ(city.size(), 10000u);
  const Box all = extent(city);
  EXPECT_NEAR(all.max.x, 450, 5);
  // Nobody looks from within a tower.
  for (const Viewpoint& view : city.viewpoints) {
    for (ObjectId o = 0; o < city.size(); ++o) {
      const Box box = city.bounds[o];
      const bool within = city.mesh[o] == 1 && view.eye.x > box.min.x && view.eye.x < box.max.x &&
                          view.eye.y < box.max.y && view.eye.z > box.min.z && view.eye.z < box.max.z;
      EXPECT_FALSE(within) << view.name;
    }
  }
}

TEST(Worlds, AnOffsetMovesTheOriginAlone) {
  const Scene near = generate_world("regular?columns=3&rows=3"),
              far = generate_world("regular?columns=3&rows=3&offset=-1e7");
  EXPECT_EQ(near.origin, WorldPoint{});
  EXPECT_EQ(far.origin, (WorldPoint{-1e7, 0, -1e7}));
  EXPECT_EQ(near.transform, far.transform);
}

TEST(Worlds, StrataHaveThePublishedMeshCountsAndStandCentred) {
  constexpr std::uint32_t kMeshes[] = {1371, 2684, 4433, 6744, 17773};
  for (int model = 1; model <= 5; ++model) {
    const Scene scene = generate_world("strata?triangles=400000&model=" + std::to_string(model));
    EXPECT_EQ(scene.size(), kMeshes[model - 1]);
    EXPECT_EQ(scene.meshes.size(), scene.size());
    EXPECT_NO_THROW(check(scene)) << model;
    EXPECT_NEAR(static_cast<double>(triangle_count(scene)), 4e5, 1e5) << model;
    const Box all = extent(scene);
    EXPECT_NEAR(all.min.x + all.max.x, 0, 1e-2);
    EXPECT_NEAR(all.min.y + all.max.y, 0, 1e-2);
    EXPECT_NEAR(all.min.z + all.max.z, 0, 1e-2);
    // The paper's viewpoint, level, from which all of the model fits into a view.
    EXPECT_EQ(scene.viewpoints[1].eye, (Vec3{40000, 0, 0}));
    EXPECT_EQ(scene.viewpoints[1].forward, (Vec3{-1, 0, 0}));
    const float nearest = 40000 - all.max.x;
    EXPECT_GT(nearest, 0);
    EXPECT_LT(std::max(all.max.y / 9, all.max.z / 16), nearest * std::tan(0.4f) / 9);
  }
}

// The divergence theorem: a closed body whose triangles face outwards has a positive volume.
TEST(Worlds, StrataAreBodiesThatFaceOutwards) {
  const Scene scene = generate_world("strata");
  for (const Mesh& mesh : scene.meshes) {
    double volume = 0;
    Vec3 area;
    for (std::uint32_t i = mesh.first_index; i < mesh.first_index + mesh.index_count; i += 3) {
      const auto corner = [&](std::uint32_t k) {
        return scene.positions[mesh.first_vertex + scene.indices[i + k]];
      };
      const Vec3 a = corner(0), b = corner(1), c = corner(2);
      const Vec3 n{(b.y - a.y) * (c.z - a.z) - (b.z - a.z) * (c.y - a.y),
                   (b.z - a.z) * (c.x - a.x) - (b.x - a.x) * (c.z - a.z),
                   (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)};
      volume += a.x * n.x + a.y * n.y + a.z * n.z;
      area = {area.x + n.x, area.y + n.y, area.z + n.z};
    }
    ASSERT_GT(volume, 0);
    // Closed: the outward areas cancel.
    ASSERT_NEAR(area.x, 0, 2);
    ASSERT_NEAR(area.y, 0, 2);
    ASSERT_NEAR(area.z, 0, 2);
  }
}

TEST(Worlds, AnotherSeedIsAnotherWorld) {
  const Scene a = generate_world("forest?trees=50&seed=1"), b = generate_world("forest?trees=50&seed=2");
  EXPECT_FALSE(same_bytes(a.transform, b.transform));
}

TEST(Worlds, TrianglesFaceOutwards) {
  const Scene scene = generate_world("regular?columns=1&rows=1&detail=1");
  for (std::size_t i = 0; i < scene.indices.size(); i += 3) {
    const Vec3 a = scene.positions[scene.indices[i]], b = scene.positions[scene.indices[i + 1]],
               c = scene.positions[scene.indices[i + 2]];
    const Vec3 u{b.x - a.x, b.y - a.y, b.z - a.z}, v{c.x - a.x, c.y - a.y, c.z - a.z};
    const Vec3 n{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    EXPECT_GT(n.x * a.x + n.y * a.y + n.z * a.z, 0);
  }
}

TEST(Worlds, RefuseWhatTheyDoNotKnow) {
  EXPECT_THAT(test::refusal([] { return generate_world("moon"); }),
              testing::HasSubstr("regular, irregular, forest, soup"));
  EXPECT_THROW(generate_world("forest?trees=0"), Error);
  EXPECT_THROW(generate_world("forest?trees=many"), Error);
  EXPECT_THROW(generate_world(""), Error);
}

}  // namespace
}  // namespace sightline
