// Each bound of triangles' planes, the near plane and spheres against the worst case that a search finds.
#include "geometry/rounding.hpp"

#include <array>

namespace sightline {
namespace {

using namespace test;

// --- planes of triangles ---

// A triangle before the eye, its nearness at a pixel that it may hold, and what the kernels need.
struct Triangle {
  std::array<Vec3, 3> q;              // about the eye, as the kernels have it
  std::array<glm::dvec3, 3> exact_q;  // as it is
  float x, y;                         // the pixel
  double nearness = 0;
  float nearest = 0, reach = 0;
  occlusion::PixelRays rays;
  bool sound = false;
};

Triangle triangle(Draws& d, double thin) {
  const Seen s = seen(d, 1.5, 10, 8192, 8192);
  Triangle t;
  t.rays = occlusion::pixel_rays(s.view);
  const glm::dvec3 eye = to_double(s.rows.eye_high) + to_double(s.rows.eye_low);
  const double size = d.any_size(0.05, 20);
  const Vec3 first = point_in(s, d.between(-1, 1), d.between(-1, 1), d.between(0.2, 50));
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 p = k == 0 ? first : rounded(to_double(first) + direction(d) * (k == 1 ? size : size * thin));
    t.q[k] = about_eye(s.rows, p), t.exact_q[k] = to_double(p) - eye;
    t.reach = std::max(t.reach, largest_of(t.q[k]));
    const float over_w = float_pixel(s.rows, t.q[k]).over_w;
    if (!(over_w > 0)) return t;
    t.nearest = std::max(t.nearest, over_w);
  }
  // Its nearness where the ray of a point within it meets its plane.
  const double a = d.between(0, 1), b = d.between(0, 1 - a);
  const ExactPixel in =
      exact_pixel(s, rounded(eye + t.exact_q[0] * (1 - a - b) + t.exact_q[1] * a + t.exact_q[2] * b));
  t.x = std::floor(static_cast<float>(in.x)) + 0.5f, t.y = std::floor(static_cast<float>(in.y)) + 0.5f;
  const glm::dmat4 rows = glm::transpose(s.clip);
  const auto row = [&](int r) { return glm::dvec3(rows[r]); };
  const glm::dmat3 pixels =
      glm::transpose(glm::dmat3((row(0) + row(3)) * 4096.0, (row(3) - row(1)) * 4096.0, row(3)));
  const glm::dvec3 ray = glm::inverse(pixels) * glm::dvec3(t.x, t.y, 1);
  const glm::dvec3 n = glm::cross(t.exact_q[1] - t.exact_q[0], t.exact_q[2] - t.exact_q[0]);
  t.nearness = glm::dot(n, ray) / glm::dot(n, t.exact_q[0]);
  bool within = t.x > 0 && t.x < 8192 && t.y > 0 && t.y < 8192 && t.nearness > 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 &from = t.exact_q[k], &to = t.exact_q[(k + 1) % 3];
    within = within && glm::dot(glm::cross(to - from, ray / t.nearness - from), n) >= 0;
  }
  t.sound = within;
  return t;
}

// What the three parts of a bound are multiples of. The search looks where the wanted one makes up most of
// it, by weights of its own, so that it looks at the same cases whatever the bounds are.
struct Terms {
  double numbers, play, normal;
  [[nodiscard]] double bound(double normal_rounding) const {
    return kNearnessRounding * numbers + kPixelPlay * play + normal_rounding * normal;
  }
  [[nodiscard]] bool mostly(int part) const {
    const std::array parts{2e-5 * numbers, play / 64, 4e-7 * normal};
    return parts[static_cast<std::size_t>(part)] > 0.7 * (parts[0] + parts[1] + parts[2]);
  }
};

Vec3 vec(const std::array<float, 3>& v) {
  return {v[0], v[1], v[2]};
}

TEST(ErrorBounds, PlanesOfOccluders) {
  const auto part_of = [](int wanted, double thin) {
    return [wanted, thin](Draws& d) {
      const Triangle t = triangle(d, thin);
      if (!t.sound) return 0.0;
      const Vec3 pq = minus(t.q[1], t.q[0]), pr = minus(t.q[2], t.q[0]), normal = cross(pq, pr);
      const float long_side = std::sqrt(dot(normal, normal));
      const Vec3 unit{normal.x / long_side, normal.y / long_side, normal.z / long_side};
      std::size_t nearest = 0;
      for (std::size_t k = 1; k < 3; ++k) {
        if (length(t.exact_q[k]) < length(t.exact_q[nearest])) nearest = k;
      }
      const float scale = dot(unit, t.q[nearest]);
      if (!(std::fabs(scale) > kEdgeOnPart * t.reach + kEdgeOnDistance)) return 0.0;
      const float across = dot(unit, vec(t.rays.across)) / scale, down = dot(unit, vec(t.rays.down)) / scale,
                  at = dot(unit, vec(t.rays.at)) / scale;
      const float sides = largest_of(pq) + largest_of(pr), slant = std::fabs(across) + std::fabs(down);
      const Terms terms{t.nearest, slant, t.reach * sides / (long_side * std::fabs(scale))};
      if (!terms.mostly(wanted)) return 0.0;
      return ((at + t.x * across) + t.y * down - t.nearness + slant / 256) /
             terms.bound(kDrawnNormalRounding);
    };
  };
  expect_share(worst(18, part_of(0, 1)), 0.086);
  expect_share(worst(18, part_of(1, 1)), 0.29);
  expect_share(worst(18, part_of(2, 0.003)), 0.026);
}

TEST(ErrorBounds, PlanesOfTrianglesAskedFor) {
  const auto part_of = [](int wanted, double thin) {
    return [wanted, thin](Draws& d) {
      const Triangle t = triangle(d, thin);
      if (!t.sound) return 0.0;
      const Vec3 a = minus(t.q[1], t.q[0]), b = minus(t.q[2], t.q[0]), normal = cross(a, b);
      const float scale = dot(normal, t.q[0]);
      const float across = dot(normal, vec(t.rays.across)) / scale,
                  down = dot(normal, vec(t.rays.down)) / scale, at = dot(normal, vec(t.rays.at)) / scale;
      const float doubt = std::sqrt(dot(a, a) * dot(b, b)) * t.reach / std::fabs(scale);
      if (!(doubt < kMostDoubt)) return 0.0;
      const float slant = std::fabs(across) + std::fabs(down);
      const Terms terms{t.nearest, slant, t.nearest * doubt};
      if (!terms.mostly(wanted)) return 0.0;
      return (t.nearness - ((at + t.x * across) + t.y * down) + slant / 256) /
             terms.bound(kAskedNormalRounding);
    };
  };
  expect_share(worst(18, part_of(0, 1)), 0.097);
  expect_share(worst(18, part_of(1, 1)), 0.31);
  expect_share(worst(18, part_of(2, 0.003)), 0.084);
}

TEST(ErrorBounds, PlanesOfPolygons) {
  // A point beside a plane that some ray meets, and the plane's nearness there.
  const auto apart = [](Draws& d) {
    const double distance = d.any_size(0.05, 20), sine = d.between(0.01, 1), depth = distance / sine;
    const double e = distance * d.between(1e-7, 4e-5), found = distance * d.between(0.976, 1.024);
    const double true_depth = depth + d.between(-e, e) / sine;
    return (1 / depth - 1 / true_depth) / (kPolygonApart / depth * e / found);
  };
  expect_share(worst(5, apart), 0.82);
  const auto moved = [](Draws& d) {
    const float at = d.any_float(0.01, 1), by = std::fabs(at) * static_cast<float>(d.between(1e-6, 1e-4));
    const volatile float to = at - (by + kPolygonRounding * std::fabs(at));
    return ((double{to} - (double{at} - by)) / (double{kPolygonRounding} * std::fabs(at))) + 1;
  };
  expect_share(worst(3, moved), 0.48);
}

TEST(ErrorBounds, SurelyFacingTheEye) {
  // A box's face, and a triangle of some size: on which side of the plane the eye lies.
  const auto face = [](Draws& d) {
    const Seen s = seen(d, 1.5, 10, 64, 64);
    const Vec3 p = point(d, 0.01, 100), q = about_eye(s.rows, p);
    const double exact = double{p.x} - s.rows.eye_high.x - s.rows.eye_low.x;
    return std::fabs(q.x - exact) / (kFaceDistance + kFacePart * std::fabs(exact));
  };
  expect_share(worst(9, face), 0.0116);
  const auto triangles = [](Draws& d) {
    const Triangle t = triangle(d, 1);
    const glm::dvec3 exact_normal = glm::cross(t.exact_q[1] - t.exact_q[0], t.exact_q[2] - t.exact_q[0]);
    const Vec3 pq = minus(t.q[1], t.q[0]), pr = minus(t.q[2], t.q[0]), normal = cross(pq, pr);
    const float size = std::sqrt(dot(normal, normal));
    if (!t.sound || size < 0.3f * t.reach * t.reach) return 0.0;
    const Vec3 unit{normal.x / size, normal.y / size, normal.z / size};
    return std::fabs(dot(unit, t.q[0]) - glm::dot(exact_normal, t.exact_q[0]) / length(exact_normal)) /
           (kEdgeOnPart * t.reach + kEdgeOnDistance);
  };
  expect_share(worst(18, triangles), 0.024);
  // How far the product that tells it is off.
  const auto product = [](Draws& d) {
    const Triangle t = triangle(d, 1);
    const glm::dvec3 exact_normal = glm::cross(t.exact_q[1] - t.exact_q[0], t.exact_q[2] - t.exact_q[0]);
    const Vec3 pq = minus(t.q[1], t.q[0]), pr = minus(t.q[2], t.q[0]);
    const double a = largest_of(pq), b = largest_of(pr), r = t.reach;
    if (!t.sound) return 0.0;
    return std::fabs(dot(cross(pq, pr), t.q[0]) - glm::dot(exact_normal, t.exact_q[0])) /
           (kSideRounding * r * (2 * a * b + r * (a + b)));
  };
  expect_share(worst(18, product), 0.21);
}

// --- the near plane ---

TEST(ErrorBounds, NearPlane) {
  // How far before it the prepared plane is, at least, of eyes near the origin and far from it.
  double farthest = 0;
  const auto moved = [&farthest](Draws& d) {
    const Seen s = seen(d, 1.5, farthest, 64, 64);
    const Vec4 near_plane = occlusion::pixel_rays(s.view).near_plane;
    const Vec3 p = point_in(s, d.between(-1, 1), d.between(-1, 1), d.between(0.05, 0.2)),
               q = about_eye(s.rows, p);
    const glm::dvec4 row = glm::transpose(s.clip)[2];
    const double unit = length(glm::dvec3(row)),
                 exact = (glm::dot(glm::dvec3(row), to_double(p)) + row.w) / unit;
    const glm::dvec3 eye = to_double(s.rows.eye_high) + to_double(s.rows.eye_low);
    const double slack = near_plane_slack((glm::dot(glm::dvec3(row), eye) + row.w) / unit, length(eye));
    return (dot_row(near_plane, q) - exact + slack) / slack;
  };
  farthest = 0.1;
  expect_share(worst(14, moved), 0.077);
  farthest = 1e3;
  expect_share(worst(14, moved), 0.073);
  // What a triangle keeps: the row's and the corners' rounding, and what the plane was moved by.
  const auto kept = [](Draws& d) {
    const Seen s = seen(d, 1.5, 0.1, 64, 64);
    const Vec4 row = occlusion::pixel_rays(s.view).near_plane;
    const Vec3 p = point(d, 1, 1000), q = about_eye(s.rows, p);
    const glm::dvec3 eye = to_double(s.rows.eye_high) + to_double(s.rows.eye_low),
                     exact_q = to_double(p) - eye;
    const glm::dvec3 forward(-s.view.world_to_eye.m[2], -s.view.world_to_eye.m[6],
                             -s.view.world_to_eye.m[10]);
    const double exact = glm::dot(forward, exact_q) / length(forward);
    const double with_row = row.x * double{q.x} + row.y * double{q.y} + row.z * double{q.z};
    return std::fabs(with_row - exact) / (kKeptReach * largest_of(q));
  };
  expect_share(worst(12, kept), 0.143);
  expect_share(near_plane_slack(0.1, 0) / (kKeptBeforeNear * 0.1), 0.0101);
}

// --- spheres ---

TEST(ErrorBounds, DiscsOfSpheres) {
  const auto sheared = [](Draws& d) {
    const double r = d.between(-kMostShear, kMostShear), angle = d.between(0, 6.3);
    const double x = std::cos(angle), y = (std::sin(angle) - r * x) / std::sqrt(1 - r * r);
    return (std::sqrt(x * x + y * y) - 1) / kDiscShrink;
  };
  expect_share(worst(2, sheared), 0.25);
  const auto layered = [](Draws& d) {
    const float radius = d.any_float(0.5, 2), offset = 0.6f;
    const Vec3 axis = rounded(direction(d)), c = point(d, 1e-3, 1e-2);
    const auto nearer = [&](float at, float along) {
      return double{at - std::fabs(radius) * (offset * along)} - at;
    };
    const double before = length({nearer(c.x, axis.x), nearer(c.y, axis.y), nearer(c.z, axis.z)}),
                 r = std::fabs(radius);
    const float drawn = std::fabs(radius) * (0.8f * (1 - kDiscRounding));
    return (drawn - std::sqrt(r * r - before * before)) / (0.8 * r * kDiscRounding) + 1;
  };
  expect_share(worst(6, layered), 0.147);
}

TEST(ErrorBounds, SpheresBeforeTheNearPlane) {
  const auto part_of = [](double least_radius, double most_radius) {
    return [=](Draws& d) {
      const glm::dvec3 n = direction(d);
      const double distance = d.between(-1, -0.01);
      const Vec4 row{static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z),
                     static_cast<float>(distance)};
      const Vec3 c = point(d, 0.01, 100);
      const float radius = static_cast<float>(d.between(least_radius, most_radius));
      const double reach = std::fabs(c.x) + std::fabs(c.y) + std::fabs(c.z);
      const double exact = n.x * c.x + n.y * c.y + n.z * c.z + distance;
      if (exact < 0) return 0.0;
      // A unit of the row need not be one of the image's.
      const double uncertain = radius * std::fabs(length({row.x, row.y, row.z}) - 1);
      return (std::fabs(dot_row(row, c) - exact) + uncertain) /
             (kSphereClearance * radius + kSphereReach * reach);
    };
  };
  expect_share(worst(8, part_of(0, 1e-9)), 0.244);
  expect_share(worst(8, part_of(1e5, 1e6)), 0.0005);
}

TEST(ErrorBounds, NearestOfSpheres) {
  const auto part = [](Draws& d) {
    const Seen s = seen(d, 1.5, 10, 1280, 720);
    const Vec4& w = s.rows.w;
    const Vec3 p = point_in(s, d.between(-1, 1), d.between(-1, 1), d.between(0.5, 50)),
               q = about_eye(s.rows, p);
    const float radius = static_cast<float>(d.between(0.01, 0.4)) * largest_of(q);
    const float reach = std::fabs(q.x) + (std::fabs(q.y) + std::fabs(q.z));
    const float w_length = std::sqrt(w.x * w.x + w.y * w.y + w.z * w.z);
    const glm::dvec3 row(glm::transpose(s.clip)[3]);
    const double exact = s.exact_clip(p).w - radius * length(row);
    const float grown = radius * (1 + kSphereGrowth) + reach * kSphereGrowth;
    const double growth = w_length * (double{radius} + reach) * double{kSphereGrowth};
    return (dot_row(w, q) - grown * w_length - exact + growth) / growth;
  };
  expect_share(worst(12, part), 0.25);
}

// Least and greatest X with (row - X·w)·c = ±r·|row - X·w|.
template <class Number>
std::array<Number, 2> roots(const std::array<Number, 3>& row, const std::array<Number, 3>& w,
                            const std::array<Number, 3>& c, Number r) {
  const auto dot3 = [](const auto& u, const auto& v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; };
  const Number at = dot3(row, c), depth = dot3(w, c), square = r * r;
  const Number ww = dot3(w, w), rw = dot3(row, w), rr = dot3(row, row);
  const std::array<Number, 3> n{depth * row[0] - at * w[0], depth * row[1] - at * w[1],
                                depth * row[2] - at * w[2]};
  const Number under = dot3(n, n) - square * std::max(Number{0}, rr * ww - rw * rw);
  const Number spread = r * std::sqrt(std::max(under, Number{0})), middle = at * depth - square * rw;
  const Number over = 1 / (depth * depth - square * ww);
  return {(middle - spread) * over, (middle + spread) * over};
}

TEST(ErrorBounds, RectanglesOfSpheres) {
  // Within `far` images' widths, and reaching that many pixels.
  const auto part_of = [](double far, double least_widest) {
    return [far, least_widest](Draws& d) {
      const Seen s = seen(d, 1.5, 10, 1024, 1024);
      const Vec3 p = point_in(s, d.between(-far, far), d.between(-far, far), d.between(0.5, 50)),
                 q = about_eye(s.rows, p);
      const float radius = static_cast<float>(1 - std::fabs(d.any_size(0.01, 1))) * dot_row(s.rows.w, q);
      const float reach = std::fabs(q.x) + (std::fabs(q.y) + std::fabs(q.z));
      const Vec4 &x = s.rows.x, &w = s.rows.w;
      const float grown = radius * (1 + kSphereGrowth) + reach * kSphereGrowth, depth = dot_row(w, q);
      if (!(depth - grown * std::sqrt(w.x * w.x + w.y * w.y + w.z * w.z) > kLeastClearance * depth))
        return 0.0;
      const auto found = roots<float>({x.x, x.y, x.z}, {w.x, w.y, w.z}, {q.x, q.y, q.z}, grown);
      const glm::dmat4 rows = glm::transpose(s.clip);
      const glm::dvec3 row = glm::dvec3(rows[0] + rows[3]) * 512.0, last(rows[3]),
                       c = to_double(p) - to_double(s.rows.eye_high) - to_double(s.rows.eye_low);
      const auto exact =
          roots<double>({row.x, row.y, row.z}, {last.x, last.y, last.z}, {c.x, c.y, c.z}, radius);
      const double widest = std::max(std::fabs(double{found[0]}), std::fabs(double{found[1]}));
      if (widest < least_widest) return 0.0;
      const double slack = kSphereSlack + kSphereSlackGrowth * widest;
      return (std::max(found[0] - exact[0], exact[1] - found[1]) + 1.0 / 256) / slack;
    };
  };
  expect_share(worst(12, part_of(1, 0)), 0.18);
  expect_share(worst(12, part_of(20, 8000)), 0.024);
}

}  // namespace
}  // namespace sightline
