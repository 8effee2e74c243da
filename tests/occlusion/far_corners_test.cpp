// Triangles whose corners lie far to the side of what the image shows of them, or far along it.
#include <sightline/occlusion.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "library/geometry/linear.hpp"
#include "workbench/scene/random.hpp"

namespace sightline {
namespace {

using namespace geometry;
using Corners = std::array<Vec3, 3>;

constexpr std::uint32_t kPixels = 64;

// A view that looks anywhere, and where its image lies in the world; in double precision.
struct Anywhere {
  Anywhere(scene::Random& random, Camera camera) {
    camera.forward = random.direction(), camera.up = random.direction();
    view = *make_view(camera, kPixels, kPixels);
    to_eye = to_double(view.world_to_eye);
    clip = to_double(view.eye_to_clip) * to_eye;
  }
  // From the eye's own axes: to the right, up and ahead.
  [[nodiscard]] Vec3 point(double right, double up, double ahead) const {
    return to_vec3(glm::dvec3(glm::inverse(to_eye) * glm::dvec4(right, up, -ahead, 1)));
  }
  // x, y and w of a point in pixels.
  [[nodiscard]] glm::dvec3 on_image(const Vec3& p) const {
    const glm::dvec4 at = clip * glm::dvec4(to_double(p), 1);
    return {0.5 * kPixels * (at.x + at.w), 0.5 * kPixels * (at.w - at.y), at.w};
  }
  View view;
  glm::dmat4 to_eye, clip;
};

// A triangle's shares of its corners at a place of the image, each divided by the corner's w.
glm::dvec3 shares(const Anywhere& at, const Corners& t, double x, double y) {
  const glm::dvec3 a = at.on_image(t[0]), b = at.on_image(t[1]), c = at.on_image(t[2]), place(x, y, 1);
  return glm::dvec3(glm::dot(glm::cross(b, c), place), glm::dot(glm::cross(c, a), place),
                    glm::dot(glm::cross(a, b), place)) /
         glm::dot(a, glm::cross(b, c));
}

std::vector<float> drawn(const View& view, const Corners& triangle, Coverage coverage) {
  OcclusionBuffer buffer;
  EXPECT_TRUE(buffer.begin({view, {}}, {coverage}));
  const std::array<std::uint32_t, 3> indices{0, 1, 2};
  EXPECT_TRUE(buffer.draw_mesh(*OccluderMesh::make(triangle, indices, Sides::both)));
  std::vector<float> out(kPixels * kPixels);
  EXPECT_TRUE(buffer.read_nearness(out));
  return out;
}

// Corners up to 100 km to the side, a metre or two ahead.
TEST(FarCorners, ToTheSideTheyBringNoPlaneNearer) {
  scene::Random random(5);
  std::size_t held = 0;
  for (int i = 0; i < 1500; ++i) {
    const Anywhere at(random, {.near_plane = 0.1f, .far_plane = 1e5f});
    const double aside = std::pow(10.0, 3 + i % 3), ahead = random.between(0.5f, 2);
    Corners triangle;
    const double first = random.between(0, 6.28f);
    for (std::size_t k = 0; k < 3; ++k) {
      const double angle = first + 2.1 * static_cast<double>(k), far = aside * random.between(0.3f, 1);
      triangle[k] =
          at.point(far * std::cos(angle), far * std::sin(angle), ahead * random.between(0.6f, 1.4f));
    }
    const std::vector<float> nearness = drawn(at.view, triangle, i % 2 ? Coverage::area : Coverage::centres);
    for (const std::uint32_t pixel : {0u, 63u, 2080u, 4032u, 4095u}) {
      if (!(nearness[pixel] > 0)) continue;
      const glm::dvec3 share = shares(at, triangle, pixel % kPixels + 0.5, pixel / kPixels + 0.5);
      EXPECT_LE(nearness[pixel], (share.x + share.y + share.z) * (1 + 1e-6)) << i;
      ++held;
    }
  }
  EXPECT_GT(held, 1000u);
}

// Of 16 mm a pixel, 10 km ahead of the camera or behind it.
TEST(FarCorners, OrthographicViewsShowThemWhereTheyAre) {
  scene::Random random(6);
  std::size_t held = 0;
  for (int i = 0; i < 400; ++i) {
    const double ahead = (i % 4 < 2 ? 1e4 : -1e4) * random.between(0.9f, 1.1f),
                 first = random.between(0, 6.28f);
    const Anywhere at(random, {.orthographic_height = 1, .near_plane = -2e4f, .far_plane = 2e4f});
    Corners triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      const double angle = first + 2.1 * static_cast<double>(k);
      triangle[k] = at.point(0.39 * std::cos(angle), 0.39 * std::sin(angle), ahead);
    }
    const bool area = i % 2 == 0;
    const std::vector<float> nearness = drawn(at.view, triangle, area ? Coverage::area : Coverage::centres);
    for (std::uint32_t pixel = 0; pixel < kPixels * kPixels; ++pixel) {
      if (!std::isfinite(nearness[pixel])) continue;
      ++held;
      const double margin = area ? 0.49 : 0, x = pixel % kPixels + 0.5, y = pixel / kPixels + 0.5;
      for (const double up : {-margin, margin}) {
        for (const double right : {-margin, margin}) {
          const glm::dvec3 share = shares(at, triangle, x + right, y + up);
          EXPECT_GE(std::min({share.x, share.y, share.z}), 0) << i << ' ' << x << ' ' << y;
        }
      }
    }
  }
  EXPECT_GT(held, 40'000u);
}

// One beside a triangle that counts reaches behind the near plane, and the cut across it 100 km to both
// sides.
TEST(FarCorners, WhereTheNearPlaneCutsThemTheMeshEnds) {
  scene::Random random(7);
  std::size_t hidden = 0;
  for (int i = 0; i < 60; ++i) {
    constexpr float kFar = 1e5f;
    const Anywhere at(random, {.orthographic_height = kPixels, .near_plane = 0, .far_plane = 300});
    const double height = random.between(0.36f, 0.48f), before = 0.02 + 1e-6 * kFar;
    const std::vector<Vec3> positions{at.point(0.5, height, before), at.point(-20, 25, 10),
                                      at.point(20, 25, 10), at.point(-kFar, height - 0.8, -2 * before),
                                      at.point(kFar, height - 0.8, -2 * before)};
    const std::vector<std::uint32_t> indices{0, 2, 1, 0, 4, 2, 0, 3, 4, 0, 1, 3};
    OcclusionBuffer buffer;
    ASSERT_TRUE(buffer.begin({at.view, {}}, {Coverage::area}));
    ASSERT_TRUE(buffer.draw_mesh(*OccluderMesh::make(positions, indices, Sides::both, TJunctions::open)));
    const auto ahead = [&](const Vec3& p) { return -(at.to_eye * glm::dvec4(to_double(p), 1)).z; };
    const auto up = [&](const Vec3& p) { return (at.to_eye * glm::dvec4(to_double(p), 1)).y; };
    const auto cut = [&](const Vec3& p, const Vec3& q) {
      return up(p) + (up(q) - up(p)) * ahead(p) / (ahead(p) - ahead(q));
    };
    if (!(ahead(positions[3]) < 0) || !(ahead(positions[4]) < 0)) continue;
    const double low = std::min(cut(positions[0], positions[3]), cut(positions[0], positions[4]));
    const auto is_seen = [&](double height_there) {
      const Vec3 p = at.point(0.5, height_there, 20);
      return buffer.may_see(
          Box{{p.x - 0.005f, p.y - 0.005f, p.z - 0.005f}, {p.x + 0.005f, p.y + 0.005f, p.z + 0.005f}});
    };
    for (const double below : {0.02, 0.12, 0.22}) EXPECT_TRUE(is_seen(low - below)) << i;
    hidden += !is_seen(10);
  }
  EXPECT_GT(hidden, 20u);
}

// A wall beside the eye, which the near plane cuts at a column of the image: its corners reach 80 times as
// far as that plane, and a rasteriser's floats may move the edge by hundredths of a pixel.
TEST(FarCorners, KeepAwayFromTheEdgeThatTheNearPlaneMakes) {
  const View view = *make_view({.near_plane = 0.05f}, kPixels, kPixels);
  const double focal = 0.5 * kPixels * double{view.eye_to_clip.m[0]};
  constexpr std::uint32_t kColumn = 50, kRow = 20;
  const auto covered = [&](double inside) {
    // The near edge lies so far to the right of the column's centres.
    const double edge = kColumn + 0.5 + inside;
    const auto x = static_cast<float>((edge - 0.5 * kPixels) / focal * 0.05);
    const std::array corners{Vec3{x, -4, 4}, Vec3{x, -4, -4}, Vec3{x, 4, -4}, Vec3{x, 4, 4}};
    OcclusionBuffer buffer;
    EXPECT_TRUE(buffer.begin({view, {}}, {Coverage::centres}));
    EXPECT_TRUE(buffer.draw_mesh(*OccluderMesh::make(corners, std::array{0u, 1u, 2u, 0u, 2u, 3u})));
    std::vector<float> nearness(std::size_t{kPixels} * kPixels);
    EXPECT_TRUE(buffer.read_nearness(nearness));
    return nearness[kRow * kPixels + kColumn] > 0;
  };
  for (const double inside : {0.006, 0.008, 0.01}) EXPECT_FALSE(covered(inside)) << inside;
  EXPECT_TRUE(covered(0.1));
}

}  // namespace
}  // namespace sightline
