// Where a mesh ends beside its triangles, for buffers in which a pixel's margin counts; for every SIMD width.
// Included by files that foreach_target compiles again and again.
//
// A triangle has the pixels whose centres it holds, and shares what they reach beyond it with those that go
// on at its edges. Triangles that count are wide enough for a pixel's margin not to reach across, so such a
// pixel touches only triangles that share a corner with it, or with a row of others along an edge that it
// touches (T-junctions). It is covered but where the mesh ends at an edge
// of one of those that ends at such a corner, and no deeper than the steepest of them falls within a margin.
// Neighbours share most of what lies around them: it is looked for once a group.
#if defined(SIGHTLINE_OCCLUSION_MESH_RIM_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_OCCLUSION_MESH_RIM_INL
#undef SIGHTLINE_OCCLUSION_MESH_RIM_INL
#else
#define SIGHTLINE_OCCLUSION_MESH_RIM_INL
#endif

#include <bit>
#include <optional>
#include <span>

#include "library/geometry/ask_ahead.hpp"
#include "library/occlusion/cut_triangle.hpp"
#include "library/occlusion/mesh_setup-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::occlusion::HWY_NAMESPACE {

// What lies around a group's triangles.
struct Rim {
  static constexpr std::size_t kMost = 64;
  // Edges from a to b at which the mesh ends; the bands around them, as Bands has them, how far these reach
  // and how far they must; and whose they are, a bit a triangle.
  alignas(64) std::array<float, kMost> ax, ay, bx, by, at, slope, half, reach, least;
  alignas(64) std::array<std::uint32_t, kMost> of;
  std::size_t count = 0;
  std::uint32_t of_some = 0;                      // the triangles that have some
  std::uint32_t unknown = 0;                      // triangles around which there is more
  alignas(64) std::array<float, kGroup> slant{};  // of the steepest triangle there, itself counted, too
};

// Edges that the mesh ends at, on their way to be bands.
struct RimEnds {
  alignas(64) std::array<std::array<float, kGroup>, 3> a, b;  // by axis
  std::array<std::uint32_t, kGroup> of;
  std::size_t count = 0;
};

// Appends bands around edges on the image, those of `shown` that come near it, `play` wider than rounding
// asks.
HWY_NOINLINE void append_bands(const DepthTiles& tiles, VF ax, VF ay, VF bx, VF by, hn::Mask<F> shown,
                               float play, const std::uint32_t* of, Rim& out) {
  const F f;
  const VF widest = hn::Max(hn::Max(hn::Abs(ax), hn::Abs(ay)), hn::Max(hn::Abs(bx), hn::Abs(by))),
           reach = hn::Add(inset_of(tiles, widest), hn::Set(f, play)),
           least = hn::Sub(reach, hn::Mul(hn::Set(f, 0.5f * kInsetGrowth), widest));
  const auto whole = [&](std::uint32_t at) HWY_ATTR { return hn::Set(f, static_cast<float>(at)); };
  const auto apart = [&](VF a, VF b, std::uint32_t end) HWY_ATTR {
    return hn::Or(hn::Lt(hn::Add(hn::Max(a, b), reach), hn::Zero(f)),
                  hn::Gt(hn::Sub(hn::Min(a, b), reach), whole(end)));
  };
  const auto beyond = hn::Or(apart(ax, bx, tiles.width), apart(ay, by, tiles.height));
  const VF rise = hn::Sub(by, ay);
  const auto steep = hn::Ge(hn::Abs(rise), hn::Set(f, kFlatEdge));
  const VF slope = hn::IfThenElseZero(steep, hn::Div(hn::Sub(bx, ax), rise)),
           half = hn::IfThenElse(steep, hn::Mul(reach, hn::Add(hn::Set(f, 1.0f), hn::Abs(slope))),
                                 hn::Set(f, kInfinity));
  const std::array<VF, 9> values{ax, ay, bx, by, hn::Sub(ax, hn::Mul(ay, slope)), slope, half, reach, least};
  alignas(64) std::array<std::array<float, kGroup>, 9> each;
  for (std::size_t v = 0; v < values.size(); ++v) hn::Store(values[v], f, each[v].data());
  for (std::uint32_t bits = bits_of(f, hn::AndNot(beyond, shown)); bits != 0; bits &= bits - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(bits));
    if (out.count == Rim::kMost) {
      out.unknown |= of[i];
      continue;
    }
    const std::size_t to = out.count++;
    std::size_t v = 0;
    for (auto* its :
         {&out.ax, &out.ay, &out.bx, &out.by, &out.at, &out.slope, &out.half, &out.reach, &out.least})
      (*its)[to] = each[v++][i];
    out.of[to] = of[i], out.of_some |= of[i];
  }
}

HWY_NOINLINE inline void append_band(const DepthTiles& tiles, const std::optional<ImageSegment>& segment,
                                     std::uint32_t of, Rim& out) {
  if (!segment) return;
  const auto& [a, b, play] = *segment;
  const F f;
  append_bands(tiles, hn::Set(f, a[0]), hn::Set(f, a[1]), hn::Set(f, b[0]), hn::Set(f, b[1]),
               hn::FirstN(f, 1), play, &of, out);
}

// Bands of what the image shows of the edges: of those before the near plane first, whatever a vector's
// width, for there may be too many.
HWY_NOINLINE void flush_ends(const DepthTiles& tiles, RimEnds& ends, Rim& out) {
  const F f;
  const EyeProjection& e = tiles.projection;
  std::uint32_t cut = 0;
  for (std::size_t first = 0; first < ends.count; first += hn::Lanes(f)) {
    const auto those = hn::FirstN(f, ends.count - first);
    const auto load = [&](const std::array<std::array<float, kGroup>, 3>& p) HWY_ATTR {
      const auto axis = [&](std::size_t k) HWY_ATTR { return hn::Load(f, &p[k][first]); };
      return about_eye(e, VPoints{axis(0), axis(1), axis(2)});
    };
    const VPoints a = load(ends.a), b = load(ends.b);
    const VF one = hn::Set(f, 1.0f), a_over_w = hn::Div(one, dot_row(e.w, a)),
             b_over_w = hn::Div(one, dot_row(e.w, b));
    const auto whole = hn::And(before_near(tiles, a), before_near(tiles, b));
    append_bands(tiles, hn::Mul(dot_row(e.x, a), a_over_w), hn::Mul(dot_row(e.y, a), a_over_w),
                 hn::Mul(dot_row(e.x, b), b_over_w), hn::Mul(dot_row(e.y, b), b_over_w),
                 hn::And(whole, those), 0, &ends.of[first], out);
    cut |= bits_of(f, hn::AndNot(whole, those)) << first;
  }
  for (; cut != 0; cut &= cut - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(cut));
    const auto end = [&](const std::array<std::array<float, kGroup>, 3>& p) {
      return about_eye(e, Vec3{p[0][i], p[1][i], p[2][i]});
    };
    append_band(tiles, in_view(tiles, end(ends.a), end(ends.b)), ends.of[i], out);
  }
  ends.count = 0;
}

// Of a block of edges those at which the mesh may end, as far as it is drawn; whether others go on along a
// shared one is still to be asked.
HWY_INLINE std::uint32_t may_end(const DepthTiles& tiles, const OccluderTopology::RimEdges& edges) {
  const F f;
  const I i32;
  const float* facing = tiles.mesh->facing.data();
  std::uint32_t out = 0;
  for (std::size_t lane = 0; lane < kGroup; lane += hn::Lanes(f)) {
    const VI other = hn::Load(i32, &edges.other[lane]), zero = hn::Zero(i32);
    const VF its = hn::GatherIndex(f, facing, hn::Load(i32, &edges.triangle[lane])),
             neighbours = hn::GatherIndex(f, facing, hn::Max(other, zero));
    const VF others = hn::IfThenZeroElse(hn::RebindMask(f, hn::Lt(other, zero)), neighbours);
    const auto none = hn::Eq(hn::Add(hn::Abs(its), hn::Abs(others)), hn::Zero(f));
    out |= bits_of(f, hn::AndNot(none, hn::Not(hn::Gt(hn::Mul(its, others), hn::Zero(f))))) << lane;
  }
  return out;
}

// Whether the mesh goes on at an edge that may end.
HWY_INLINE bool goes_on(const DepthTiles& tiles, const OccluderTopology& mesh, std::int32_t other) {
  const auto place = static_cast<std::uint32_t>(other);
  return other < 0 && place != OccluderTopology::kNone &&
         goes_on_along(tiles, mesh, mesh.shared[place - OccluderTopology::kShared]);
}

constexpr std::size_t kBlocksAtOnce = 8;

// Where the near plane cuts a triangle that lies beside some of the drawn.
inline void append_near_edge(const DepthTiles& tiles, const OccluderTopology& mesh,
                             const OccluderTopology::AroundTriangles& those, std::size_t place,
                             std::uint32_t drawn, Rim& out) {
  std::uint32_t of = 0;
  for (std::size_t i = 0; i < kGroup; ++i) of |= (std::uint32_t{those.beside[i]} >> place & 1u) << i;
  if ((of & drawn) == 0) return;
  const auto t = static_cast<std::size_t>(those.triangle[place]);
  const ExactCorners corners = exact_corners(tiles.projection, mesh, t / kGroup, t % kGroup);
  append_band(tiles, near_edge(tiles, corners), of, out);
}

// The steepest triangle around each of the drawn, and where the near plane cuts some; of a few blocks.
HWY_INLINE void look_around(const DepthTiles& tiles, const OccluderTopology& mesh,
                            std::span<const OccluderTopology::AroundTriangles> blocks, std::uint32_t drawn,
                            Rim& out) {
  const F f;
  const I i32;
  const MeshScratch& s = *tiles.mesh;
  alignas(64) std::array<std::array<float, kGroup>, kBlocksAtOnce> slants;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    std::uint32_t cut = 0;
    for (std::size_t lane = 0; lane < kGroup; lane += hn::Lanes(f)) {
      const VF slant = hn::GatherIndex(f, s.slant.data(), hn::Load(i32, &blocks[b].triangle[lane]));
      hn::Store(hn::Abs(slant), f, &slants[b][lane]);
      cut |= bits_of(f, hn::RebindMask(f, hn::Lt(hn::BitCast(i32, slant), hn::Zero(i32)))) << lane;
    }
    for (; cut != 0; cut &= cut - 1)
      append_near_edge(tiles, mesh, blocks[b], static_cast<std::size_t>(std::countr_zero(cut)), drawn, out);
  }
  for (std::uint32_t bits = drawn; bits != 0; bits &= bits - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(bits));
    VF steepest = hn::Set(f, out.slant[i]);
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      for (std::size_t lane = 0; lane < kGroup; lane += hn::Lanes(f)) {
        const auto beside = mask_of(f, std::uint64_t{blocks[b].beside[i]} >> lane);
        steepest = hn::Max(steepest, hn::IfThenElseZero(beside, hn::Load(f, &slants[b][lane])));
      }
    }
    out.slant[i] = hn::GetLane(hn::MaxOfLanes(f, steepest));
  }
}

HWY_INLINE void look_around(const DepthTiles& tiles, const OccluderTopology& mesh, std::size_t group,
                            std::uint32_t drawn, Rim& out) {
  const OccluderTopology::Group& its = mesh.groups[group];
  for (std::uint32_t bits = drawn; bits != 0; bits &= bits - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(bits));
    out.slant[i] = std::fabs(tiles.mesh->slant[group * kGroup + i]);
  }
  for (std::uint32_t b = its.first_around; b < its.end_around; b += kBlocksAtOnce) {
    const std::size_t count = std::min<std::size_t>(kBlocksAtOnce, its.end_around - b);
    look_around(tiles, mesh, std::span(mesh.around).subspan(b, count), drawn, out);
  }
}

// Asks for what find_rim() reads of a group.
HWY_INLINE void prefetch_rim(const OccluderTopology& mesh, std::size_t group) {
  const OccluderTopology::Group& its = mesh.groups[group];
  for (std::uint32_t i = its.first_around; i < its.end_around; ++i) prefetch_lines(mesh.around[i]);
  for (std::uint32_t i = its.first_rim; i < its.end_rim; ++i) prefetch_lines(mesh.rim[i]);
}

// What lies around those of a group's triangles that are drawn. Facings are known.
HWY_NOINLINE void find_rim(const DepthTiles& tiles, const OccluderTopology& mesh, std::size_t group,
                           std::uint32_t drawn, Rim& out) {
  const OccluderTopology::Group& its = mesh.groups[group];
  out.count = 0, out.unknown = its.alone, out.of_some = 0;
  look_around(tiles, mesh, group, drawn, out);
  RimEnds ends;
  for (std::uint32_t i = its.first_rim; i < its.end_rim; ++i) {
    const OccluderTopology::RimEdges& edges = mesh.rim[i];
    if ((edges.of_some & drawn) == 0) continue;
    for (std::uint32_t bits = may_end(tiles, edges); bits != 0; bits &= bits - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(bits));
      if ((edges.of[k] & drawn) == 0 || goes_on(tiles, mesh, edges.other[k])) continue;
      const Vec3 &a = mesh.positions[edges.a[k]], &b = mesh.positions[edges.b[k]];
      const std::size_t to = ends.count++;
      ends.a[0][to] = a.x, ends.a[1][to] = a.y, ends.a[2][to] = a.z;
      ends.b[0][to] = b.x, ends.b[1][to] = b.y, ends.b[2][to] = b.z;
      ends.of[to] = edges.of[k];
      if (ends.count == kGroup) flush_ends(tiles, ends, out);
    }
  }
  flush_ends(tiles, ends, out);
}

// Of a vector of edges those whose bands hold no pixel centre of a polygon. An edge that goes straight on
// where the polygon's own ends is found apart from it: both keep the same distance, and half of what is added
// for rounding is enough.
HWY_INLINE hn::Mask<F> apart_from(const Rim& rim, std::size_t first, const Convex& polygon) {
  const F f;
  const auto load = [&](const auto& of) HWY_ATTR { return hn::Load(f, &of[first]); };
  const VF ax = load(rim.ax), ay = load(rim.ay), bx = load(rim.bx), by = load(rim.by),
           least = load(rim.least);
  const auto beyond = [&](VF a, VF b, VF reach, float low, float high) HWY_ATTR {
    return hn::Or(hn::Lt(hn::Add(hn::Max(a, b), reach), hn::Set(f, low)),
                  hn::Gt(hn::Sub(hn::Min(a, b), reach), hn::Set(f, high)));
  };
  auto apart = hn::Or(beyond(ax, bx, least, polygon.left, polygon.right),
                      beyond(ay, by, least, polygon.top, polygon.bottom));
  // The line of an edge that bounds its own lines alone says nothing of the others.
  const std::size_t edges = polygon.by_lines ? 0 : polygon.edges;
  for (std::size_t e = 0; e < edges; ++e) {
    const VF slope = hn::Set(f, polygon.slope[e]),
             reach = hn::Mul(least, hn::Add(hn::Set(f, 1.0f), hn::Abs(slope)));
    const auto along = [&](VF x, VF y) HWY_ATTR { return hn::Sub(x, hn::Mul(slope, y)); };
    apart =
        hn::Or(apart, beyond(along(ax, ay), along(bx, by), reach, polygon.left_at[e], polygon.right_at[e]));
  }
  return apart;
}

// The bands around some triangles, a bit each, that hold pixel centres of a polygon; false where there are
// too many.
HWY_NOINLINE bool bands_in(const Rim& rim, std::uint32_t triangles, const Convex& polygon, Bands& out) {
  const F f;
  if ((rim.unknown & triangles) != 0) return false;
  if ((rim.of_some & triangles) == 0) return true;
  const hn::RebindToUnsigned<F> u32;
  for (std::size_t first = 0; first < rim.count; first += hn::Lanes(f)) {
    const auto of = hn::And(hn::Load(u32, &rim.of[first]), hn::Set(u32, triangles));
    const auto theirs =
        hn::And(hn::RebindMask(f, hn::Ne(of, hn::Zero(u32))), hn::FirstN(f, rim.count - first));
    if (hn::AllFalse(f, theirs)) continue;
    const auto in = hn::AndNot(apart_from(rim, first, polygon), theirs);
    for (std::uint32_t bits = bits_of(f, in); bits != 0; bits &= bits - 1) {
      const std::size_t i = first + static_cast<std::size_t>(std::countr_zero(bits));
      if (out.count == Bands::kMost) return false;
      const std::size_t to = out.count++;
      out.at[to] = rim.at[i], out.slope[to] = rim.slope[i], out.half[to] = rim.half[i];
      out.left[to] = std::min(rim.ax[i], rim.bx[i]) - rim.reach[i];
      out.right[to] = std::max(rim.ax[i], rim.bx[i]) + rim.reach[i];
      out.top[to] = std::min(rim.ay[i], rim.by[i]) - rim.reach[i];
      out.bottom[to] = std::max(rim.ay[i], rim.by[i]) + rim.reach[i];
    }
  }
  return true;
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
