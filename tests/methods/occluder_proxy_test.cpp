#include "workbench/methods/raster_occlusion/occluder_proxy.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "library/geometry/linear.hpp"
#include "library/occlusion/depth_tiles.hpp"
#include "library/occlusion/occluder_topology.hpp"
#include "workbench/scene/shapes.hpp"

namespace sightline::methods {
namespace {

TEST(OccluderProxy, StandsInForAClosedConvexMeshAndLiesInsideIt) {
  const scene::Shape round = scene::sphere(3);
  const std::optional<OccluderMesh> proxy = occluder_proxy(round.positions, round.indices);
  ASSERT_TRUE(proxy);
  EXPECT_EQ(proxy->triangles(), 80u);
  for (const Vec3& p : OcclusionAccess::topology(*proxy).positions) {
    EXPECT_LT(p.x * p.x + p.y * p.y + p.z * p.z, 1.0f);
    EXPECT_GT(p.x * p.x + p.y * p.y + p.z * p.z, 0.9f);
  }
}

TEST(OccluderProxy, IsNotFoundForOpenAndHollowMeshes) {
  scene::Shape open = scene::sphere(2);
  open.indices.resize(open.indices.size() - 3);
  EXPECT_FALSE(occluder_proxy(open.positions, open.indices));
  scene::Shape dented = scene::sphere(2);
  dented.positions[7] = {0, 0, 0};
  EXPECT_FALSE(occluder_proxy(dented.positions, dented.indices));
}

TEST(InnerSphere, FillsWhatIsRoundAndLiesInsideIt) {
  scene::Shape round = scene::sphere(2);
  for (Vec3& p : round.positions) p = {3 + 2 * p.x, 2 * p.y, 2 * p.z - 1};
  const std::optional<Sphere> inner = inner_sphere(round.positions, round.indices);
  ASSERT_TRUE(inner);
  EXPECT_NEAR(inner->centre.x, 3, 1e-4);
  EXPECT_GT(inner->radius, 1.8f);
  // No triangle's plane cuts it.
  for (std::size_t i = 0; i < round.indices.size(); i += 3) {
    const auto corner = [&](std::size_t k) {
      return geometry::to_double(round.positions[round.indices[i + k]]);
    };
    const glm::dvec3 normal = glm::normalize(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
    EXPECT_GE(std::fabs(glm::dot(normal, corner(0) - geometry::to_double(inner->centre))), inner->radius);
  }
}

TEST(InnerSphere, IsNotFoundInWhatIsOpenDentedOrLong) {
  scene::Shape open = scene::sphere(2), dented = open, stretched = open;
  open.indices.resize(open.indices.size() - 3);
  dented.positions[7] = {0, 0, 0};
  for (Vec3& p : stretched.positions) p.y *= 1.5f;
  for (const scene::Shape& shape : {open, dented, stretched}) {
    EXPECT_FALSE(inner_sphere(shape.positions, shape.indices));
  }
}

}  // namespace
}  // namespace sightline::methods
