// The occlusion buffer's own: views, meshes, and what crosses the near plane.
#include <sightline/occlusion.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "library/geometry/linear.hpp"
#include "library/occlusion/depth_tiles.hpp"

namespace sightline {

using namespace geometry;

namespace occlusion {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kMaxSide = 8192;

Vec4 to_vec4(const glm::dvec3& v, double w) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), static_cast<float>(w)};
}

// The rows (pixel x, pixel y, w) of a projection about the eye, in double precision.
struct Rows {
  glm::dvec3 eye;  // in the view's own space
  glm::dvec3 x, y, w;
  glm::dvec3 constant;
  glm::dvec3 forward;  // unit
  bool orthographic = false;
};

Rows rows_of(const View& view) {
  const glm::dmat4 clip = to_double(view.eye_to_clip) * to_double(view.world_to_eye);
  const glm::dmat4 rows = glm::transpose(clip);
  Rows out;
  out.orthographic = is_orthographic(view);
  out.forward = glm::normalize(-glm::dvec3(glm::inverse(to_double(view.world_to_eye))[2]));
  const double half_width = 0.5 * view.width, half_height = 0.5 * view.height;
  const glm::dvec4 x = (rows[0] + rows[3]) * half_width, y = (rows[3] - rows[1]) * half_height, w = rows[3];
  out.x = glm::dvec3(x), out.y = glm::dvec3(y), out.w = glm::dvec3(w);
  if (out.orthographic) {
    out.eye = glm::dvec3(glm::inverse(to_double(view.world_to_eye))[3]);
  } else {
    // Where x, y and w are all 0.
    const glm::dmat3 matrix = glm::transpose(glm::dmat3(out.x, out.y, out.w));
    out.eye = -(glm::inverse(matrix) * glm::dvec3(x.w, y.w, w.w));
  }
  const auto at_eye = [&](const glm::dvec4& row) { return glm::dot(glm::dvec3(row), out.eye) + row.w; };
  out.constant = out.orthographic ? glm::dvec3(at_eye(x), at_eye(y), at_eye(w)) : glm::dvec3(0);
  return out;
}

PixelRays pixel_rays(const View& view, const Rows& rows) {
  PixelRays out;
  const glm::dvec3 last = rows.orthographic ? rows.forward : rows.w;
  const glm::dmat3 inverse = glm::inverse(glm::transpose(glm::dmat3(rows.x, rows.y, last)));
  const double scale = rows.orthographic ? rows.constant.z : 1;
  const glm::dvec3 across = inverse[0] * scale, down = inverse[1] * scale;
  const glm::dvec3 at =
      rows.orthographic ? -(inverse[0] * rows.constant.x + inverse[1] * rows.constant.y) : inverse[2];
  for (int a = 0; a < 3; ++a) {
    out.at[a] = static_cast<float>(at[a]);
    out.across[a] = static_cast<float>(across[a]);
    out.down[a] = static_cast<float>(down[a]);
    out.forward[a] = static_cast<float>(rows.forward[a]);
  }
  const double turn = glm::determinant(glm::dmat3(rows.x, rows.y, last));
  out.turns_right = turn * scale < 0;
  const Plane front = make_frustum(view, {}).planes[Frustum::front];
  const glm::dvec3 normal(front.normal.x, front.normal.y, front.normal.z);
  if (glm::length(normal) > 0.5) {
    const double at_eye = glm::dot(normal, rows.eye) + front.distance;
    // A little behind the plane: what is cut off must not be drawn.
    const double safe = 1e-5 * (std::fabs(at_eye) + 1e-3 * glm::length(rows.eye) + 1e-3);
    out.near_plane = to_vec4(normal, at_eye - safe);
  } else {
    out.near_plane = to_vec4(rows.w, rows.constant.z - 1e-6);
  }
  return out;
}

// A polygon of points about the eye; in double precision, for what the near plane cuts may reach far behind
// the eye, and its plane must still be right before it.
struct Polygon {
  static constexpr std::size_t kMost = 12;
  std::array<glm::dvec3, kMost> points;
  std::size_t count = 0;
};

double dot(const Vec4& row, const glm::dvec3& q) {
  return row.x * q.x + row.y * q.y + row.z * q.z + row.w;
}

// Sutherland & Hodgman 1974, one plane.
Polygon clip(const Polygon& polygon, const Vec4& plane) {
  Polygon out;
  const auto side = [&](const glm::dvec3& p) { return dot(plane, p); };
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const glm::dvec3 &a = polygon.points[i], &b = polygon.points[(i + 1) % polygon.count];
    const double at = side(a), next = side(b);
    if (at >= 0 && out.count < Polygon::kMost) out.points[out.count++] = a;
    if ((at >= 0) != (next >= 0) && out.count < Polygon::kMost)
      out.points[out.count++] = a + (b - a) * (at / (at - next));
  }
  return out;
}

// The plane's nearness through normal · q = at; false where it is seen too much edge on.
bool set_plane(Convex& out, const DepthTiles& tiles, const glm::dvec3& normal, double at, double reach) {
  const PixelRays& rays = tiles.rays;
  const auto along = [&](const std::array<float, 3>& v) {
    return normal.x * v[0] + normal.y * v[1] + normal.z * v[2];
  };
  const double scale = tiles.projection.orthographic ? along(rays.forward) : at;
  if (!(std::fabs(scale) > (tiles.projection.orthographic ? 1e-4 : 1e-5 * reach + 1e-6))) return false;
  out.across = static_cast<float>(along(rays.across) / scale);
  out.down = static_cast<float>(along(rays.down) / scale);
  out.at = static_cast<float>((tiles.projection.orthographic ? along(rays.at) - at : along(rays.at)) / scale);
  return true;
}

// Draws a planar convex polygon, clipped to the near plane and to somewhat more than the image.
void draw_polygon(DepthTiles& tiles, Polygon polygon, const glm::dvec3& normal, double at) {
  const EyeProjection& e = tiles.projection;
  const auto w = static_cast<float>(tiles.width), h = static_cast<float>(tiles.height);
  const auto beyond = [&](const Vec4& row, float scale, float shift) {
    return Vec4{scale * row.x + shift * e.w.x, scale * row.y + shift * e.w.y, scale * row.z + shift * e.w.z,
                scale * row.w + shift * e.w.w};
  };
  for (const Vec4& plane : {tiles.rays.near_plane, beyond(e.x, 1, w), beyond(e.x, -1, 2 * w),
                            beyond(e.y, 1, h), beyond(e.y, -1, 2 * h)}) {
    const auto outside = [&](const glm::dvec3& p) { return !(dot(plane, p) >= 0); };
    if (std::none_of(polygon.points.begin(), polygon.points.begin() + polygon.count, outside)) continue;
    polygon = clip(polygon, plane);
    if (polygon.count < 3) return;
  }
  if (polygon.count > Convex::kMaxEdges) return;
  std::array<float, Polygon::kMost> x, y;
  Convex out;
  float nearest = -kInfinity, area = 0;
  double reach = 0;
  out.left = out.top = kInfinity, out.right = out.bottom = -kInfinity;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const glm::dvec3& q = polygon.points[i];
    const double over_w = 1 / dot(e.w, q);
    x[i] = static_cast<float>(dot(e.x, q) * over_w), y[i] = static_cast<float>(dot(e.y, q) * over_w);
    nearest = std::max(nearest, static_cast<float>(e.orthographic ? dot(e.nearness, q) : over_w));
    reach = std::max({reach, std::fabs(q.x), std::fabs(q.y), std::fabs(q.z)});
    out.left = std::min(out.left, x[i]), out.right = std::max(out.right, x[i]);
    out.top = std::min(out.top, y[i]), out.bottom = std::max(out.bottom, y[i]);
  }
  for (std::size_t i = 1; i + 1 < polygon.count; ++i) {
    area += (x[i] - x[0]) * (y[i + 1] - y[0]) - (x[i + 1] - x[0]) * (y[i] - y[0]);
  }
  if (!(std::fabs(area) > 0.5f) || !set_plane(out, tiles, normal, at, reach)) return;
  move_back(out, nearest);
  const float inset = kInset + kInsetGrowth * 2 * std::max(w, h);
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const std::size_t j = (i + 1) % polygon.count;
    add_edge(out, x[i], y[i], x[j], y[j], (y[j] > y[i]) == (area > 0), inset);
  }
  out.left += inset, out.right -= inset, out.top += inset, out.bottom -= inset;
  draw_convex(tiles, out);
}

}  // namespace

EyeProjection eye_projection(const WorldView& view, const WorldPoint& origin) noexcept {
  const Rows rows = rows_of(view.view);
  const glm::dvec3 eye =
      rows.eye + glm::dvec3(view.origin.x - origin.x, view.origin.y - origin.y, view.origin.z - origin.z);
  EyeProjection out;
  out.eye_high = to_vec3(eye);
  out.eye_low = to_vec3(eye - to_double(out.eye_high));
  out.x = to_vec4(rows.x, rows.constant.x);
  out.y = to_vec4(rows.y, rows.constant.y);
  out.w = to_vec4(rows.w, rows.constant.z);
  out.nearness = to_vec4(-rows.forward, 0);
  out.orthographic = rows.orthographic;
  return out;
}

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
      draw_polygon(tiles, face, normal, at);
    }
  }
}

void draw_clipped_triangle(DepthTiles& tiles, const std::array<std::array<double, 3>, 3>& corners) noexcept {
  Polygon polygon;
  for (const auto& c : corners) polygon.points[polygon.count++] = {c[0], c[1], c[2]};
  const glm::dvec3 &p = polygon.points[0], &q = polygon.points[1], &r = polygon.points[2];
  const glm::dvec3 normal = glm::cross(q - p, r - p);
  const double length = glm::length(normal);
  if (length > 0) draw_polygon(tiles, polygon, normal / length, glm::dot(normal / length, p));
}

void OccluderTopology::lay_out() {
  const std::size_t count = (triangles.size() + kGroup - 1) / kGroup;
  groups.resize(count);
  corners.resize(count * 9 * kGroup);
  neighbour.assign(count * 3 * kGroup, -1);
  box.assign((count + 15) / 16 * 96, 0);
  for (std::size_t g = 0; g < count; ++g) {
    Group& group = groups[g];
    const std::size_t first = g * kGroup, end = std::min(first + kGroup, triangles.size());
    glm::dvec3 low(1e300), high(-1e300);
    group.first_beside = static_cast<std::uint32_t>(beside.size());
    for (std::size_t i = 0; i < kGroup; ++i) {
      const auto& triangle = triangles[std::min(first + i, end - 1)];
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& p = positions[first + i < end ? triangle[k] : triangle[0]];
        float* out = &corners[(g * 9 + 3 * k) * kGroup + i];
        out[0] = p.x, out[kGroup] = p.y, out[2 * kGroup] = p.z;
        low = glm::min(low, to_double(p)), high = glm::max(high, to_double(p));
        if (first + i >= end) continue;
        group.first_half |= std::uint32_t{first_half[first + i]} << i;
        group.turned[k] |= std::uint32_t{triangle[k] > triangle[(k + 1) % 3]} << i;
        const std::uint32_t other = neighbours[first + i][k];
        neighbour[(g * 3 + k) * kGroup + i] = static_cast<std::int32_t>(other);
        if (other != kNone && other / kGroup != g) beside.push_back(other / kGroup);
      }
    }
    std::sort(beside.begin() + group.first_beside, beside.end());
    beside.erase(std::unique(beside.begin() + group.first_beside, beside.end()), beside.end());
    group.end_beside = static_cast<std::uint32_t>(beside.size());
    const Vec3 middle = to_vec3(0.5 * low + 0.5 * high);
    const glm::dvec3 half = glm::max(high - to_double(middle), to_double(middle) - low) * (1 + 1e-6);
    float* out = &box[g / 16 * 96 + g % 16];
    out[0] = middle.x, out[16] = middle.y, out[32] = middle.z;
    for (int a = 0; a < 3; ++a) out[48 + 16 * a] = static_cast<float>(half[a]);
  }
}

// Along a curve that visits neighbours together (Morton 1966), so that runs of triangles lie together.
void sort_along_curve(OccluderTopology& mesh) {
  glm::dvec3 low(1e300), high(-1e300);
  for (const Vec3& p : mesh.positions) low = glm::min(low, to_double(p)), high = glm::max(high, to_double(p));
  const glm::dvec3 size = glm::max(high - low, glm::dvec3(1e-30));
  const auto key = [&](const std::array<std::uint32_t, 3>& t) {
    const glm::dvec3 middle = (to_double(mesh.positions[t[0]]) + to_double(mesh.positions[t[1]]) +
                               to_double(mesh.positions[t[2]])) /
                              3.0;
    const glm::dvec3 at = (middle - low) / size * 1023.0;
    std::uint32_t out = 0;
    for (int bit = 9; bit >= 0; --bit) {
      for (int a = 0; a < 3; ++a)
        out = out << 1 | (static_cast<std::uint32_t>(std::clamp(at[a], 0.0, 1023.0)) >> bit & 1);
    }
    return out;
  };
  std::vector<std::pair<std::uint32_t, std::array<std::uint32_t, 3>>> keyed;
  for (const auto& t : mesh.triangles) keyed.emplace_back(key(t), t);
  std::stable_sort(keyed.begin(), keyed.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < keyed.size(); ++i) mesh.triangles[i] = keyed[i].second;
}

}  // namespace occlusion

using occlusion::DepthTiles;
using occlusion::kTile;

OcclusionBuffer::OcclusionBuffer() : tiles_(std::make_unique<DepthTiles>()) {}
OcclusionBuffer::~OcclusionBuffer() = default;
OcclusionBuffer::OcclusionBuffer(OcclusionBuffer&&) noexcept = default;
OcclusionBuffer& OcclusionBuffer::operator=(OcclusionBuffer&&) noexcept = default;

Check OcclusionBuffer::begin(const WorldView& view) {
  if (Check bad = check(view.view)) return bad;
  const WorldPoint& o = view.origin;
  if (!(std::fabs(o.x) <= kWorldReach && std::fabs(o.y) <= kWorldReach && std::fabs(o.z) <= kWorldReach)) {
    return Failure{"occlusion: the view's origin is out of range, expected within 1e11 m of 0"};
  }
  if (view.view.width > occlusion::kMaxSide || view.view.height > occlusion::kMaxSide) {
    return Failure{"occlusion: expected a view of at most 8192 pixels a side"};
  }
  DepthTiles& t = *tiles_;
  t.view = view;
  t.width = view.view.width, t.height = view.view.height;
  t.columns = (t.width + kTile - 1) / kTile, t.rows = (t.height + kTile - 1) / kTile;
  t.stride = (t.columns + 15) / 16 * 16 + 16;
  t.projection = occlusion::eye_projection(view, view.origin);
  t.rays = occlusion::pixel_rays(view.view, occlusion::rows_of(view.view));
  t.farthest.assign(std::size_t{t.stride} * t.rows, occlusion::kInfinity);
  for (std::uint32_t row = 0; row < t.rows; ++row) {
    std::fill_n(t.farthest.begin() + std::size_t{row} * t.stride, t.columns, -occlusion::kInfinity);
  }
  t.nearest.assign(t.farthest.size(), -occlusion::kInfinity);
  if (t.nearness.size() < 64 * t.farthest.size()) t.nearness.resize(64 * t.farthest.size());
  t.untouched.resize(4 * 64);
  for (std::uint32_t kind = 0; kind < 4; ++kind) {
    for (std::uint32_t i = 0; i < 64; ++i) {
      const bool beyond = (kind & 1 && (t.columns - 1) * kTile + i % kTile >= t.width) ||
                          (kind & 2 && (t.rows - 1) * kTile + i / kTile >= t.height);
      t.untouched[kind * 64 + i] = beyond ? occlusion::kInfinity : -occlusion::kInfinity;
    }
  }
  return {};
}

void OcclusionBuffer::draw_boxes(std::span<const Box> boxes) noexcept {
  occlusion::draw_boxes(*tiles_, boxes);
}

void OcclusionBuffer::draw_boxes(std::span<const WorldBox> boxes) noexcept {
  const auto inwards = [](double low, double high, float& from, float& to) {
    from = static_cast<float>(low), to = static_cast<float>(high);
    if (static_cast<double>(from) < low) from = std::nextafter(from, occlusion::kInfinity);
    if (static_cast<double>(to) > high) to = std::nextafter(to, -occlusion::kInfinity);
  };
  const WorldPoint& o = tiles_->view.origin;
  std::array<Box, 64> some;
  for (std::size_t first = 0; first < boxes.size(); first += some.size()) {
    const std::size_t count = std::min(some.size(), boxes.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      const WorldBox& b = boxes[first + i];
      inwards(b.min.x - o.x, b.max.x - o.x, some[i].min.x, some[i].max.x);
      inwards(b.min.y - o.y, b.max.y - o.y, some[i].min.y, some[i].max.y);
      inwards(b.min.z - o.z, b.max.z - o.z, some[i].min.z, some[i].max.z);
    }
    occlusion::draw_boxes(*tiles_, std::span(some).first(count));
  }
}

void OcclusionBuffer::draw_balls(std::span<const Sphere> balls) noexcept {
  occlusion::draw_balls(*tiles_, balls);
}

void OcclusionBuffer::draw_mesh(const OccluderMesh& mesh, const Affine& transform) {
  occlusion::draw_mesh(*tiles_, mesh.topology(), transform);
}

bool OcclusionBuffer::may_see(const Box& b) const noexcept {
  std::uint8_t visible = 1;
  occlusion::query_boxes(*tiles_, tiles_->projection,
                         {&b.min.x, &b.min.y, &b.min.z, &b.max.x, &b.max.y, &b.max.z, 1}, &visible);
  return visible != 0;
}

void OcclusionBuffer::may_see(const BoxSpan& boxes, std::span<std::uint8_t> visible) const noexcept {
  occlusion::query_boxes(*tiles_, tiles_->projection, boxes, visible.data());
}

void OcclusionBuffer::may_see(const BoxSpan& boxes, const WorldPoint& origin,
                              std::span<std::uint8_t> visible) const noexcept {
  occlusion::query_boxes(*tiles_, occlusion::eye_projection(tiles_->view, origin), boxes, visible.data());
}

void OcclusionBuffer::may_see(const SphereSpan& spheres, std::span<std::uint8_t> visible) const noexcept {
  occlusion::query_spheres(*tiles_, tiles_->projection, spheres, visible.data());
}

bool OcclusionBuffer::may_see(std::span<const Vec3> triangles) const noexcept {
  return occlusion::query_triangles(*tiles_, triangles);
}

std::uint32_t OcclusionBuffer::width() const noexcept {
  return tiles_->width;
}
std::uint32_t OcclusionBuffer::height() const noexcept {
  return tiles_->height;
}

void OcclusionBuffer::read_nearness(std::span<float> pixels) const noexcept {
  const DepthTiles& t = *tiles_;
  for (std::uint32_t y = 0; y < t.height; ++y) {
    for (std::uint32_t x = 0; x < t.width; ++x) {
      const std::size_t tile = std::size_t{y / kTile} * t.stride + x / kTile;
      pixels[std::size_t{y} * t.width + x] = t.nearest[tile] > -occlusion::kInfinity
                                                 ? t.nearness[tile * 64 + y % kTile * kTile + x % kTile]
                                                 : -occlusion::kInfinity;
    }
  }
}

OccluderMesh::OccluderMesh(std::span<const Vec3> positions, std::span<const std::uint32_t> indices)
    : topology_(std::make_unique<occlusion::OccluderTopology>()) {
  struct Hash {
    std::size_t operator()(const Vec3& v) const noexcept {
      std::uint64_t h = 0;
      for (const float f : {v.x, v.y, v.z})
        h = (h ^ std::bit_cast<std::uint32_t>(f + 0.0f)) * 0x9e3779b97f4a7c15u, h ^= h >> 31;
      return h;
    }
  };
  occlusion::OccluderTopology& t = *topology_;
  std::unordered_map<Vec3, std::uint32_t, Hash> joined;
  const auto vertex = [&](std::uint32_t index) {
    const auto [at, added] =
        joined.try_emplace(positions[index], static_cast<std::uint32_t>(t.positions.size()));
    if (added) t.positions.push_back(positions[index]);
    return at->second;
  };
  for (std::size_t i = 0; i + 3 <= indices.size(); i += 3) {
    if (indices[i] >= positions.size() || indices[i + 1] >= positions.size() ||
        indices[i + 2] >= positions.size())
      continue;
    const std::array<std::uint32_t, 3> corner{vertex(indices[i]), vertex(indices[i + 1]),
                                              vertex(indices[i + 2])};
    if (corner[0] != corner[1] && corner[1] != corner[2] && corner[2] != corner[0])
      t.triangles.push_back(corner);
  }
  occlusion::sort_along_curve(t);
  // The edge's triangles, the second of which makes them neighbours; a third parts them again.
  struct Sides {
    std::uint32_t triangle[2], edge[2], count = 0;
  };
  std::unordered_map<std::uint64_t, Sides> edges;
  t.neighbours.assign(t.triangles.size(),
                      {occlusion::OccluderTopology::kNone, occlusion::OccluderTopology::kNone,
                       occlusion::OccluderTopology::kNone});
  for (std::uint32_t i = 0; i < t.triangles.size(); ++i) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint64_t a = t.triangles[i][k], b = t.triangles[i][(k + 1) % 3];
      Sides& sides = edges[std::min(a, b) << 32 | std::max(a, b)];
      if (sides.count < 2) sides.triangle[sides.count] = i, sides.edge[sides.count] = k;
      ++sides.count;
    }
  }
  for (const auto& [key, sides] : edges) {
    if (sides.count != 2) continue;
    t.neighbours[sides.triangle[0]][sides.edge[0]] = sides.triangle[1];
    t.neighbours[sides.triangle[1]][sides.edge[1]] = sides.triangle[0];
  }
  occlusion::pair_up(t);
  t.lay_out();
}

OccluderMesh::~OccluderMesh() = default;
OccluderMesh::OccluderMesh(OccluderMesh&&) noexcept = default;
OccluderMesh& OccluderMesh::operator=(OccluderMesh&&) noexcept = default;
std::size_t OccluderMesh::triangles() const noexcept {
  return topology_->triangles.size();
}

}  // namespace sightline
