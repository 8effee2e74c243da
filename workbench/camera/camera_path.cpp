#include "workbench/camera/camera_path.hpp"

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include <sightline/workbench/error.hpp>

#include "library/geometry/elementary.hpp"
#include "workbench/camera/navigation_graph.hpp"
#include "workbench/camera/path_file.hpp"

namespace sightline::camera {
namespace {

constexpr std::size_t kDefaultFrames = 24;
constexpr float kEyeHeight = 1.7f;                             ///< metres
constexpr float kSway = 25 * std::numbers::pi_v<float> / 180;  ///< how far "near" and "far" turn
constexpr float kLookAround = 2.5f;  ///< metres before and behind over which a walk's heading is averaged
constexpr float kSteepest = 0.45f;   ///< of a walk's heading, as a sine

glm::vec3 to_glm(const Vec3& v) {
  return {v.x, v.y, v.z};
}
Vec3 to_vec3(const glm::vec3& v) {
  return {v.x, v.y, v.z};
}

float diagonal(const Box& box) {
  return glm::length(to_glm(box.max) - to_glm(box.min));
}

Camera camera_for(const Box& world) {
  Camera camera;
  camera.near_plane = std::min(0.1f, 1e-3f * std::max(1e-3f, diagonal(world)));
  camera.far_plane = std::max(2 * diagonal(world), 1e4f * camera.near_plane);
  return camera;
}

const Viewpoint* find_viewpoint(const Scene& scene, std::string_view name) {
  for (const Viewpoint& viewpoint : scene.viewpoints) {
    if (viewpoint.name == name) return &viewpoint;
  }
  return nullptr;
}

Viewpoint near_viewpoint(const Scene& scene) {
  if (const Viewpoint* found = find_viewpoint(scene, "near")) return *found;
  if (!scene.viewpoints.empty()) return scene.viewpoints.front();
  const Box all = extent(scene);
  const float depth = all.max.z - all.min.z;
  return {"near",
          {0.5f * (all.min.x + all.max.x), std::min(all.min.y + kEyeHeight, 0.5f * (all.min.y + all.max.y)),
           all.max.z + 0.05f * depth},
          {0, 0, -1}};
}

Viewpoint far_viewpoint(const Scene& scene) {
  if (const Viewpoint* found = find_viewpoint(scene, "far")) return *found;
  const Box all = extent(scene);
  const glm::vec3 centre = 0.5f * (to_glm(all.min) + to_glm(all.max));
  const glm::vec3 forward = glm::normalize(glm::vec3(0.3f, -0.6f, -1));
  return {"far", to_vec3(centre - forward * 0.9f * std::max(1e-3f, diagonal(all))), to_vec3(forward)};
}

Vec3 turned(const Vec3& v, float yaw) {
  return {v.x * portable::cos(yaw) - v.z * portable::sin(yaw), v.y,
          v.x * portable::sin(yaw) + v.z * portable::cos(yaw)};
}

/// 0 at the first frame, 1 at the last.
float progress(std::size_t frame, std::size_t frames) {
  return frames < 2 ? 0 : static_cast<float>(frame) / static_cast<float>(frames - 1);
}

std::vector<Camera> standing(const Scene& scene, const Viewpoint& viewpoint, std::size_t frames) {
  std::vector<Camera> cameras(frames, camera_for(extent(scene)));
  for (std::size_t f = 0; f < frames; ++f) {
    cameras[f].eye = viewpoint.eye;
    cameras[f].forward =
        turned(viewpoint.forward, kSway * portable::sin(2 * std::numbers::pi_v<float> * progress(f, frames)));
  }
  return cameras;
}

std::vector<Camera> rising(const Scene& scene, std::size_t frames) {
  const Viewpoint low = near_viewpoint(scene), high = far_viewpoint(scene);
  const glm::vec3 from = glm::normalize(to_glm(low.forward)), to = glm::normalize(to_glm(high.forward));
  std::vector<Camera> cameras(frames, camera_for(extent(scene)));
  for (std::size_t f = 0; f < frames; ++f) {
    const float t = progress(f, frames);
    cameras[f].eye = to_vec3(glm::mix(to_glm(low.eye), to_glm(high.eye), t));
    const glm::vec3 forward = glm::mix(from, to, t);
    // Two opposite headings pass through nothing half-way: look down there.
    cameras[f].forward = glm::length(forward) > 0.1f ? to_vec3(forward) : Vec3{0.1f, -1, 0.1f};
  }
  return cameras;
}

std::vector<Camera> circle(const Scene& scene, std::size_t frames) {
  const Box all = extent(scene);
  const float y = std::min(
      find_viewpoint(scene, "near") != nullptr ? near_viewpoint(scene).eye.y : all.min.y + kEyeHeight,
      0.5f * (all.min.y + all.max.y) + kEyeHeight);
  const float x = 0.5f * (all.min.x + all.max.x), z = 0.5f * (all.min.z + all.max.z);
  const float rx = 0.3f * (all.max.x - all.min.x), rz = 0.3f * (all.max.z - all.min.z);
  std::vector<Camera> cameras(frames, camera_for(all));
  for (std::size_t f = 0; f < frames; ++f) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(f) / static_cast<float>(frames);
    cameras[f].eye = {x + rx * portable::cos(angle), y, z + rz * portable::sin(angle)};
    cameras[f].forward = {-portable::sin(angle), 0, portable::cos(angle)};
  }
  return cameras;
}

/// The spawn points, some hundreds at most, each next the nearest not yet visited.
std::vector<Vec3> rounds(const Scene& scene) {
  std::vector<Vec3> left = thinned(eyes_of(scene), kMaxStops), order;
  if (left.size() < 2) {
    const std::vector<Vec3> more = thinned(scene.waypoints, kMaxStops);
    left.insert(left.end(), more.begin(), more.end());
  }
  while (!left.empty()) {
    auto next = left.begin();
    if (!order.empty()) {
      next = std::min_element(left.begin(), left.end(), [&](const Vec3& a, const Vec3& b) {
        return glm::distance(to_glm(a), to_glm(order.back())) <
               glm::distance(to_glm(b), to_glm(order.back()));
      });
    }
    order.push_back(*next);
    left.erase(next);
  }
  return order;
}

/// A polyline measured by its length.
class Track {
public:
  explicit Track(const std::vector<Vec3>& corners) {
    for (const Vec3& corner : corners) {
      const glm::vec3 p = to_glm(corner);
      if (!points_.empty() && glm::distance(points_.back(), p) < 1e-3f) continue;
      at_.push_back(points_.empty() ? 0 : at_.back() + glm::distance(points_.back(), p));
      points_.push_back(p);
    }
  }
  [[nodiscard]] bool is_still() const { return points_.size() < 2; }
  [[nodiscard]] float length() const { return at_.back(); }
  [[nodiscard]] glm::vec3 point(float metres) const {
    const auto next = std::upper_bound(at_.begin() + 1, at_.end() - 1, metres);
    const auto i = static_cast<std::size_t>(next - at_.begin());
    const float t = std::clamp((metres - at_[i - 1]) / (at_[i] - at_[i - 1]), 0.0f, 1.0f);
    return glm::mix(points_[i - 1], points_[i], t);
  }
  /// From where the walker was to where they will be: turns begin before the corner and end after it.
  [[nodiscard]] glm::vec3 heading(float metres) const {
    glm::vec3 sum(0);
    for (int step = -4; step < 8; ++step) {
      const float at = metres + static_cast<float>(step) * kLookAround / 4;
      sum += point(at + kLookAround / 4) - point(at);
    }
    if (glm::length(sum) < 1e-3f) sum = point(metres + 0.1f) - point(metres - 0.1f);
    if (glm::length(sum) < 1e-6f) return {0, 0, -1};
    glm::vec3 heading = glm::normalize(sum);
    heading.y = std::clamp(heading.y, -kSteepest, kSteepest);
    // Straight up or down a shaft: keep some horizontal direction to look along.
    if (std::hypot(heading.x, heading.z) < 0.1f) heading.z -= 0.3f;
    return glm::normalize(heading);
  }

private:
  std::vector<glm::vec3> points_;
  std::vector<float> at_;
};

std::vector<Camera> walk(const Scene& scene, std::size_t frames) {
  const NavigationGraph graph(scene);
  std::vector<Vec3> corners;
  for (const Vec3& stop : rounds(scene)) {
    if (corners.empty()) {
      corners.push_back(stop);
      continue;
    }
    const std::vector<Vec3> way = graph.way(corners.back(), stop);
    if (!way.empty()) corners.insert(corners.end(), way.begin() + 1, way.end());
  }
  const Track track(corners);
  if (corners.empty() || track.is_still()) return standing(scene, near_viewpoint(scene), frames);
  std::vector<Camera> cameras(frames, camera_for(extent(scene)));
  for (std::size_t f = 0; f < frames; ++f) {
    const float metres = progress(f, frames) * track.length();
    cameras[f].eye = to_vec3(track.point(metres));
    cameras[f].forward = to_vec3(track.heading(metres));
  }
  return cameras;
}

/// A scene within reach may have its paths lead out of it.
void expect_views(const Scene& scene, const CameraPath& path) {
  for (std::size_t i = 0; i < path.cameras.size(); ++i) {
    if (const auto made = make_view(path.cameras[i], 64, 64); !made) {
      throw Error("scene '" + scene.name + "': path '" + path.name + "': view " + std::to_string(i) + ": " +
                  to_string(made.error()));
    }
  }
}

}  // namespace

std::string_view default_path(const Scene& scene) noexcept {
  return scene.level ? "walk" : "near";
}

CameraPath make_path(const Scene& scene, const std::string& name_or_file, std::size_t frames) {
  const std::size_t count = frames == 0 ? kDefaultFrames : frames;
  CameraPath path{name_or_file, {}};
  if (name_or_file == "near") {
    path.cameras = standing(scene, near_viewpoint(scene), count);
  } else if (name_or_file == "far") {
    path.cameras = standing(scene, far_viewpoint(scene), count);
  } else if (name_or_file == "rising") {
    path.cameras = rising(scene, count);
  } else if (name_or_file == "walk") {
    path.cameras = scene.level ? walk(scene, count) : circle(scene, count);
  } else {
    std::error_code ignored;
    if (std::filesystem::status(name_or_file, ignored).type() == std::filesystem::file_type::not_found) {
      throw Error("path '" + name_or_file + "': expected near, far, rising, walk or the name of a path file");
    }
    path.cameras = load_path(name_or_file, scene.origin);
    if (frames != 0 && path.cameras.size() > frames) path.cameras.resize(frames);
    return path;
  }
  expect_views(scene, path);
  return path;
}

}  // namespace sightline::camera
