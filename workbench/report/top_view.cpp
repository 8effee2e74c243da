#include "workbench/report/top_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "workbench/oracle/pixel_rays.hpp"
#include "workbench/report/pictures.hpp"

namespace sightline::report {
namespace {

constexpr const char* kFrustum = "#606876";
// A drawing's units are quarters of a pixel, so that short whole numbers say where things are.
constexpr int kUnits = 4;
// Boxes of one outcome that a picture holds at most: below 1 MB.
constexpr std::size_t kMostBoxes = 50'000;

struct Point {
  float x, y;
};

/// From metres on x–z to a drawing's units.
class Map {
public:
  Map(const Box& world, const Vec3& eye, std::uint32_t width) {
    Box shown = world;
    shown.min.x = std::min(shown.min.x, eye.x), shown.max.x = std::max(shown.max.x, eye.x);
    shown.min.z = std::min(shown.min.z, eye.z), shown.max.z = std::max(shown.max.z, eye.z);
    const float side = std::max({shown.max.x - shown.min.x, shown.max.z - shown.min.z, 1e-3f});
    const float margin = 0.03f * side;
    min_x_ = shown.min.x - margin, min_z_ = shown.min.z - margin;
    const float across = shown.max.x + margin - min_x_, down = shown.max.z + margin - min_z_;
    scale_ = std::min(static_cast<float>(width) / across, 0.8f * static_cast<float>(width) / down);
    width_ = std::max(2u, static_cast<std::uint32_t>(std::ceil(across * scale_)));
    height_ = std::max(2u, static_cast<std::uint32_t>(std::ceil(down * scale_)));
  }
  [[nodiscard]] Point operator()(double x, double z) const {
    return {static_cast<float>((x - double{min_x_}) * double{scale_}),
            static_cast<float>((z - double{min_z_}) * double{scale_})};
  }
  [[nodiscard]] std::uint32_t width() const noexcept { return width_; }
  [[nodiscard]] std::uint32_t height() const noexcept { return height_; }
  [[nodiscard]] double reach() const noexcept {
    return static_cast<double>(width_ + height_) / double{scale_};
  }

private:
  float min_x_, min_z_, scale_;
  std::uint32_t width_, height_;
};

/// Convex hull, Andrew 1979.
std::vector<Point> hull_of(std::vector<Point> points) {
  std::sort(points.begin(), points.end(),
            [](const Point& a, const Point& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  const auto turns_left = [](const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0;
  };
  std::vector<Point> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t start = hull.size();
    for (const Point& p : points) {
      while (hull.size() >= start + 2 && !turns_left(hull[hull.size() - 2], hull.back(), p)) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

std::string frustum_svg(const Map& map, const View& view) {
  const oracle::PixelRays rays(view);
  std::vector<Point> corners;
  for (const auto& [x, y] :
       {std::pair{0u, 0u}, {view.width - 1, 0u}, {0u, view.height - 1}, {view.width - 1, view.height - 1}}) {
    const oracle::PixelRay ray = rays.through(x, y);
    const glm::dvec3 end = ray.origin + std::min(ray.length, map.reach()) * ray.direction;
    corners.push_back(map(ray.origin.x, ray.origin.z));
    corners.push_back(map(end.x, end.z));
  }
  std::string points;
  for (const Point& p : hull_of(std::move(corners))) points += fmt::format("{:.0f},{:.0f} ", p.x, p.y);
  return fmt::format(R"(<polygon points="{}" fill="none" stroke="{}" stroke-width="{}"/>)", points, kFrustum,
                     2.5 * kUnits);
}

std::string eye_svg(const Map& map, const View& view) {
  const Vec3 eye = eye_position(view), direction = view_direction(view);
  const Point at = map(eye.x, eye.z);
  const float length = std::hypot(direction.x, direction.z), size = 0.045f * static_cast<float>(map.width());
  std::string svg;
  if (length > 0.1f) {
    svg = fmt::format(R"(<path d="M{:.0f} {:.0f}l{:.0f} {:.0f}" stroke="{}" stroke-width="{}"/>)", at.x, at.y,
                      size * direction.x / length, size * direction.z / length, kFrustum, 3 * kUnits);
  }
  return svg + fmt::format(R"(<circle cx="{:.0f}" cy="{:.0f}" r="{}" fill="#1e2228" stroke="#fff" )"
                           R"(stroke-width="{}"/>)",
                           at.x, at.y, 8 * kUnits, 2.5 * kUnits);
}

// The share of the picture that a box covers. Ground is drawn beneath all that stands on it; what covers much
// of the world, such as a sky, would hide the rest, and its outline has to do.
enum Size : std::uint8_t { ground, small, outlined };
constexpr double kGround = 1.0 / 400, kOutlined = 0.1;

// By outcome and size.
using SortedBoxes = std::array<std::array<std::vector<FlatBox>, 3>, kOutcomes>;

SortedBoxes sort_boxes(const Map& map, const Boxes& bounds, const std::vector<Outcome>& outcomes) {
  SortedBoxes sorted;
  const double whole = static_cast<double>(map.width()) * map.height();
  for (ObjectId object = 0; object < bounds.size(); ++object) {
    const Point low = map(bounds[object].min.x, bounds[object].min.z),
                high = map(bounds[object].max.x, bounds[object].max.z);
    const double share = (double{high.x} - low.x) * (double{high.y} - low.y) / whole;
    const Size size = share > kOutlined ? outlined : share > kGround ? ground : small;
    sorted[static_cast<std::size_t>(outcomes[object])][size].push_back(
        {static_cast<std::int32_t>(std::lround(low.x)), static_cast<std::int32_t>(std::lround(low.y)),
         static_cast<std::int32_t>(std::lround(high.x)), static_cast<std::int32_t>(std::lround(high.y))});
  }
  return sorted;
}

std::string boxes_svg(std::vector<FlatBox> boxes, Outcome outcome, Size size) {
  if (boxes.empty()) return {};
  const bool culled = outcome == Outcome::culled;
  const Colour c = outcome_colour(outcome);
  const int edge = kUnits * (outcome == Outcome::lost ? 2 : 1);
  const std::string colour = fmt::format("#{:02x}{:02x}{:02x}", c.r, c.g, c.b);
  const std::string path = path_of(std::move(boxes), kMostBoxes);
  if (size == outlined) {
    return fmt::format(R"(<path fill="none" stroke="{}" stroke-opacity="{}" stroke-width="{}" d="{}"/>)",
                       colour, culled ? 0.35 : 1, edge, path);
  }
  const std::string name =
      fmt::format("{}{}", size == ground ? "ground-" : "small-", static_cast<unsigned>(outcome));
  // On the page's own colour, which hides what was drawn before: no two outcomes blend into a third colour.
  return fmt::format(R"(<g fill="Canvas" stroke="Canvas" stroke-width="{0}"><path id="{1}" d="{2}"/></g>)"
                     R"(<use href="#{1}" fill="{3}" stroke="{3}" fill-opacity="{4}" stroke-opacity="{5}" )"
                     R"(stroke-width="{0}"/>)",
                     edge, name, path, colour, culled ? 0.1 : 0.55, culled ? 0.35 : 1);
}

}  // namespace

Colour outcome_colour(Outcome outcome) noexcept {
  switch (outcome) {
    case Outcome::culled:
      return {148, 156, 168, 255};
    case Outcome::excess:
      return {226, 158, 38, 255};
    case Outcome::visible:
      return {32, 132, 208, 255};
    case Outcome::lost:
      return {222, 38, 92, 255};
  }
  return {};
}

std::string path_of(std::vector<FlatBox> boxes, std::size_t most) {
  const auto sort = [&] {
    std::ranges::sort(boxes);
    boxes.erase(std::unique(boxes.begin(), boxes.end()), boxes.end());
  };
  sort();
  for (std::int32_t grid = 2; boxes.size() > most && grid < 1 << 20; grid *= 2) {
    for (FlatBox& box : boxes) {
      box.x0 -= box.x0 & (grid - 1), box.y0 -= box.y0 & (grid - 1);
      box.x1 += -box.x1 & (grid - 1), box.y1 += -box.y1 & (grid - 1);
    }
    sort();
  }
  std::string path;
  std::int32_t x = 0, y = 0;
  for (const FlatBox& box : boxes) {
    const std::int32_t width = std::max(1, box.x1 - box.x0), height = std::max(1, box.y1 - box.y0);
    fmt::format_to(std::back_inserter(path), "m{} {}h{}v{}h{}z", box.x0 - x, box.y0 - y, width, height,
                   -width);
    x = box.x0, y = box.y0;
  }
  return path;
}

std::string draw_top_view(const Scene& scene, const Snapshot& snapshot, const Snapshot::Method& method,
                          std::uint32_t width) {
  const Map map(extent(scene), eye_position(snapshot.view), kUnits * width);
  std::string svg =
      fmt::format(R"(<svg xmlns="http://www.w3.org/2000/svg" width="{}" height="{}" viewBox="0 0 {} {}" )"
                  R"(style="color-scheme:light dark">)",
                  map.width() / kUnits, map.height() / kUnits, map.width(), map.height());
  SortedBoxes sorted = sort_boxes(map, scene.bounds, method.outcomes);
  // The rarer and graver the outcome, the later it is drawn, and so on top.
  for (const Size size : {ground, small, outlined}) {
    for (const Outcome outcome : {Outcome::culled, Outcome::excess, Outcome::visible, Outcome::lost})
      svg += boxes_svg(std::move(sorted[static_cast<std::size_t>(outcome)][size]), outcome, size);
  }
  return svg + frustum_svg(map, snapshot.view) + eye_svg(map, snapshot.view) + "</svg>\n";
}

}  // namespace sightline::report
