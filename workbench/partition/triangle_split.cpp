#include "workbench/partition/triangle_split.hpp"

#include <algorithm>
#include <limits>

#include "workbench/partition/triangle_box.hpp"

namespace sightline::partition {

namespace {

using Axis = float Vec3::*;
constexpr std::array<Axis, 3> kAxes{&Vec3::x, &Vec3::y, &Vec3::z};

struct Planes {
  std::array<float, 3> at{};
  std::array<bool, 3> cuts{};
};

// Axis of the highest variance of the triangles' centres, at their mean (section 3.2.3).
Planes mean_plane(const TriangleSpan& all, std::span<const std::uint32_t> triangles) {
  std::array<double, 3> sum{}, squares{};
  const Vec3 origin = all[triangles.front()][0];  // near the data: squares lose little
  for (const std::uint32_t triangle : triangles) {
    const auto corners = all[triangle];
    for (std::size_t a = 0; a < 3; ++a) {
      const double centre =
          (double{corners[0].*kAxes[a]} + corners[1].*kAxes[a] + corners[2].*kAxes[a]) / 3 - origin.*kAxes[a];
      sum[a] += centre, squares[a] += centre * centre;
    }
  }
  const auto count = static_cast<double>(triangles.size());
  std::size_t best = 0;
  std::array<double, 3> variance{};
  for (std::size_t a = 0; a < 3; ++a) {
    variance[a] = squares[a] / count - (sum[a] / count) * (sum[a] / count);
    if (variance[a] > variance[best]) best = a;
  }
  Planes planes;
  planes.cuts[best] = true;
  planes.at[best] = static_cast<float>(origin.*kAxes[best] + sum[best] / count);
  return planes;
}

Planes middle_planes(Structure structure, const Box& region) {
  Planes planes;
  for (std::size_t a = 0; a < 3; ++a) {
    planes.cuts[a] = structure == Structure::octree || a != 1;
    planes.at[a] = static_cast<float>(0.5 * (double{region.min.*kAxes[a]} + region.max.*kAxes[a]));
  }
  return planes;
}

// Which of the 2³ octants a box reaches into, bit = octant with x lowest. A box that only touches a plane
// from below stays below it: each of its points lies in a closed child all the same.
std::uint32_t octants(const Box& box, const Planes& planes) {
  std::uint32_t mask = 0xff;
  constexpr std::array<std::uint32_t, 3> kLow{0x55, 0x33, 0x0f};
  for (std::size_t a = 0; a < 3; ++a) {
    const bool low = !planes.cuts[a] || box.min.*kAxes[a] < planes.at[a];
    const bool high = planes.cuts[a] && (box.max.*kAxes[a] > planes.at[a] || !low);
    mask &= (low ? kLow[a] : 0) | (high ? ~kLow[a] & 0xff : 0);
  }
  return mask;
}

Box octant(const Box& region, const Planes& planes, std::uint32_t child) {
  Box box = region;
  for (std::size_t a = 0; a < 3; ++a) {
    if (!planes.cuts[a]) continue;
    const float at = std::clamp(planes.at[a], region.min.*kAxes[a], region.max.*kAxes[a]);
    // Not in one expression: GCC 12 assigns to a copy there.
    Vec3& end = (child >> a & 1) != 0 ? box.min : box.max;
    end.*kAxes[a] = at;
  }
  return box;
}

}  // namespace

Box bounds_of(const std::array<Vec3, 3>& t) noexcept {
  return {{std::min({t[0].x, t[1].x, t[2].x}), std::min({t[0].y, t[1].y, t[2].y}),
           std::min({t[0].z, t[1].z, t[2].z})},
          {std::max({t[0].x, t[1].x, t[2].x}), std::max({t[0].y, t[1].y, t[2].y}),
           std::max({t[0].z, t[1].z, t[2].z})}};
}

bool split(Structure structure, const TriangleSpan& all, std::span<const std::uint32_t> triangles,
           const Box& region, Split& out) {
  const Planes planes =
      structure == Structure::kd_tree ? mean_plane(all, triangles) : middle_planes(structure, region);
  const std::uint32_t possible =
      octants({{-std::numeric_limits<float>::max(), -std::numeric_limits<float>::max(),
                -std::numeric_limits<float>::max()},
               {std::numeric_limits<float>::max(), std::numeric_limits<float>::max(),
                std::numeric_limits<float>::max()}},
              planes);
  for (std::uint32_t child = 0; child < 8; ++child) {
    out.triangles[child].clear();
    if (possible >> child & 1) out.regions[child] = octant(region, planes, child);
  }
  std::uint64_t shared = 0;
  for (const std::uint32_t triangle : triangles) {
    const auto corners = all[triangle];
    const Box box = bounds_of(corners);
    std::uint32_t reached = octants(box, planes) & possible;
    if ((reached & (reached - 1)) == 0) {
      out.triangles[static_cast<std::size_t>(__builtin_ctz(reached))].push_back(triangle);
      ++shared;
      continue;
    }
    for (; reached != 0; reached &= reached - 1) {
      const auto child = static_cast<std::size_t>(__builtin_ctz(reached));
      // The node's own region is no limit here: a corner outside it lies in some other node.
      if (!overlaps(corners, out.regions[child])) continue;
      out.triangles[child].push_back(triangle);
      ++shared;
    }
  }
  // Copies a triangle at which cells multiply instead of dividing what they hold, in twentieths: one as large
  // as the node reaches into all four of a grid's children, into four of an octree's eight or more.
  constexpr std::array<std::uint64_t, 3> kMostCopies{50, 60, 39};
  return 20 * shared <= kMostCopies[static_cast<std::size_t>(structure)] * triangles.size();
}

}  // namespace sightline::partition
