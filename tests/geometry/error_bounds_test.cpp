// Each bound of planes, projections and outlines against the worst case that a search finds.
#include "geometry/rounding.hpp"

#include <array>

#include <sightline/projection.hpp>

namespace sightline {
namespace {

using namespace test;

TEST(ErrorBounds, Planes) {
  const auto part = [](Draws& d) {
    const glm::dvec3 n = direction(d);
    const Vec3 p = point(d, 1e-4, 1e4);
    const double distance = d.any_size(1e-4, 1e4);
    const Plane plane{rounded(n), static_cast<float>(distance)};
    const double exact = n.x * p.x + n.y * p.y + n.z * p.z + distance;
    const double magnitude =
        std::fabs(n.x * p.x) + std::fabs(n.y * p.y) + std::fabs(n.z * p.z) + std::fabs(distance);
    return std::fabs(signed_distance(plane, p.x, p.y, p.z) - exact) / (kPlaneRounding * magnitude);
  };
  expect_share(worst(7, part), 0.6);
}

// How much too deep a sphere's centre seems behind a plane that touches it, of the growth of its radius.
TEST(ErrorBounds, RadiusGrowth) {
  const auto part = [](Draws& d) {
    const glm::dvec3 n = direction(d);
    const float radius = d.any_float(1e-3, 1e3);
    const Vec3 centre = rounded(n * -std::fabs(double{radius}));
    const double depth = -(n.x * centre.x + n.y * centre.y + n.z * centre.z);
    const double seems = -double{signed_distance({rounded(n), 0}, centre.x, centre.y, centre.z)};
    return (seems - depth) / ((double{kRadiusGrowth} - 1 - 0x1p-24) * depth);
  };
  expect_share(worst(3, part), 0.4);
}

TEST(ErrorBounds, SplitsKeepTheDigitsThatRoundingDrops) {
  const auto lost = [](Draws& d) {
    const glm::dvec3 v(d.any_size(1e-3, 1e6), d.any_size(1e-3, 1e6), d.any_size(1e-3, 1e6));
    const Split s = split(v);
    double most = 0;
    for (int a = 0; a < 3; ++a)
      most =
          std::max(most, std::fabs(to_double(s.rounded)[a] + to_double(s.rest)[a] - v[a]) / std::fabs(v[a]));
    return most / 0x1p-48;
  };
  EXPECT_LE(worst(3, lost), 1);
}

TEST(ErrorBounds, ProjectorRows) {
  const auto part = [](Draws& d) {
    const Seen s = seen(d, 2, 100, 1280, 720);
    const Vec3 p = point(d, 0.01, 100);
    const Projector projector = make_projector(s.view, {p, p});
    const glm::dvec4 exact = s.clip * glm::dvec4(to_double(p), 1);
    double most = 0;
    for (const int r : {0, 1, 3}) most = std::max(most, std::fabs(dot_row(projector.rows[r], p) - exact[r]));
    return most / projector.coordinate_error;
  };
  expect_share(worst(12, part), 0.37);
}

TEST(ErrorBounds, SubpixelSlack) {
  const auto part = [](Draws& d) {
    const float width = 16384, x = static_cast<float>(d.between(-1, 1)), slack = d.any_float(0.001, 1);
    const double exact = (static_cast<double>(x) + 1) * 0.5 * width - slack;
    const double mapping = std::fabs(((x + 1) * 0.5f * width - slack) - exact);
    return (mapping + 1.0 / 256) / kSubpixelSlack;
  };
  expect_share(worst(2, part), 0.63);
}

TEST(ErrorBounds, AreasOnTheImage) {
  const auto part = [](Draws& d) {
    std::array<float, 3> x, y;
    for (std::size_t k = 0; k < 3; ++k)
      x[k] = d.any_float(1, kFarthestPlace), y[k] = d.any_float(1, kFarthestPlace);
    const auto area = [&](auto zero) {
      using T = decltype(zero);
      const T ux = T{x[1]} - T{x[0]}, uy = T{y[1]} - T{y[0]}, vx = T{x[2]} - T{x[0]}, vy = T{y[2]} - T{y[0]};
      return static_cast<double>(ux * vy - vx * uy);
    };
    double widest = 0;
    for (std::size_t k = 0; k < 3; ++k) widest = std::max<double>({widest, std::fabs(x[k]), std::fabs(y[k])});
    const auto [left, right] = std::minmax({x[0], x[1], x[2]});
    const auto [top, bottom] = std::minmax({y[0], y[1], y[2]});
    const double girth = (double{right} - left) + (double{bottom} - top);
    return std::fabs(area(0.0f) - area(0.0)) / (kAreaRounding * kInsetGrowth * widest * girth);
  };
  expect_share(worst(6, part), 0.3);
}

TEST(ErrorBounds, AreaGrowth) {
  const auto part = [](Draws& d) {
    const Seen s = seen(d, 2, 100, 1280, 720);
    const Projector projector = make_projector(s.view, {});
    const Sphere sphere{point(d, 0.01, 100), static_cast<float>(d.between(0.01, 30))};
    const glm::dvec3 eye = to_double(projector.eye), to = to_double(sphere.centre) - eye;
    const double distance = length(to), sine = sphere.radius / distance;
    const glm::dvec3 forward(-s.view.world_to_eye.m[2], -s.view.world_to_eye.m[6],
                             -s.view.world_to_eye.m[10]);
    const double cos_axis = glm::dot(forward, to) / distance;
    const double product = cos_axis * cos_axis - sine * sine;
    if (!(sine < 0.5 && cos_axis > 0 && product > 0.25) || distance < 0.1 * length(eye)) return 0.0;
    const double exact = 3.141592653589793 * std::pow(projector.pixels_per_metre * sine, 2) *
                         std::sqrt(1 - sine * sine) / (product * std::sqrt(product));
    return (exact / static_cast<double>(projected_area_bound(projector, sphere)) - 1 + kAreaGrowth) /
           kAreaGrowth;
  };
  expect_share(worst(12, part), 0.9);
}

TEST(ErrorBounds, HalfSizes) {
  const auto part = [](Draws& d) {
    const float a = d.any_float(0.5, 100), b = d.any_float(0.5, 100), low = std::min(a, b),
                high = std::max(a, b);
    const float middle = 0.5f * low + 0.5f * high, magnitude = std::fabs(low) + std::fabs(high);
    const float half = std::max(high - middle, middle - low) + kHalfSizeRounding * magnitude;
    const double beyond = std::max<double>(double{high} - (middle + half), (middle - half) - double{low});
    return (beyond + kHalfSizeRounding * double{magnitude}) / (kHalfSizeRounding * double{magnitude});
  };
  expect_share(worst(2, part), 0.33);
}

TEST(ErrorBounds, SectorPlanes) {
  const auto part = [](Draws& d) {
    const glm::dvec3 n = direction(d);
    const Vec3 p = point(d, 1e-4, 1e4);
    const double distance = d.any_size(1e-4, 1e4);
    const double magnitude =
        std::fabs(n.x * p.x) + std::fabs(n.y * p.y) + std::fabs(n.z * p.z) + std::fabs(distance);
    const Plane moved{rounded(n), static_cast<float>(distance + kPlaneRounding * magnitude)};
    const double exact = n.x * p.x + n.y * p.y + n.z * p.z + distance;
    return (signed_distance(moved, p.x, p.y, p.z) - exact) / (kSectorRounding * magnitude);
  };
  expect_share(worst(7, part), 0.4);
}

TEST(ErrorBounds, SectorPlanesInDoublePrecision) {
  const auto part = [](Draws& d) {
    const Seen s = seen(d, 2, 100, 1280, 720);
    const glm::dmat4 a = to_double(s.view.eye_to_clip), b = to_double(s.view.world_to_eye);
    const glm::dvec3 p(d.any_size(1, 1e11), d.any_size(1, 1e11), d.any_size(1, 1e11));
    // The left plane's row, and what its products add up to.
    std::array<long double, 4> row{};
    std::array<double, 4> rounded{}, size{};
    for (int c = 0; c < 4; ++c) {
      for (int k = 0; k < 4; ++k) {
        row[c] += (static_cast<long double>(a[k][3]) + a[k][0]) * b[c][k];
        size[c] += (std::fabs(a[k][3]) + std::fabs(a[k][0])) * std::fabs(b[c][k]);
      }
      rounded[c] = s.clip[c][3] + s.clip[c][0];
    }
    const double unit = length({rounded[0], rounded[1], rounded[2]});
    for (double& r : rounded) r /= unit;
    const double value = rounded[0] * p.x + rounded[1] * p.y + rounded[2] * p.z + rounded[3];
    const auto exact =
        static_cast<double>(value - (row[0] * p.x + row[1] * p.y + row[2] * p.z + row[3]) / unit);
    const double products =
        (size[0] * std::fabs(p.x) + size[1] * std::fabs(p.y) + size[2] * std::fabs(p.z) + size[3]) / unit;
    return std::fabs(exact) / (kSectorDoubleRounding * products);
  };
  expect_share(worst(12, part), 0.037);
}

// --- points on the image ---

TEST(ErrorBounds, RowsAboutTheEye) {
  const auto part = [](Draws& d) {
    const Seen s = seen(d, 2, 100, 1280, 720);
    const Vec3 p = point(d, 0.01, 100), q = about_eye(s.rows, p);
    if (largest_of(q) < 0.01f) return 0.0;  // the exact value's own rounding would show
    const glm::dvec4 c = s.exact_clip(p);
    const auto share = [&](const Vec4& row, double exact) {
      const double magnitude =
          std::fabs(row.x * q.x) + std::fabs(row.y * q.y) + std::fabs(row.z * q.z) + std::fabs(row.w);
      return std::fabs(dot_row(row, q) - exact) / (kRowRounding * magnitude);
    };
    return std::max(share(s.rows.x, (c.x + c.w) * 0.5 * s.view.width), share(s.rows.w, c.w));
  };
  expect_share(worst(12, part), 0.27);
}

TEST(ErrorBounds, Reciprocals) {
  const auto part = [](Draws& d) {
    const float w = d.any_float(1, 2), error = kRowRounding * std::fabs(w);
    const float nearness = 1 / (w - error) * (1 + kReciprocalRounding);
    const double exact = 1 / (double{w} - double{error});
    return (exact / nearness - 1 + kReciprocalRounding) / kReciprocalRounding;
  };
  expect_share(worst(1, part), 0.18);
}

// An edge between points within `far` images around the image, as the rasters compute it and as it is.
struct Edge {
  std::array<FloatPixel, 2> ends{};
  std::array<ExactPixel, 2> exact{};
  float slope, at, widest;

  Edge(const Seen& s, Draws& d, double far) {
    for (std::size_t k = 0; k < 2; ++k) {
      const Vec3 p = point_in(s, d.between(-far, far), d.between(-far, far), d.between(0.1, 100));
      ends[k] = float_pixel(s.rows, about_eye(s.rows, p)), exact[k] = exact_pixel(s, p);
    }
    const auto& [a, b] = ends;
    slope = (b.x - a.x) / (b.y - a.y), at = a.x - a.y * slope;
    widest = std::max({std::fabs(a.x), std::fabs(a.y), std::fabs(b.x), std::fabs(b.y)});
  }
  [[nodiscard]] double inset() const { return kInset + kInsetGrowth * double{widest}; }
};

TEST(ErrorBounds, Insets) {
  // What the ends' places need, and the edge's place at a row between them.
  const auto beside = [](Draws& d) {
    const Edge edge(seen(d, 1.2, 100, 8192, 8192), d, 2);
    const auto& [a, b] = edge.ends;
    if (!(std::fabs(b.y - a.y) >= kFlatEdge)) return 0.0;
    double moved = 0;
    for (int k = 0; k < 2; ++k) {
      moved = std::max(
          {moved, std::fabs(edge.ends[k].x - edge.exact[k].x), std::fabs(edge.ends[k].y - edge.exact[k].y)});
    }
    const float y = static_cast<float>(d.between(std::min(a.y, b.y), std::max(a.y, b.y)));
    const double x = a.x + (double{y} - a.y) * (double{b.x} - a.x) / (double{b.y} - a.y);
    return (std::fabs(edge.at + edge.slope * y - x) / (1 + std::fabs(edge.slope)) + moved) / edge.inset();
  };
  expect_share(worst(14, beside), 0.33);
  // Of ends far off what shows within the image.
  const auto across = [](Draws& d) {
    const Edge edge(seen(d, 1.2, 100, 8192, 8192), d, 1000);
    const auto& [a, b] = edge.exact;
    const float y = static_cast<float>(d.between(0, 8192));
    const double x = a.x + (y - a.y) * (b.x - a.x) / (b.y - a.y);
    if (!(x >= 0 && x <= 8192 && (y - a.y) * (y - b.y) < 0)) return 0.0;
    return std::fabs(edge.at + edge.slope * y - x) / (1 + std::fabs(edge.slope)) / edge.inset();
  };
  expect_share(worst(14, across), 0.07);
}

}  // namespace
}  // namespace sightline
