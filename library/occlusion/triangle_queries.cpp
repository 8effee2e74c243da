// Triangles against the tiles, pixel by pixel: what the boxes around them leave.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "library/occlusion/depth_tiles.hpp"
#include "library/occlusion/near_clip.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "library/occlusion/triangle_queries.cpp"
#include <hwy/foreach_target.h>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "library/occlusion/depth_query-inl.hpp"
#include "library/occlusion/depth_raster-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::occlusion::HWY_NAMESPACE {

// A vector of triangles on the image, grown by what rounding asks: an edge as a side's x = at + slope·y, at
// infinity where it bounds the other side or is too flat to say.
struct GrownTriangles {
  alignas(64) std::array<std::array<float, 16>, 3> slope, left_at, right_at;
  alignas(64) std::array<float, 16> left, right, top, bottom, nearest, at, across, down;
};

// Nearness of the triangles' planes, never less than it is: at + x·across + y·down; where a plane is seen too
// much edge on, the triangle's nearest point.
HWY_INLINE void find_planes(const DepthTiles& tiles, const Corners& q, VF reach, VF nearest,
                            GrownTriangles& out) {
  const F f;
  const PixelRays& rays = tiles.rays;
  const VPoints a = minus(q[1], q[0]), b = minus(q[2], q[0]), normal = cross(a, b);
  const VF length = hn::Sqrt(dot(normal, normal));
  const VF edges = hn::Sqrt(hn::Mul(dot(a, a), dot(b, b)));
  const VF scale = dot(normal, q[0]);
  const VF across = hn::Div(dot(normal, rays.across), scale), down = hn::Div(dot(normal, rays.down), scale),
           start = hn::Div(dot(normal, rays.at), scale);
  // The thinner the triangle, the less certain its normal; and the more the plane is seen edge on, the more
  // that matters.
  const VF doubt = hn::Div(hn::Mul(edges, reach), hn::Abs(scale));
  const VF slack = hn::Mul(
      nearest, hn::Add(hn::Set(f, kNearnessRounding), hn::Mul(hn::Set(f, kAskedNormalRounding), doubt)));
  const VF slant = hn::Mul(hn::Add(hn::Abs(across), hn::Abs(down)), hn::Set(f, kPixelPlay + tiles.margin));
  const VF at = hn::Add(start, hn::Add(slack, slant));
  // Not for what is no number, either; orthographic views do without.
  const auto sure = hn::And(hn::And(hn::Lt(doubt, hn::Set(f, kMostDoubt)), hn::Gt(length, hn::Zero(f))),
                            hn::Lt(hn::Abs(hn::Add(at, slant)), hn::Set(f, kMostNearness)));
  const bool flat = tiles.projection.orthographic;
  const VF none = hn::Zero(f);
  hn::Store(flat ? nearest : hn::IfThenElse(sure, at, nearest), f, out.at.data());
  hn::Store(flat ? none : hn::IfThenElseZero(sure, across), f, out.across.data());
  hn::Store(flat ? none : hn::IfThenElseZero(sure, down), f, out.down.data());
}

// The sides of triangles on the image, moved outwards by `slack` of rounding and the margin. Which side of
// one too thin an edge lies on is not certain, so its edges bound it on both, each as far away as the third
// corner lies.
HWY_INLINE void find_sides(const OnImage& image, const Rectangles& bounds, VF slack, float margin,
                           GrownTriangles& out) {
  const F f;
  const VF zero = hn::Zero(f), infinity = hn::Set(f, kInfinity);
  const VF *x = image.x, *y = image.y;
  const VF area = area_of(image);
  const auto to_right = hn::Gt(area, zero);
  const VF girth = hn::Add(hn::Sub(bounds.right, bounds.left), hn::Sub(bounds.bottom, bounds.top));
  const VF least = hn::Mul(slack, girth);
  const auto thin = hn::Not(hn::Gt(hn::Abs(area), least));
  const VF height =
      hn::IfThenElseZero(thin, hn::Add(hn::Abs(area), hn::Mul(hn::Set(f, kAreaRounding), least)));
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const VF rise = hn::Sub(y[next], y[k]), slope = hn::Div(hn::Sub(x[next], x[k]), rise),
             at = hn::Sub(x[k], hn::Mul(y[k], slope));
    const VF outwards =
        hn::Add(hn::Mul(hn::Add(slack, hn::Set(f, margin)), hn::Add(hn::Set(f, 1.0f), hn::Abs(slope))),
                hn::Div(height, hn::Abs(rise)));
    const auto steep = hn::Ge(hn::Abs(rise), hn::Set(f, kAskedFlatEdge));
    const auto on_right = hn::Not(hn::Xor(hn::Gt(rise, zero), to_right));
    hn::Store(hn::IfThenElseZero(steep, slope), f, out.slope[k].data());
    hn::Store(hn::IfThenElse(hn::And(steep, hn::Or(on_right, thin)), hn::Add(at, outwards), infinity), f,
              out.right_at[k].data());
    hn::Store(hn::IfThenElse(hn::AndNot(hn::AndNot(thin, on_right), steep), hn::Sub(at, outwards),
                             hn::Neg(infinity)),
              f, out.left_at[k].data());
  }
}

// Whether some of a triangle's pixels in a tile lie nearer than the occluders.
HWY_INLINE bool seen_in_tile(const DepthTiles& tiles, const GrownTriangles& t, std::size_t i,
                             std::uint32_t tx, std::uint32_t ty, std::uint64_t pixels) {
  const F f;
  const std::size_t tile = std::size_t{ty} * tiles.stride + tx;
  if (!(tiles.nearest[tile] > -kInfinity)) return true;
  alignas(64) std::array<float, 64> room;
  const float* depth = pixels_of_tile(tiles, tile, room);
  const VF across = hn::Set(f, t.across[i]), down = hn::Set(f, t.down[i]), most = hn::Set(f, t.nearest[i]),
           x = hn::Set(f, static_cast<float>(tx * kTile) + 0.5f),
           y = hn::Set(f, static_cast<float>(ty * kTile) + 0.5f);
  auto open = hn::Lt(most, most);
  for (std::size_t at = 0; at < 64; at += hn::Lanes(f)) {
    const VF column = hn::Add(x, hn::Load(f, kColumn + at)), row = hn::Add(y, hn::Load(f, kRow + at));
    const VF plane = hn::Add(hn::Add(hn::Set(f, t.at[i]), hn::Mul(across, column)), hn::Mul(down, row));
    const auto nearer = hn::Ge(hn::Min(plane, most), hn::Load(f, depth + at));
    open = hn::Or(open, hn::And(nearer, mask_of(f, pixels >> at)));
  }
  return !hn::AllFalse(f, open);
}

// Of a step's tiles those that a triangle may be seen in, a bit each, by what is nearest of both.
HWY_INLINE std::uint32_t open_tiles(const DepthTiles& tiles, const GrownTriangles& t, std::size_t i,
                                    const Step& step) {
  const F f;
  const float beyond = std::max(0.0f, 7 * t.across[i]) + std::max(0.0f, 7 * t.down[i]);
  const VF across = hn::Set(f, t.across[i]), down = hn::Set(f, t.down[i]), at = hn::Set(f, t.at[i]),
           x0 = hn::Set(f, static_cast<float>(step.tx * kTile) + 0.5f),
           y0 = hn::Set(f, static_cast<float>(step.ty * kTile) + 0.5f);
  std::uint32_t open = 0;
  for (std::uint32_t from = 0; from < kStepTiles; from += static_cast<std::uint32_t>(hn::Lanes(f))) {
    // Beyond the image's last row there is none to be read; whole steps repeat the first.
    if (from >= step.rows * kStepColumns) break;
    const VF x = hn::Add(x0, hn::Load(f, &kStepOffsets.x[from])),
             y = hn::Add(y0, hn::Load(f, &kStepOffsets.y[from])),
             first = hn::Add(hn::Add(at, hn::Mul(across, x)), hn::Mul(down, y)),
             nearest = hn::Min(hn::Add(first, hn::Set(f, beyond)), hn::Set(f, t.nearest[i]));
    open |= bits_of(f, hn::Ge(nearest, load_step(tiles, tiles.farthest, step, from))) << from;
  }
  return open & step.asked();
}

// Whether some pixel of triangle i lies nearer than the occluders.
SIGHTLINE_INLINE_IN_BOTH bool seen(const DepthTiles& tiles, const GrownTriangles& t, std::size_t i) {
  const TileRange range = tiles_of(tiles, t.left[i], t.right[i], t.top[i], t.bottom[i]);
  std::array<std::uint64_t, kStepTiles + kWords> pixels;
  for (std::uint32_t ty = range.begin_y; ty < range.end_y; ty += kStepRows) {
    const Spans spans =
        spans_of<3>(t, i, static_cast<float>(ty * kTile) + 0.5f, static_cast<float>(tiles.width));
    for (std::uint32_t tx = range.begin_x; tx < range.end_x; tx += kStepColumns) {
      const Step step{tx, ty, std::min(kStepColumns, range.end_x - tx),
                      std::min(kStepRows, range.end_y - ty)};
      std::uint32_t open = open_tiles(tiles, t, i, step);
      if (open == 0) continue;
      for (open &= store_step_pixels(spans, step, pixels.data()).some; open != 0; open &= open - 1) {
        const auto at = static_cast<std::uint32_t>(std::countr_zero(open));
        if (seen_in_tile(tiles, t, i, tx + at % kStepColumns, ty + at / kStepColumns, pixels[at]))
          return true;
      }
    }
  }
  return false;
}

// Triangles on the image, and where rounding may have put them.
struct Projected {
  OnImage image;
  RowErrors error;
  VF slack;           // pixels
  Rectangles bounds;  // grown by the slack and the margin
  VF nearest;         // nothing lies nearer
  hn::Mask<F> before,
      placed;          // surely before the eye; and not too far beside the image to have a place on it
  hn::Mask<F> behind;  // surely behind the eye
};

// Of parts of triangles whose coordinates reach as far as `reach`.
HWY_INLINE Projected project(const DepthTiles& tiles, const Corners& q, VF reach) {
  const F f;
  const EyeProjection& e = tiles.projection;
  Projected out;
  out.image = on_image(e, q);
  out.error = row_errors(e, reach);
  const VF error_w = out.error.w;
  Rectangles bounds = no_rectangles();
  VF least_w = hn::Set(f, kInfinity), most_w = hn::Neg(least_w), nearest = most_w;
  for (std::size_t k = 0; k < 3; ++k) {
    least_w = hn::Min(least_w, out.image.w[k]), most_w = hn::Max(most_w, out.image.w[k]);
    nearest = hn::Max(nearest, dot_row(e.nearness, q[k]));
    add_point(bounds, out.image.x[k], out.image.y[k]);
  }
  out.before = hn::Gt(least_w, hn::Add(error_w, error_w));
  out.behind = hn::Lt(most_w, hn::Neg(error_w));
  const VF over_least = hn::Div(hn::Set(f, 1.0f), hn::Sub(least_w, error_w));
  out.nearest = e.orthographic ? hn::Add(nearest, error_of(e.nearness, reach))
                               : hn::Mul(over_least, hn::Set(f, 1 + kReciprocalRounding));
  const VF widest = widest_of(bounds);
  const VF of_rows =
      hn::Mul(hn::Add(hn::Max(out.error.x, out.error.y), hn::Mul(widest, error_w)), over_least);
  out.slack = hn::Add(of_rows, hn::Add(hn::Set(f, kAskedSlack), hn::Mul(hn::Set(f, kInsetGrowth), widest)));
  out.bounds = grown(bounds, hn::Add(out.slack, hn::Set(f, tiles.margin)));
  out.placed = hn::And(out.before, hn::Lt(widest, hn::Set(f, kFarthestPlace)));
  return out;
}

bool clipped_seen(const DepthTiles& tiles, const Corners& whole, std::size_t i, bool away);

// Triangles that the eye surely sees from behind, by the side of their planes that it is on. Of one with a
// corner that is no number nothing is sure.
HWY_INLINE std::uint32_t turned_away(const DepthTiles& tiles, const Corners& corners) {
  return bits_of(F(), hn::Lt(side_of_planes(tiles, corners), hn::Zero(F())));
}

// Of triangles those wide enough on the image that they turn the same way wherever a rasteriser moves their
// corners, which may see one from its front that is almost edge on.
HWY_INLINE std::uint32_t turn_surely(const Projected& p) {
  const F f;
  const VF *x = p.image.x, *y = p.image.y;
  VF around = hn::Zero(f);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    around = hn::Add(around, hn::Add(hn::Abs(hn::Sub(x[next], x[k])), hn::Abs(hn::Sub(y[next], y[k]))));
  }
  const VF play = hn::Mul(p.slack, hn::Add(around, hn::Mul(p.slack, hn::Set(f, 8.0f))));
  return bits_of(f, hn::And(p.placed, hn::Gt(hn::Abs(area_of(p.image)), play)));
}

// Triangles are asked for in pieces of a vector. Of those that belong together one that is seen is enough.
constexpr std::size_t kPiece = std::min(TriangleBlock::kSize, hn::MaxLanes(F())),
                      kPieces = hn::MaxLanes(F()) / kPiece;

// A vector of triangles to be asked for, a bit each.
struct Asked {
  std::uint32_t those = 0, away = 0;           // turned away, and seen only where a rasteriser may see them
  std::array<std::uint32_t, kPieces> mates{};  // of a piece, itself counted
};

// Which of a vector of triangles, parts of the triangles `whole`, may be seen, together with their mates.
// What is clipped already is not clipped again.
SIGHTLINE_INLINE_IN_BOTH std::uint32_t find_seen(const DepthTiles& tiles, const Corners& q,
                                                 const Corners& whole, const Asked& asked, bool clip) {
  const F f;
  const VF reach = reach_of(whole);
  const Projected p = project(tiles, q, reach);
  std::uint32_t rest = asked.those & ~bits_of(f, p.behind);
  if (asked.away != 0) rest &= ~(asked.away & turn_surely(p));
  if (rest == 0) return 0;
  const Glance around = glance(tiles, {p.bounds, p.nearest, p.before});
  rest &= around.seen | around.open;
  if (rest == 0) return 0;
  std::uint32_t found = 0;
  const auto look = [&](std::uint32_t at, const auto& sees) HWY_ATTR {
    while ((at &= ~found) != 0) {
      const auto i = static_cast<std::size_t>(std::countr_zero(at));
      if (sees(i)) found |= asked.mates[i / kPiece];
      at &= at - 1;
    }
  };
  std::uint32_t clipped = rest & ~bits_of(f, p.placed);
  if (clipped != 0) {
    if (!clip) return asked.those;
    rest &= ~clipped;
    clipped &= ~beyond_a_side(tiles, q, p.error, kAskedSlack);
  }

  GrownTriangles t;
  find_sides(p.image, p.bounds, p.slack, tiles.margin, t);
  find_planes(tiles, whole, reach, p.nearest, t);
  store(p.bounds, t, 0);
  hn::Store(p.nearest, f, t.nearest.data());
  const std::uint32_t blurred = clip ? rest & bits_of(f, hn::Gt(p.slack, hn::Set(f, kMostSlack))) : 0;
  look(rest & ~blurred, [&](std::size_t i) HWY_ATTR { return seen(tiles, t, i); });
  if (clip) {
    const auto seen_clipped = [&](std::size_t i) {
      return clipped_seen(tiles, whole, i, (asked.away >> i & 1) != 0);
    };
    look(blurred, [&](std::size_t i) HWY_ATTR { return seen(tiles, t, i) && seen_clipped(i); });
    look(clipped, seen_clipped);
  }
  return found;
}

// What of a triangle lies before the near plane, by a thousandth of its distance and what rounding may have
// moved the corners more than that, and not far beyond the image. False of what is no number, and in
// orthographic views.
inline bool clip_one(const DepthTiles& tiles, Polygon& polygon) {
  if (tiles.projection.orthographic) return false;
  const EyeProjection& e = tiles.projection;
  const double at_eye = std::fabs(double{tiles.rays.near_plane.w}),
               eye = glm::length(geometry::to_double(e.eye_high) + geometry::to_double(e.eye_low));
  double slack = kKeptBeforeNear * at_eye + 2 * near_plane_slack(at_eye, eye), sum = 0;
  for (std::size_t k = 0; k < polygon.count; ++k) {
    for (int a = 0; a < 3; ++a) {
      const double side = polygon.points[k][a];
      slack = std::max(slack, kKeptReach * std::fabs(side)), sum += side;
    }
  }
  return std::isfinite(sum) && clip_to_view(tiles, slack, polygon);
}

// What of triangle i is left when it is clipped. False is certain.
bool clipped_seen(const DepthTiles& tiles, const Corners& whole, std::size_t i, bool away) {
  const F f;
  alignas(64) std::array<std::array<float, 16>, 9> in;
  Polygon polygon;
  Corners its;  // a fan of triangles, each on the plane of the whole
  for (std::size_t k = 0; k < 3; ++k) {
    hn::Store(whole[k].x, f, in[3 * k].data());
    hn::Store(whole[k].y, f, in[3 * k + 1].data());
    hn::Store(whole[k].z, f, in[3 * k + 2].data());
    const float x = in[3 * k][i], y = in[3 * k + 1][i], z = in[3 * k + 2][i];
    polygon.points[polygon.count++] = {x, y, z};
    its[k] = {hn::Set(f, x), hn::Set(f, y), hn::Set(f, z)};
  }
  if (!clip_one(tiles, polygon)) return true;
  if (polygon.count < 3) return false;
  const std::size_t triangles = polygon.count - 2;
  for (std::size_t first = 0; first < triangles; first += hn::Lanes(f)) {
    for (std::size_t lane = 0; lane < hn::Lanes(f); ++lane) {
      const std::size_t t = std::min(first + lane, triangles - 1);
      const std::size_t from[3] = {0, t + 1, t + 2};
      for (std::size_t k = 0; k < 3; ++k) {
        for (int a = 0; a < 3; ++a)
          in[3 * k + static_cast<std::size_t>(a)][lane] = static_cast<float>(polygon.points[from[k]][a]);
      }
    }
    Corners part;
    for (std::size_t k = 0; k < 3; ++k) {
      part[k] = {hn::Load(f, in[3 * k].data()), hn::Load(f, in[3 * k + 1].data()),
                 hn::Load(f, in[3 * k + 2].data())};
    }
    const std::size_t count = std::min(hn::Lanes(f), triangles - first);
    Asked asked;
    asked.those = (1u << count) - 1;
    asked.away = away ? asked.those : 0;
    asked.mates.fill(asked.those);
    if (find_seen(tiles, part, its, asked, false) != 0) return true;
  }
  return false;
}

// Pieces of runs that fill a vector.
struct Pieces {
  std::array<const float*, kPieces> first;  // of the corners of each its first triangle
  std::array<std::size_t, kPieces> run;
  std::size_t count = 0;
  std::uint32_t fronts = 0;  // that may be seen from there alone
  Asked asked;

  void add(const TriangleRun& from, std::size_t which, std::uint32_t triangle) {
    const std::size_t lane = count * kPiece;
    const std::uint32_t size = std::min<std::uint32_t>(kPiece, from.count - triangle),
                        those = ((1u << size) - 1) << lane;
    first[count] =
        &from.blocks[triangle / TriangleBlock::kSize].corners[0][0][triangle % TriangleBlock::kSize];
    run[count] = which;
    asked.those |= those;
    if (from.sides == Sides::front) fronts |= those;
    const bool goes_on = count > 0 && run[count - 1] == which;
    const std::uint32_t mates = those | (goes_on ? asked.mates[count - 1] : 0);
    for (std::size_t i = ++count; i > 0 && run[i - 1] == which; --i) asked.mates[i - 1] = mates;
  }
};

// As many pieces side by side.
template <class D, class At>
HWY_INLINE hn::Vec<D> load_pieces(D d, std::size_t first, const At& at) {
#if HWY_TARGET != HWY_SCALAR
  if constexpr (hn::MaxLanes(D()) > kPiece) {
    const hn::Half<D> half;
    return hn::Combine(d, load_pieces(half, first + hn::MaxLanes(half) / kPiece, at),
                       load_pieces(half, first, at));
  }
#endif
  return hn::LoadU(d, at(first));
}

// A row of their corners, as TriangleBlock has them.
HWY_INLINE VF load_row(const Pieces& pieces, std::size_t row) {
  return load_pieces(
      F(), 0, [&](std::size_t piece) HWY_ATTR { return pieces.first[piece] + row * TriangleBlock::kSize; });
}

// Asks for the memory of what soon comes to be asked for, as far as a vector or two read it.
HWY_INLINE void prefetch(const TriangleRun& run) {
  constexpr std::size_t kMost = 4 * sizeof(TriangleBlock), kLine = 64;
  const auto* const bytes = reinterpret_cast<const std::byte*>(run.blocks);
  const std::size_t size = std::min(kMost, run.count * (sizeof(TriangleBlock) / TriangleBlock::kSize));
  for (std::size_t at = 0; at < size; at += kLine) hwy::Prefetch(bytes + at);
}

void query_runs(const DepthTiles& tiles, std::span<const TriangleRun> runs, std::uint8_t* seen) {
  constexpr std::size_t kAhead = 4;
  std::fill_n(seen, runs.size(), std::uint8_t{0});
  for (std::size_t i = 0; i < std::min(kAhead, runs.size()); ++i) prefetch(runs[i]);
  std::size_t run = 0;
  std::uint32_t triangle = 0;  // of the run, the next
  for (;;) {
    Pieces pieces;
    while (pieces.count < kPieces && run < runs.size()) {
      if (triangle >= runs[run].count || seen[run]) {
        if (++run + kAhead <= runs.size()) prefetch(runs[run + kAhead - 1]);
        triangle = 0;
        continue;
      }
      pieces.add(runs[run], run, triangle);
      triangle += kPiece;
    }
    if (pieces.count == 0) return;
    for (std::size_t i = pieces.count; i < kPieces; ++i) pieces.first[i] = pieces.first[0];
    Corners q;
    for (std::size_t k = 0; k < 3; ++k) {
      q[k] = about_eye(tiles.projection,
                       {load_row(pieces, 3 * k), load_row(pieces, 3 * k + 1), load_row(pieces, 3 * k + 2)});
    }
    if (pieces.fronts != 0) pieces.asked.away = pieces.fronts & turned_away(tiles, q);
    const std::uint32_t found = find_seen(tiles, q, q, pieces.asked, true);
    for (std::size_t i = 0; i < pieces.count; ++i) seen[pieces.run[i]] |= found >> i * kPiece & 1;
  }
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::occlusion {
HWY_EXPORT(query_runs);

std::uint32_t fill_blocks(std::span<const Vec3> corners, std::span<TriangleBlock> blocks) noexcept {
  constexpr std::size_t kSize = TriangleBlock::kSize;
  const auto put = [&](std::size_t place, const Vec3* triangle) {
    for (std::size_t k = 0; k < 3; ++k) {
      auto& at = blocks[place / kSize].corners[k];
      const std::size_t i = place % kSize;
      at[0][i] = triangle[k].x, at[1][i] = triangle[k].y, at[2][i] = triangle[k].z;
    }
  };
  std::size_t count = 0;
  const Vec3* last = nullptr;
  for (; corners.size() >= 3; corners = corners.subspan(3)) {
    const Vec3 &a = corners[0], &b = corners[1], &c = corners[2];
    if (a == b || b == c || c == a) continue;
    last = corners.data();
    put(count++, last);
  }
  for (std::size_t i = count; i % kSize != 0; ++i) put(i, last);
  return static_cast<std::uint32_t>(count);
}

void query_triangles(const DepthTiles& tiles, std::span<const TriangleRun> runs,
                     std::uint8_t* seen) noexcept {
  HWY_DYNAMIC_DISPATCH(query_runs)(tiles, runs, seen);
}

bool query_triangles(const DepthTiles& tiles, std::span<const Vec3> corners) noexcept {
  constexpr std::size_t kAtOnce = 16;
  const std::size_t triangles = corners.size() / 3;
  std::array<TriangleBlock, kAtOnce / TriangleBlock::kSize> blocks;
  for (std::size_t first = 0; first < triangles; first += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, triangles - first);
    const TriangleRun run{blocks.data(), fill_blocks(corners.subspan(3 * first, 3 * count), blocks),
                          Sides::both};
    std::uint8_t seen = 0;
    query_triangles(tiles, {&run, 1}, &seen);
    if (seen) return true;
  }
  return false;
}

}  // namespace sightline::occlusion
#endif
