// Ways through a level's open space: places known to be free, joined where nothing solid lies between them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <sightline/workbench/scene.hpp>

namespace sightline::camera {

/// Of a scene's viewpoints, and of its waypoints; real levels have some hundreds.
inline constexpr std::size_t kMaxStops = 1000;

/// One in so many, evenly, that at most `most` are left.
std::vector<Vec3> thinned(const std::vector<Vec3>& places, std::size_t most);

/// Where the scene's viewpoints stand.
std::vector<Vec3> eyes_of(const Scene& scene);

class NavigationGraph {
public:
  /// Joins the scene's viewpoints, waypoints and the middles of its open leaves, some thousands of them at
  /// most. The scene has a level.
  explicit NavigationGraph(const Scene& scene);

  /// Corners of a short way from a to b through open space, both included; empty where none was found.
  [[nodiscard]] std::vector<Vec3> way(const Vec3& a, const Vec3& b) const;

  [[nodiscard]] std::size_t places() const noexcept { return places_.size(); }

private:
  struct Edge {
    std::uint32_t to;
    float length;
  };
  [[nodiscard]] std::vector<Edge> neighbours_of(const Vec3& point, std::uint32_t self) const;
  [[nodiscard]] std::vector<Vec3> pulled_tight(const std::vector<Vec3>& corners) const;

  const LevelPvs& level_;
  std::vector<Vec3> places_;
  std::vector<std::vector<Edge>> edges_;
};

/// Whether the straight way is free with a hand's breadth to spare on all sides.
bool is_clear(const LevelPvs& level, const Vec3& a, const Vec3& b);

}  // namespace sightline::camera
