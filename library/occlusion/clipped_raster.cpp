// Occluders that the near plane cuts, or whose faces are seen edge on: polygon by polygon, in double
// precision.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "library/geometry/error_bounds.hpp"
#include "library/occlusion/depth_tiles.hpp"
#include "library/occlusion/near_clip.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "library/occlusion/clipped_raster.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include "library/occlusion/depth_raster-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace sightline::occlusion::HWY_NAMESPACE {

// A polygon as the image has it, and the part of it that it covers alone, whatever its neighbours do. Returns
// how many tiles lie around it.
std::uint32_t draw_convex(DepthTiles& tiles, const Convex& tight, const Convex& middle,
                          const Surroundings& around) {
  const TileRange range = tiles_of(tiles, tight.left, tight.right, tight.top, tight.bottom);
  const float deeper = deeper_by(tiles, tight, around.slant);
  const bool again = is_much_deeper(tiles, tight, deeper);
  Convex shared = tight;
  shared.at -= deeper;
  TileList<1> list;
  if (again) list_polygon(tiles, middle, range, list);
  list_polygon(tiles, shared, range, around.without, middle, again, list);
  draw_listed(tiles, list);
  tiles.mesh->note_cost(range.begin_y, range.end_y, range.end_x - range.begin_x);
  return range.count();
}

}  // namespace sightline::occlusion::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::occlusion {
HWY_EXPORT(draw_convex);

using namespace geometry;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// A plane normal · q = at.
struct WidePlane {
  glm::dvec3 normal;
  double at;
};

// A polygon on the image.
struct Outline {
  std::array<float, Polygon::kMost> x, y;
  std::size_t count;
  float left = kInfinity, right = -kInfinity, top = kInfinity, bottom = -kInfinity;
  float nearest = -kInfinity;
  double reach = 0;  // the largest coordinate about the eye
};

Outline outline_of(const EyeProjection& e, const Polygon& polygon) {
  Outline out;
  out.count = polygon.count;
  out.reach = reach_of(std::span(polygon.points).first(polygon.count));
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const glm::dvec3& q = polygon.points[i];
    const double over_w = 1 / dot(e.w, q);
    const float x = static_cast<float>(dot(e.x, q) * over_w), y = static_cast<float>(dot(e.y, q) * over_w);
    out.x[i] = x, out.y[i] = y;
    out.nearest = std::max(out.nearest, static_cast<float>(e.orthographic ? dot(e.nearness, q) : over_w));
    out.left = std::min(out.left, x), out.right = std::max(out.right, x);
    out.top = std::min(out.top, y), out.bottom = std::max(out.bottom, y);
  }
  return out;
}

// Twice the area, by sign as it turns.
float area_of(const Outline& o) {
  float area = 0;
  for (std::size_t i = 1; i + 1 < o.count; ++i) {
    area += (o.x[i] - o.x[0]) * (o.y[i + 1] - o.y[0]) - (o.x[i + 1] - o.x[0]) * (o.y[i] - o.y[0]);
  }
  return area;
}

// The plane's nearness, moved away by what rounding can have brought it nearer: of the numbers, and of the
// pixel's place on a surface seen edge on. False where it is seen too much edge on.
bool set_plane(const DepthTiles& tiles, const WidePlane& plane, const Outline& outline, Convex& out) {
  const PixelRays& rays = tiles.rays;
  const bool orthographic = tiles.projection.orthographic;
  const auto along = [&](const std::array<float, 3>& v) {
    return plane.normal.x * v[0] + plane.normal.y * v[1] + plane.normal.z * v[2];
  };
  const double scale = orthographic ? along(rays.forward) : plane.at;
  if (!(std::fabs(scale) >
        (orthographic ? double{rays.edge_on} : kEdgeOnPart * outline.reach + kEdgeOnDistance)))
    return false;
  out.across = static_cast<float>(along(rays.across) / scale);
  out.down = static_cast<float>(along(rays.down) / scale);
  out.at = static_cast<float>((orthographic ? along(rays.at) - plane.at : along(rays.at)) / scale);
  out.at -= kNearnessRounding * std::fabs(outline.nearest) +
            (std::fabs(out.across) + std::fabs(out.down)) * (kPixelPlay + tiles.around());
  return true;
}

// The line of an edge that reaches behind the eye, and of no other edge between the same points.
SeamLine line_through(const EyeProjection& e, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 line = glm::cross(glm::dvec3(dot(e.x, a), dot(e.y, a), dot(e.w, a)),
                                     glm::dvec3(dot(e.x, b), dot(e.y, b), dot(e.w, b)));
  return {SeamLine::Kind::given, static_cast<float>(-line.z / line.x), static_cast<float>(-line.y / line.x)};
}

// Adds an edge's line to the side that the edge from corner i on bounds.
void add_line(const Outline& outline, std::size_t i, bool turns_right, const SeamLine& line, Convex& out) {
  const std::size_t next = (i + 1) % outline.count;
  const float rise = outline.y[next] - outline.y[i];
  // What rises less is bounded by the rows.
  if (!(std::fabs(rise) >= kFlatEdge) || !std::isfinite(line.at) || !std::isfinite(line.slope)) return;
  out.add_edge((rise > 0) == turns_right, line.at, line.slope);
}

// Adds the edge from corner i on, moved inwards by `inset` pixels.
void add_edge(const Outline& outline, std::size_t i, bool turns_right, float inset, Convex& out) {
  const std::size_t next = (i + 1) % outline.count;
  const float ax = outline.x[i], ay = outline.y[i], bx = outline.x[next], by = outline.y[next];
  const float dy = by - ay;
  if (!(std::fabs(dy) >= kFlatEdge)) {
    // Flat ones end the rows: those that run to the right lie above what turns right.
    if ((bx > ax) == turns_right)
      out.top = std::max(out.top, std::max(ay, by) + inset);
    else
      out.bottom = std::min(out.bottom, std::min(ay, by) - inset);
    return;
  }
  const float slope = (bx - ax) / dy, at = ax - ay * slope;
  const float inwards = inset * (1 + std::fabs(slope));
  const bool on_right = (by > ay) == turns_right;
  out.add_edge(on_right, on_right ? at - inwards : at + inwards, slope);
}

// A polygon that lies on the plane, if it turns that way; 0: whichever way it turns. Seams by the numbers of
// its edges. Returns how many tiles lie around what was drawn.
std::uint32_t draw_clipped(DepthTiles& tiles, Polygon polygon, const WidePlane& plane, float way,
                           const Surroundings& around) {
  const std::array<SeamLine, 3>& seams = around.seams;
  const double reach = reach_of(std::span(polygon.points).first(polygon.count));
  if (!clip_to_view(tiles, 0, polygon)) return 0;
  if (polygon.count < 3 || polygon.count > Convex::kMaxEdges) return 0;
  const Outline outline = outline_of(tiles.projection, polygon);
  const float area = area_of(outline);
  if (way * area < 0) return 0;
  Convex out;
  if (!(std::fabs(area) > kLeastClippedArea) || !set_plane(tiles, plane, outline, out)) return 0;
  out.left = outline.left, out.right = outline.right, out.top = outline.top, out.bottom = outline.bottom;
  const float inset =
      kInset + tiles.around() + kInsetGrowth * 2 * static_cast<float>(std::max(tiles.width, tiles.height));
  const float play =
      near_edge_play(tiles, reach, tiles.projection.orthographic ? 1 : 1 / double{outline.nearest});
  Convex middle = out;
  for (std::size_t i = 0; i < outline.count; ++i) {
    const std::uint8_t edge = polygon.edge[i];
    // Of edges beside the image, too, where it does no harm.
    const float inwards = edge == Polygon::kClipped ? inset + play : inset;
    add_edge(outline, i, area > 0, inwards, middle);
    if (edge < seams.size() && seams[edge].kind != SeamLine::Kind::none)
      add_line(outline, i, area > 0, seams[edge], out);
    else
      add_edge(outline, i, area > 0, inwards, out);
  }
  return HWY_DYNAMIC_DISPATCH(draw_convex)(tiles, out, middle, around);
}

}  // namespace

void draw_clipped_box(DepthTiles& tiles, const std::array<float, 3>& low,
                      const std::array<float, 3>& high) noexcept {
  for (int a = 0; a < 3; ++a) {
    for (const bool up : {false, true}) {
      const float at = up ? high[a] : low[a];
      const bool faces_eye =
          tiles.projection.orthographic ? (tiles.rays.forward[a] < 0) == up : (at < 0) == up;
      if (!faces_eye || at == 0) continue;
      Polygon face;
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      for (const auto& [s, t] : {std::pair{false, false}, {true, false}, {true, true}, {false, true}}) {
        glm::dvec3& p = face.points[face.count++];
        p[a] = at, p[b] = s ? high[b] : low[b], p[c] = t ? high[c] : low[c];
      }
      glm::dvec3 normal(0);
      normal[a] = 1;
      draw_clipped(tiles, face, {normal, at}, 0, {});
    }
  }
}

std::uint32_t draw_clipped_triangle(DepthTiles& tiles, const std::array<glm::dvec3, 3>& corners, float way,
                                    const Surroundings& around) noexcept {
  Polygon polygon;
  for (const glm::dvec3& c : corners) {
    polygon.edge[polygon.count] = static_cast<std::uint8_t>(polygon.count);
    polygon.points[polygon.count++] = c;
  }
  Surroundings its = around;
  for (std::size_t k = 0; k < 3; ++k) {
    if (its.seams[k].kind == SeamLine::Kind::through_near)
      its.seams[k] = line_through(tiles.projection, polygon.points[k], polygon.points[(k + 1) % 3]);
  }
  const glm::dvec3 &p = polygon.points[0], &q = polygon.points[1], &r = polygon.points[2];
  const glm::dvec3 normal = glm::cross(q - p, r - p);
  const double length = glm::length(normal);
  if (!(length > 0)) return 0;
  return draw_clipped(tiles, polygon, {normal / length, glm::dot(normal / length, p)}, way, its);
}

}  // namespace sightline::occlusion
#endif
