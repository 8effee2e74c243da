#include "workbench/camera/random_views.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <sightline/workbench/error.hpp>

#include "library/geometry/elementary.hpp"
#include "workbench/scene/level_space.hpp"
#include "workbench/scene/random.hpp"

namespace sightline::camera {
namespace {

using scene::Random;

constexpr float kRadians = std::numbers::pi_v<float> / 180;

/// The world that cameras are strewn over.
struct Ground {
  const Scene& scene;
  Box bounds;
  float diagonal;
  std::vector<std::uint32_t> leaves;  ///< open ones
  std::vector<Vec3> places;           ///< viewpoints and waypoints
};

Ground survey(const Scene& scene) {
  Ground ground{scene, extent(scene), 0, {}, scene.waypoints};
  const Box& b = ground.bounds;
  ground.diagonal = std::max(1e-3f, std::hypot(b.max.x - b.min.x, b.max.y - b.min.y, b.max.z - b.min.z));
  if (scene.level) ground.leaves = scene::open_leaves(*scene.level);
  for (const Viewpoint& viewpoint : scene.viewpoints) ground.places.push_back(viewpoint.eye);
  return ground;
}

Box grown(const Box& box, float margin) {
  return {{box.min.x - margin, box.min.y - margin, box.min.z - margin},
          {box.max.x + margin, box.max.y + margin, box.max.z + margin}};
}

Vec3 random_eye(const Ground& ground, Random& random) {
  const float kind = random.unit();
  if (!ground.places.empty() && kind < 0.15f) {
    const Vec3 place = ground.places[random.below(static_cast<std::uint32_t>(ground.places.size()))];
    const float reach = random.unit() < 0.5f ? 0 : 0.5f;
    return random.inside(grown({place, place}, reach));
  }
  if (!ground.leaves.empty() && kind < 0.9f) {
    const LevelPvs& level = *ground.scene.level;
    for (int attempt = 0; attempt < 16; ++attempt) {
      const std::uint32_t leaf =
          ground.leaves[random.below(static_cast<std::uint32_t>(ground.leaves.size()))];
      const Vec3 eye = random.inside(level.leaves[leaf].bounds);
      if (scene::is_open(level, eye)) return eye;
    }
  }
  if (kind < 0.4f) return random.inside(ground.bounds);
  if (kind < 0.6f) return random.inside(grown(ground.bounds, 0.25f * ground.diagonal));
  if (kind < 0.85f) {
    Box low = ground.bounds;
    low.max.y = std::min(low.max.y, low.min.y + 3);
    return random.inside(low);
  }
  return random.inside(ground.scene.bounds[random.below(static_cast<std::uint32_t>(ground.scene.size()))]);
}

void set_random_direction(Camera& camera, Random& random) {
  const float kind = random.unit();
  if (kind < 0.2f) {
    camera.forward = random.direction(), camera.up = random.direction();
    return;
  }
  float yaw = random.between(0, 360) * kRadians, pitch = random.between(-30, 30) * kRadians;
  if (kind < 0.3f) yaw = static_cast<float>(random.below(4)) * 90 * kRadians, pitch = 0;
  if (kind > 0.9f) pitch = random.between(-89, 89) * kRadians;
  camera.forward = {portable::cos(pitch) * portable::sin(yaw), portable::sin(pitch),
                    -portable::cos(pitch) * portable::cos(yaw)};
  if (random.unit() < 0.3f) {
    const float roll = random.between(-180, 180) * kRadians;
    camera.up = {portable::sin(roll) * portable::cos(yaw), portable::cos(roll),
                 portable::sin(roll) * portable::sin(yaw)};
  }
}

void set_random_projection(Camera& camera, const Ground& ground, Random& random) {
  const auto spread = [&](float low, float high) {
    return portable::exp(random.between(portable::log(low), portable::log(high)));
  };
  camera.vertical_fov = random.between(15, 125) * kRadians;
  camera.near_plane = std::min(spread(0.01f, 2), 0.1f * ground.diagonal);
  camera.far_plane = camera.near_plane + spread(0.05f, 3) * ground.diagonal;
  camera.depth = random.unit() < 0.25f ? Depth::reversed : Depth::standard;
  if (random.unit() < 0.2f) camera.far_plane = std::numeric_limits<float>::infinity();
  if (random.unit() < 0.1f) camera.shift_x = random.between(-1, 1), camera.shift_y = random.between(-1, 1);
  if (random.unit() < 0.1f) {
    camera.orthographic_height = spread(0.02f, 1.5f) * ground.diagonal;
    if (random.unit() < 0.3f) camera.near_plane = random.between(-0.5f, 0) * ground.diagonal;
    camera.far_plane = camera.near_plane + spread(0.05f, 2) * ground.diagonal;
  }
}

}  // namespace

std::vector<Camera> random_cameras(const Scene& scene, std::size_t count, std::uint64_t seed) {
  const Ground ground = survey(scene);
  Random random(seed);
  std::vector<Camera> cameras;
  cameras.reserve(count);
  constexpr int kTries = 1000;
  for (int tries = 0; cameras.size() < count;) {
    if (++tries > kTries) {
      throw Error(fmt::format("{}: no view of it can be computed in single precision, {:g} m across",
                              scene.name, ground.diagonal));
    }
    Camera camera;
    camera.eye = random_eye(ground, random);
    set_random_direction(camera, random);
    set_random_projection(camera, ground, random);
    // The few that chance made senseless, such as `up` along `forward`, are drawn again.
    if (make_view(camera, 64, 64)) {
      cameras.push_back(camera);
      tries = 0;
    }
  }
  return cameras;
}

}  // namespace sightline::camera
