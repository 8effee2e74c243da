// Occluders out of triangles: vertices joined, neighbours found.
#include <algorithm>
#include <bit>
#include <unordered_map>
#include <utility>

#include <sightline/occluder.hpp>

#include "library/geometry/linear.hpp"
#include "library/occlusion/depth_tiles.hpp"
#include "library/occlusion/mesh_check.hpp"

namespace sightline {

namespace {

using occlusion::OccluderTopology;

struct Hash {
  std::size_t operator()(const Vec3& v) const noexcept {
    std::uint64_t h = 0;
    for (const float f : {v.x, v.y, v.z})
      h = (h ^ std::bit_cast<std::uint32_t>(f + 0.0f)) * 0x9e3779b97f4a7c15u, h ^= h >> 31;
    return h;
  }
};

// Triangles of joined vertices; those that keep fewer than three corners are left out.
void add_triangles(OccluderTopology& mesh, std::span<const Vec3> positions,
                   std::span<const std::uint32_t> indices, std::span<const Sides> sides) {
  std::unordered_map<Vec3, std::uint32_t, Hash> joined;
  const auto vertex = [&](std::uint32_t index) {
    const auto [at, added] =
        joined.try_emplace(positions[index], static_cast<std::uint32_t>(mesh.positions.size()));
    if (added) mesh.positions.push_back(positions[index]);
    return at->second;
  };
  for (std::size_t i = 0; i + 3 <= indices.size(); i += 3) {
    const auto corners = indices.subspan(i, 3);
    const std::array<std::uint32_t, 3> corner{vertex(corners[0]), vertex(corners[1]), vertex(corners[2])};
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
    mesh.triangles.push_back(corner);
    mesh.one_sided.push_back(!sides.empty() && sides[sides.size() == 1 ? 0 : i / 3] == Sides::front);
  }
}

// The second triangle at an edge makes both neighbours, if it is wound as they are on a surface; a third
// parts them again.
void find_neighbours(OccluderTopology& mesh) {
  struct Sides {
    std::uint32_t triangle[2], edge[2], count = 0;
  };
  std::unordered_map<std::uint64_t, Sides> edges;
  constexpr std::uint32_t kNone = OccluderTopology::kNone;
  mesh.neighbours.assign(mesh.triangles.size(), {kNone, kNone, kNone});
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint64_t a = mesh.triangles[i][k], b = mesh.triangles[i][(k + 1) % 3];
      Sides& sides = edges[std::min(a, b) << 32 | std::max(a, b)];
      if (sides.count < 2) sides.triangle[sides.count] = i, sides.edge[sides.count] = k;
      ++sides.count;
    }
  }
  for (const auto& [key, sides] : edges) {
    if (sides.count != 2) continue;
    // Two that are wound alike turn opposite ways on the image where one goes on where the other ends.
    if (mesh.triangles[sides.triangle[0]][sides.edge[0]] == mesh.triangles[sides.triangle[1]][sides.edge[1]])
      continue;
    mesh.neighbours[sides.triangle[0]][sides.edge[0]] = sides.triangle[1];
    mesh.neighbours[sides.triangle[1]][sides.edge[1]] = sides.triangle[0];
  }
}

}  // namespace

OccluderMesh::OccluderMesh() : topology_(new Topology) {}
OccluderMesh::~OccluderMesh() {
  delete topology_;
}
OccluderMesh::OccluderMesh(OccluderMesh&& other) noexcept
    : topology_(std::exchange(other.topology_, nullptr)) {}
OccluderMesh& OccluderMesh::operator=(OccluderMesh&& other) noexcept {
  std::swap(topology_, other.topology_);
  return *this;
}

Result<OccluderMesh> OccluderMesh::make(std::span<const Vec3> positions,
                                        std::span<const std::uint32_t> indices, std::span<const Sides> sides,
                                        TJunctions junctions) {
  if (const Status sound = occlusion::check_mesh(positions, indices, sides); !sound) return sound;
  if (junctions != TJunctions::open && junctions != TJunctions::closed)
    return Status{StatusCode::bad_argument, "occluder: the T-junctions are none, expected open or closed"};
  OccluderMesh mesh;
  add_triangles(*mesh.topology_, positions, indices, sides);
  sort_into_groups(*mesh.topology_);
  find_neighbours(*mesh.topology_);
  join_flat_polygons(*mesh.topology_);
  find_shared_edges(*mesh.topology_, junctions == TJunctions::closed);
  mesh.topology_->lay_out();
  find_corner_edges(*mesh.topology_);
  return mesh;
}

std::size_t OccluderMesh::triangles() const noexcept {
  return topology_->triangles.size();
}

std::size_t OccluderMesh::open_edges(std::span<OccluderEdge> edges) const noexcept {
  const OccluderTopology& mesh = *topology_;
  std::size_t count = 0;
  auto shared = mesh.shared.begin();
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const bool is_shared = shared != mesh.shared.end() && shared->triangle == t && shared->edge == k;
      if (is_shared) ++shared;
      if (is_shared || mesh.neighbours[t][k] != OccluderTopology::kNone) continue;
      const auto corner = [&](std::uint32_t i) { return mesh.positions[mesh.triangles[t][i % 3]]; };
      if (count < edges.size()) edges[count] = {corner(k), corner(k + 1)};
      ++count;
    }
  }
  return count;
}

}  // namespace sightline
