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

#include "library/occlusion/mesh_setup-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::occlusion::HWY_NAMESPACE {

// What lies around a triangle or a quad.
struct Rim {
  Bands bands;      // the mesh ends there
  float slant = 0;  // of the steepest triangle
  bool known = true;
};

// Where a vertex before the near plane lies on the image.
inline std::array<float, 2> on_image(const EyeProjection& e, const Vec3& p) {
  const Vec3 q{p.x - e.eye_high.x - e.eye_low.x, p.y - e.eye_high.y - e.eye_low.y,
               p.z - e.eye_high.z - e.eye_low.z};
  const auto row = [&](const Vec4& r) { return r.x * q.x + r.y * q.y + r.z * q.z + r.w; };
  const float over_w = 1 / row(e.w);
  return {row(e.x) * over_w, row(e.y) * over_w};
}

// Adds an edge, if it comes near the rectangle of `beside`.
inline void add_band(const std::array<float, 2>& a, const std::array<float, 2>& b, float margin,
                     const Convex& beside, Rim& out) {
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
  const float* facing = tiles.mesh.facing.data();
  if (edge.other < OccluderTopology::kShared) return facing[edge.triangle] != facing[edge.other];
  if (facing[edge.triangle] == 0) return false;
  return edge.other == OccluderTopology::kNone ||
         !goes_on_along(tiles, mesh, mesh.shared[edge.other - OccluderTopology::kShared]);
}

// Adds what lies around triangle t of the mesh, whose rectangle `beside` holds.
inline void add_rim(const DepthTiles& tiles, const OccluderTopology& mesh, const RowTransform& transform,
                    std::size_t t, const Convex& beside, Rim& out) {
  if (mesh.alone[t] != 0) {
    out.known = false;
    return;
  }
  const float* slant = tiles.mesh.slant.data();
  out.slant = std::max(out.slant, slant[t]);
  for (std::uint32_t i = mesh.first_around[t]; i < mesh.first_around[t + 1] && out.known; ++i) {
    const OccluderTopology::CornerEdge& edge = mesh.around[i];
    out.slant = std::max(out.slant, slant[edge.triangle]);
    if (edge.other < OccluderTopology::kShared) out.slant = std::max(out.slant, slant[edge.other]);
    if (!ends_at(tiles, mesh, edge)) continue;
    const auto place = [&](std::uint32_t vertex) {
      return on_image(tiles.projection, transform_point(transform, mesh.positions[vertex]));
    };
    add_band(place(edge.a), place(edge.b), tiles.margin, beside, out);
  }
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
