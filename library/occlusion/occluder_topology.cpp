// How triangles are laid out for drawing.
#include "library/occlusion/occluder_topology.hpp"

#include <algorithm>

#include "library/geometry/error_bounds.hpp"
#include "library/geometry/linear.hpp"
#include "library/occlusion/mesh_bands.hpp"

namespace sightline::occlusion {

using namespace geometry;

namespace {

struct Bounds {
  glm::dvec3 low{1e300}, high{-1e300};
  void add(const Vec3& p) { low = glm::min(low, to_double(p)), high = glm::max(high, to_double(p)); }
};

// Per 16 groups the middles of their boxes, and half their sizes.
void store_box(OccluderTopology& mesh, std::size_t group, const Bounds& bounds) {
  const Vec3 middle = to_vec3(0.5 * bounds.low + 0.5 * bounds.high);
  const glm::dvec3 half =
      glm::max(bounds.high - to_double(middle), to_double(middle) - bounds.low) * (1 + kGroupGrowth);
  float* out = &mesh.box[group / 16 * 96 + group % 16];
  out[0] = middle.x, out[16] = middle.y, out[32] = middle.z;
  for (int a = 0; a < 3; ++a) out[48 + 16 * a] = static_cast<float>(half[a]);
}

// The corner of triangle `other` that lies beyond edge k of `triangle`.
std::uint32_t corner_beyond(const OccluderTopology& mesh, const std::array<std::uint32_t, 3>& triangle,
                            std::size_t k, std::uint32_t other) {
  if (other != OccluderTopology::kNone) {
    for (const std::uint32_t v : mesh.triangles[other])
      if (v != triangle[k] && v != triangle[(k + 1) % 3]) return v;
  }
  return triangle[k];
}

void store_corner(geometry::AlignedVector<float>& to, std::size_t g, std::size_t k, std::size_t i,
                  const Vec3& p) {
  constexpr std::size_t kGroup = OccluderTopology::kGroup;
  float* out = &to[(g * 9 + 3 * k) * kGroup + i];
  out[0] = p.x, out[kGroup] = p.y, out[2 * kGroup] = p.z;
}

// Corners, edges and neighbours of the group's triangle i, which stands for none where `triangle` is beyond
// the last.
void store_triangle(OccluderTopology& mesh, std::size_t g, std::size_t i, Bounds& bounds) {
  constexpr std::size_t kGroup = OccluderTopology::kGroup;
  OccluderTopology::Group& group = mesh.groups[g];
  const std::size_t at = g * kGroup + i, last = mesh.triangles.size() - 1;
  const auto& triangle = mesh.triangles[std::min(at, last)];
  if (at <= last) {
    group.follows |= std::uint32_t{mesh.parts[at].follows} << i;
    group.apart = std::max(group.apart, mesh.parts[at].apart);
    group.straight |= std::uint32_t{mesh.parts[at].straight} << i;
    group.one_sided |= std::uint32_t{mesh.one_sided[at]} << i;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& p = mesh.positions[at <= last ? triangle[k] : triangle[0]];
    store_corner(mesh.corners, g, k, i, p);
    store_corner(mesh.beyond, g, k, i, p);
    bounds.add(p);
    if (at > last) continue;
    group.inner[k] |= (std::uint32_t{mesh.parts[at].inner} >> k & 1) << i;
    group.turned[k] |= std::uint32_t{triangle[k] > triangle[(k + 1) % 3]} << i;
    const std::uint32_t other = mesh.neighbours[at][k];
    mesh.neighbour[(g * 3 + k) * kGroup + i] = static_cast<std::int32_t>(other);
    store_corner(mesh.beyond, g, k, i, mesh.positions[corner_beyond(mesh, triangle, k, other)]);
    if (other != OccluderTopology::kNone)
      group.one_sided_beyond[k] |= std::uint32_t{mesh.one_sided[other]} << i;
  }
}

}  // namespace

void OccluderTopology::lay_out() {
  const std::size_t count = (triangles.size() + kGroup - 1) / kGroup;
  groups.resize(count);
  corners.resize(count * 9 * kGroup), beyond.resize(count * 9 * kGroup);
  neighbour.assign(count * 3 * kGroup, -1);
  box.assign((count + 15) / 16 * 96, 0);
  std::uint32_t first_shared = 0;
  Bounds all;
  for (std::size_t g = 0; g < count; ++g) {
    Group& group = groups[g];
    Bounds bounds;
    group.first_beside = static_cast<std::uint32_t>(beside.size());
    for (std::size_t i = 0; i < kGroup; ++i) store_triangle(*this, g, i, bounds);
    group.first_shared = first_shared;
    for (; first_shared < shared.size() && shared[first_shared].triangle / kGroup == g; ++first_shared) {
      for (std::uint32_t i = shared[first_shared].first; i < shared[first_shared].end; ++i) {
        if (others[i] / 4 / kGroup != g) beside.push_back(others[i] / 4 / kGroup);
      }
    }
    group.end_shared = first_shared;
    std::sort(beside.begin() + group.first_beside, beside.end());
    beside.erase(std::unique(beside.begin() + group.first_beside, beside.end()), beside.end());
    group.end_beside = static_cast<std::uint32_t>(beside.size());
    store_box(*this, g, bounds);
    if (kSharesByCost) all.low = glm::min(all.low, bounds.low), all.high = glm::max(all.high, bounds.high);
  }
  diagonal = kSharesByCost && count > 0 ? glm::distance(all.low, all.high) : 0;
}

}  // namespace sightline::occlusion
