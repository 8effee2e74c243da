#include "library/occlusion/mesh_bands.hpp"

#include <algorithm>

#include "library/occlusion/depth_tiles.hpp"

namespace sightline::occlusion {

namespace {

BandCuts even_cuts(std::uint32_t rows, std::uint32_t count) noexcept {
  BandCuts cuts{};
  for (std::uint32_t i = 0; i <= count; ++i) cuts[i] = i * rows / count;
  return cuts;
}

}  // namespace

BandCuts DrawnMesh::cuts(std::uint32_t rows, std::uint32_t count) const noexcept {
  BandCuts cuts = even_cuts(rows, count);
  if (!kSharesByCost || costs.size() != rows) return cuts;
  double sum = 0, above = 0;
  for (const std::int64_t cost : costs) sum += static_cast<double>(cost);
  if (sum == 0) return cuts;
  std::uint32_t next = 1;
  for (std::uint32_t row = 0; row < rows; ++row) {
    above += static_cast<double>(costs[row]);
    for (; next < count && above * count >= sum * next; ++next) cuts[next] = row + 1;
  }
  for (std::uint32_t i = 1; i < count; ++i)
    cuts[i] = std::clamp(cuts[i], cuts[i - 1] + 1, rows - (count - i));
  return cuts;
}

void DrawnMesh::note(std::span<const MeshScratch> drawn, std::uint32_t rows) {
  costs.resize(rows);
  std::int64_t cost = 0;
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (const MeshScratch& s : drawn) cost += s.cost_steps[row];
    costs[row] = cost;
  }
}

DrawnMesh& BandHistory::find(const DepthTiles& tiles, const OccluderTopology& mesh) {
  if (!kSharesByCost) return drawn_[0];
  constexpr double kTurned = 0.99;  // the cosine of 8 degrees
  constexpr double kMoved = 0.01;   // of the mesh's diagonal
  const EyeProjection& e = tiles.projection;
  const auto& forward = tiles.rays.forward;
  const glm::dvec3 eye = geometry::to_double(e.eye_high) + geometry::to_double(e.eye_low);
  const glm::dvec3 direction = glm::normalize(e.orthographic ? glm::dvec3(forward[0], forward[1], forward[2])
                                                             : glm::dvec3(e.w.x, e.w.y, e.w.z));
  const auto looks_alike = [&](const DrawnMesh& d) {
    return d.mesh == &mesh && glm::distance(d.eye, eye) <= kMoved * mesh.diagonal &&
           glm::dot(d.direction, direction) > kTurned;
  };
  auto found = std::ranges::find_if(drawn_, looks_alike);
  if (found == drawn_.end()) {
    found = drawn_.begin() + static_cast<std::ptrdiff_t>(oldest_++ % drawn_.size());
    found->costs.clear();
  }
  found->mesh = &mesh, found->eye = eye, found->direction = direction;
  return *found;
}

}  // namespace sightline::occlusion
