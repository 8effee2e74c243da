// Where a mesh ends beside its triangles, for buffers in which a pixel's margin counts; for every SIMD width.
// Included by files that foreach_target compiles again and again.
//
// A triangle has the pixels whose centres it holds, and shares what they reach beyond it with those that go
// on at its edges. Triangles that count are wide enough for a pixel's margin not to reach across, so such a
// pixel touches only triangles that share a corner with it. It is covered but where the mesh ends at an edge
// of one of those that ends at such a corner, and no deeper than the steepest of them falls within a margin.
#if defined(SIGHTLINE_OCCLUSION_MESH_RIM_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_OCCLUSION_MESH_RIM_INL
#undef SIGHTLINE_OCCLUSION_MESH_RIM_INL
#else
#define SIGHTLINE_OCCLUSION_MESH_RIM_INL
#endif

#include <optional>

#include "library/occlusion/cut_triangle.hpp"
#include "library/occlusion/mesh_setup-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::occlusion::HWY_NAMESPACE {

// What lies around a triangle or a quad.
struct Rim {
  Bands bands;      // the mesh ends there
  float slant = 0;  // of the steepest triangle
  bool known = true;
  std::array<std::uint32_t, Bands::kMost> cut;  // triangles that the near plane cuts
  std::size_t cuts = 0;
};

// Where a point about the eye that is before the near plane lies on the image.
inline std::array<float, 2> on_image(const EyeProjection& e, const Vec3& q) {
  const auto row = [&](const Vec4& r) { return r.x * q.x + r.y * q.y + r.z * q.z + r.w; };
  const float over_w = 1 / row(e.w);
  return {row(e.x) * over_w, row(e.y) * over_w};
}

// What the image shows of an edge; nothing of one behind the near plane.
inline std::optional<ImageSegment> edge_on_image(const DepthTiles& tiles, const OccluderTopology& mesh,
                                                 const RowTransform& transform,
                                                 const OccluderTopology::CornerEdge& edge) {
  const EyeProjection& e = tiles.projection;
  const Vec4& near = tiles.rays.near_plane;
  std::array<Vec3, 2> at;
  bool whole = true;
  for (std::size_t end = 0; end < 2; ++end) {
    const Vec3 p = transform_point(transform, mesh.positions[end == 0 ? edge.a : edge.b]);
    at[end] = {p.x - e.eye_high.x - e.eye_low.x, p.y - e.eye_high.y - e.eye_low.y,
               p.z - e.eye_high.z - e.eye_low.z};
    whole = whole && near.x * at[end].x + near.y * at[end].y + near.z * at[end].z + near.w >= 0;
  }
  if (whole) return ImageSegment{on_image(e, at[0]), on_image(e, at[1])};
  return in_view(tiles, about_eye(e, transform, mesh.positions[edge.a]),
                 about_eye(e, transform, mesh.positions[edge.b]));
}

// Adds an edge, if it comes near the rectangle of `beside`.
inline void add_band(const ImageSegment& segment, float margin, const Convex& beside, Rim& out) {
  const auto& [a, b] = segment;
  const float widest = std::max(std::max(std::fabs(a[0]), std::fabs(a[1])),
                                std::max(std::fabs(b[0]), std::fabs(b[1]))),
              inset = margin + kInset + kInsetGrowth * widest;
  const float left = std::min(a[0], b[0]) - inset, right = std::max(a[0], b[0]) + inset,
              top = std::min(a[1], b[1]) - inset, bottom = std::max(a[1], b[1]) + inset;
  if (right < beside.left || left > beside.right || bottom < beside.top || top > beside.bottom) return;
  Bands& bands = out.bands;
  if (bands.count == Bands::kMost) {
    out.known = false;
    return;
  }
  const std::size_t i = bands.count++;
  bands.left[i] = left, bands.right[i] = right, bands.top[i] = top, bands.bottom[i] = bottom;
  const float rise = b[1] - a[1];
  const bool steep = std::fabs(rise) >= kFlatEdge;
  const float slope = steep ? (b[0] - a[0]) / rise : 0;
  bands.slope[i] = slope;
  bands.at[i] = a[0] - a[1] * slope;
  bands.half[i] = steep ? inset * (1 + std::fabs(slope)) : kInfinity;
}

// Whether the mesh ends at the edge, as far as it is drawn.
inline bool ends_at(const DepthTiles& tiles, const OccluderTopology& mesh,
                    const OccluderTopology::CornerEdge& edge) {
  const float* facing = tiles.mesh->facing.data();
  const float its = facing[edge.triangle];
  if (edge.other < OccluderTopology::kShared) {
    const float others = facing[edge.other];
    return (its != 0 || others != 0) && !(its * others > 0);
  }
  if (its == 0) return false;
  return edge.other == OccluderTopology::kNone ||
         !goes_on_along(tiles, mesh, mesh.shared[edge.other - OccluderTopology::kShared]);
}

// Adds where the near plane cuts a triangle, once.
inline void add_near_edge(const DepthTiles& tiles, const OccluderTopology& mesh,
                          const RowTransform& transform, std::uint32_t triangle, const Convex& beside,
                          Rim& out) {
  if (std::fabs(tiles.mesh->facing[triangle]) != kCut) return;
  const auto end = out.cut.begin() + static_cast<std::ptrdiff_t>(out.cuts);
  if (std::find(out.cut.begin(), end, triangle) != end) return;
  if (out.cuts == out.cut.size()) {
    out.known = false;
    return;
  }
  out.cut[out.cuts++] = triangle;
  const ExactCorners corners =
      exact_corners(tiles.projection, mesh, transform, triangle / kGroup, triangle % kGroup);
  if (const auto segment = near_edge(tiles, corners)) add_band(*segment, tiles.margin, beside, out);
}

// Adds what lies around triangle t of the mesh, whose rectangle `beside` holds.
inline void add_rim(const DepthTiles& tiles, const OccluderTopology& mesh, const RowTransform& transform,
                    std::size_t t, const Convex& beside, Rim& out) {
  if (mesh.alone[t] != 0) {
    out.known = false;
    return;
  }
  const float* slant = tiles.mesh->slant.data();
  out.slant = std::max(out.slant, slant[t]);
  for (std::uint32_t i = mesh.first_around[t]; i < mesh.first_around[t + 1] && out.known; ++i) {
    const OccluderTopology::CornerEdge& edge = mesh.around[i];
    const auto add = [&](std::uint32_t triangle) {
      out.slant = std::max(out.slant, slant[triangle]);
      add_near_edge(tiles, mesh, transform, triangle, beside, out);
    };
    add(edge.triangle);
    if (edge.other < OccluderTopology::kShared) {
      add(edge.other);
    } else if (edge.other != OccluderTopology::kNone) {
      const OccluderTopology::SharedEdge& shared = mesh.shared[edge.other - OccluderTopology::kShared];
      for (std::uint32_t o = shared.first; o < shared.end; ++o) add(mesh.others[o] / 4);
    }
    if (!ends_at(tiles, mesh, edge)) continue;
    if (const auto segment = edge_on_image(tiles, mesh, transform, edge))
      add_band(*segment, tiles.margin, beside, out);
  }
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
