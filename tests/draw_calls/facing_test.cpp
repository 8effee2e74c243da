// The facing rule against every triangle it would drop.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "library/geometry/linear.hpp"
#include "support/random_views.hpp"
#include "support/triangles.hpp"
#include "workbench/methods/draw_calls/facing.hpp"
#include "workbench/methods/draw_calls/flat_triangles.hpp"

namespace sightline::methods {
namespace {

using geometry::to_double;

double angle(const glm::dvec3& a, const glm::dvec3& b) {
  return std::acos(std::clamp(glm::dot(a, b) / (glm::length(a) * glm::length(b)), -1.0, 1.0));
}

/// A bundle of triangles whose normals lie around a direction.
struct Bundle {
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> indices, ids;

  Bundle(scene::Random& random, const Box& room, float spread) {
    const Vec3 around = random.direction();
    const std::uint32_t count = 1 + random.below(6);
    for (std::uint32_t t = 0; t < count; ++t) {
      const Vec3 w = random.direction();
      const glm::dvec3 n = glm::normalize(to_double(around) + double{spread} * to_double(w));
      const glm::dvec3 side =
          glm::normalize(glm::cross(n, std::fabs(n.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0)));
      const glm::dvec3 up = glm::cross(n, side), at = to_double(random.inside(room));
      for (const glm::dvec3& corner : {at, at + 2.0 * side, at + 2.0 * up})
        positions.push_back(geometry::to_vec3(corner));
      ids.push_back(t);
    }
    for (std::uint32_t i = 0; i < positions.size(); ++i) indices.push_back(i);
  }
  [[nodiscard]] partition::TriangleSpan span() const { return {positions, indices}; }
};

constexpr Box kEverywhere{{-1e4f, -1e4f, -1e4f}, {1e4f, 1e4f, 1e4f}};

TEST(Facing, DropsOnlyWhatIsSeenFromBehindAndAllThatTheSumOfAnglesDrops) {
  scene::Random random(51);
  std::size_t dropped = 0, kept = 0, by_angles = 0;
  for (int i = 0; i < 20000; ++i) {
    const Bundle bundle(random, {{-5, -5, -5}, {5, 5, 5}}, random.between(0, 0.8f));
    const FacingCone cone = cone_of(bundle.span(), bundle.ids, kEverywhere);
    const View view = test::random_view(random, {{-40, -40, -40}, {40, 40, 40}});
    const bool may_face = Facing(view, FacingRule::cone).may_face(cone);
    (may_face ? kept : dropped)++;
    const glm::dvec3 eye = to_double(eye_position(view));
    if (!may_face) {
      for (const std::uint32_t t : bundle.ids) {
        const auto corners = bundle.span()[t];
        const glm::dvec3 n = to_double(unit_normal(corners));
        const glm::dvec3 way =
            is_orthographic(view) ? to_double(view_direction(view)) : to_double(corners[0]) - eye;
        ASSERT_GT(glm::dot(n, way), 0) << "bundle " << i;
      }
    }
    if (is_orthographic(view) || cone.reach > 1) continue;
    // METHODS' rule: angle(a, d) + α + β <= 90°.
    const glm::dvec3 low = to_double(cone.bounds.min) - eye, high = to_double(cone.bounds.max) - eye;
    const glm::dvec3 d = 0.5 * (low + high);
    double beta = 0;
    for (int c = 0; c < 8; ++c)
      beta =
          std::max(beta, angle(d, {c & 1 ? high.x : low.x, c & 2 ? high.y : low.y, c & 4 ? high.z : low.z}));
    double farthest = 0;
    for (int c = 0; c < 8; ++c)
      farthest = std::max(farthest, glm::length(glm::dvec3(c & 1 ? high.x : low.x, c & 2 ? high.y : low.y,
                                                           c & 4 ? high.z : low.z)));
    const double sine = double{cone.reach} + Facing(view, FacingRule::cone).turned_by(cone, farthest);
    if (sine > 1) continue;
    const double alpha = std::asin(sine);
    if (angle(to_double(cone.axis), d) + alpha + beta <= std::numbers::pi / 2 - 1e-6) {
      ++by_angles;
      ASSERT_FALSE(may_face) << "bundle " << i;
    }
  }
  EXPECT_GT(dropped, 2000u);
  EXPECT_GT(kept, 2000u);
  EXPECT_GT(by_angles, 1000u);
  EXPECT_GT(dropped, by_angles);
}

// Twice the area on the image of a triangle whose corners are put on a grid of so many steps a pixel, if any.
double area_on_image(const View& view, const std::array<Vec3, 3>& triangle, double steps) {
  const glm::dmat4 to_clip = to_double(view.eye_to_clip) * to_double(view.world_to_eye);
  std::array<glm::dvec2, 3> at;
  for (std::size_t c = 0; c < 3; ++c) {
    const glm::dvec4 clip = to_clip * glm::dvec4(to_double(triangle[c]), 1);
    at[c] = 0.5 * glm::dvec2(clip) / clip.w * glm::dvec2(view.width, view.height);
    if (steps > 0) at[c] = glm::round(at[c] * steps) / steps;
  }
  const glm::dvec2 a = at[1] - at[0], b = at[2] - at[0];
  return a.x * b.y - a.y * b.x;
}

TEST(Facing, KeepsWhatSnappingTurnsToTheEye) {
  scene::Random random(53);
  std::size_t turned = 0, dropped = 0;
  const std::vector<std::uint32_t> indices{0, 1, 2}, ids{0};
  for (int i = 0; i < 100000; ++i) {
    // Almost edge on, from behind: a sliver on a floor just below the eye.
    const float distance = random.between(2, 600), length = random.between(0.1f, 20);
    const float height = length * std::exp(random.between(-7, 0)), lean = std::exp(random.between(-9, -1));
    const float roll = random.between(-3, 3), aside = random.between(-0.4f, 0.4f) * distance;
    std::array<Vec3, 3> triangle;
    const std::array<glm::dvec2, 3> flat{
        glm::dvec2{0, 0}, {length, 0}, {random.between(0, 1) * length, height}};
    for (std::size_t c = 0; c < 3; ++c) {
      const glm::dvec2 p{flat[c].x * std::cos(roll) - flat[c].y * std::sin(roll),
                         flat[c].x * std::sin(roll) + flat[c].y * std::cos(roll)};
      triangle[c] = {static_cast<float>(aside + p.x), -lean * distance, static_cast<float>(distance + p.y)};
    }
    const View view = *make_view({.eye = {0, 0, 0}, .forward = {0, 0, 1}, .near_plane = 0.01f}, 160, 120);
    if (triangle[0].z < 0.1f || triangle[1].z < 0.1f || triangle[2].z < 0.1f) continue;
    const double facing = glm::dot(to_double(unit_normal(triangle)), to_double(triangle[0]));
    if (facing == 0) continue;
    const std::vector<Vec3> positions(triangle.begin(), triangle.end());
    const std::vector<std::uint32_t> reversed{0, 2, 1};
    const auto& behind = facing > 0 ? indices : reversed;
    const bool may_face =
        Facing(view, FacingRule::cone).may_face(cone_of({positions, behind}, ids, kEverywhere));
    dropped += !may_face;
    const double exact = area_on_image(view, triangle, 0), snapped = area_on_image(view, triangle, 256);
    if (!(exact * snapped < 0)) continue;
    ++turned;
    ASSERT_TRUE(may_face) << "triangle " << i;
  }
  EXPECT_GT(turned, 500u);
  EXPECT_GT(dropped, 12000u);
}

TEST(Facing, TrianglesWithoutAreaMayFaceAnywhere) {
  const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  const std::vector<std::uint32_t> indices{0, 1, 2, 3, 4, 5}, ids{0, 1}, first{0};
  const View behind = *make_view({.eye = {0, 0, -5}, .forward = {0, 0, 1}}, 64, 64);
  const Facing facing(behind, FacingRule::cone);
  EXPECT_TRUE(facing.may_face(cone_of({positions, indices}, ids, kEverywhere)));
  EXPECT_FALSE(facing.may_face(cone_of({positions, indices}, first, kEverywhere)));
  EXPECT_EQ(part_of({0, 0, 0}), kSteep);
}

TEST(Facing, PartsAreSectorsOf45Degrees) {
  for (int degrees = 0; degrees < 360; ++degrees) {
    const double turn = (degrees + 0.5) * std::numbers::pi / 180;
    const Vec3 level{static_cast<float>(std::cos(turn)), 0, static_cast<float>(std::sin(turn))};
    EXPECT_EQ(part_of(level), static_cast<std::uint32_t>((degrees + 180) % 360 / 45)) << degrees;
  }
  EXPECT_EQ(part_of({0.5f, 0.8f, 0}), kSteep);
  EXPECT_EQ(part_of({0, -1, 0}), kSteep);
}

TEST(Facing, PartsOnXyAreSectorsOfThatPlane) {
  for (int degrees = 0; degrees < 360; ++degrees) {
    const double turn = (degrees + 0.5) * std::numbers::pi / 180;
    const Vec3 across{static_cast<float>(std::cos(turn)), static_cast<float>(std::sin(turn)), 0};
    const auto sector = static_cast<std::uint32_t>((degrees + 180) % 360 / 45);
    EXPECT_EQ(part_of(across, PartPlanes::xy), kOnXy + sector) << degrees;
    const bool steep = std::fabs(across.y) > std::fabs(across.x);
    EXPECT_EQ(part_of(across, PartPlanes::both), steep ? kOnXy + sector : part_of(across)) << degrees;
  }
  EXPECT_EQ(part_of({0, 0, 1}, PartPlanes::xy), kSteep);
  EXPECT_EQ(part_of({0, 0, 1}, PartPlanes::both), part_of({0, 0, 1}));
  EXPECT_EQ(part_of({0, 0, 0}, PartPlanes::both), kSteep);
}

// Looking down, a floor's sector is that which the view vector comes from, a ceiling's that which it goes to.
TEST(Facing, ThePrintedRuleJudgesAPartOnItsOwnPlane) {
  const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
  const std::vector<std::uint32_t> up{0, 2, 1}, down{0, 1, 2}, ids{0};
  const View view = *make_view({.eye = {0.2f, 9, 0.2f}, .forward = {0.1f, -1, 0}, .up = {1, 0, 0}}, 64, 64);
  const Facing facing(view, FacingRule::printed);
  for (const PartPlanes planes : {PartPlanes::xy, PartPlanes::both}) {
    EXPECT_TRUE(facing.may_face(cone_of({positions, up}, ids, kEverywhere, planes)));
    EXPECT_FALSE(facing.may_face(cone_of({positions, down}, ids, kEverywhere, planes)));
  }
  EXPECT_TRUE(facing.may_face(cone_of({positions, down}, ids, kEverywhere, PartPlanes::xz)));
}

// A wall to the side, seen under perspective from in front, faces the eye although its sector is next to the
// view vector's: what the printed rule loses.
TEST(Facing, ThePrintedRuleDropsWallsThatFaceTheEye) {
  const float turn = 30 * std::numbers::pi_v<float> / 180;
  const Vec3 n{std::sin(turn), 0, std::cos(turn)};  // leans away from a viewer who looks along +z
  const Vec3 side{n.z, 0, -n.x};
  const Vec3 at{-30, 0, 5};
  const std::vector<Vec3> positions{{at.x, 1, at.z}, {at.x, -1, at.z}, {at.x + side.x, -1, at.z + side.z}};
  std::vector<std::uint32_t> indices{0, 1, 2}, ids{0};
  if (to_double(unit_normal({positions[0], positions[1], positions[2]})).z < 0)
    std::swap(indices[1], indices[2]);
  const FacingCone cone = cone_of({positions, indices}, ids, kEverywhere);
  ASSERT_NEAR(cone.axis.x, n.x, 1e-5);
  const View view = *make_view({.eye = {0, 0, 0}, .forward = {0, 0, 1}, .vertical_fov = 2.8f}, 64, 64);
  EXPECT_TRUE(Facing(view, FacingRule::cone).may_face(cone));
  EXPECT_FALSE(Facing(view, FacingRule::printed).may_face(cone));
}

}  // namespace
}  // namespace sightline::methods
