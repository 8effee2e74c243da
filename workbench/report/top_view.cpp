#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "workbench/oracle/pixel_rays.hpp"
#include "workbench/report/pictures.hpp"

namespace sightline::report {
namespace {

constexpr Colour kFrustum{96, 104, 118, 255};

struct Point {
  float x, y;
};

/// From metres on x–z to pixels.
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

void draw_frustum(const Map& map, const View& view, Canvas& canvas) {
  const oracle::PixelRays rays(view);
  std::vector<Point> corners;
  for (const auto& [x, y] :
       {std::pair{0u, 0u}, {view.width - 1, 0u}, {0u, view.height - 1}, {view.width - 1, view.height - 1}}) {
    const oracle::PixelRay ray = rays.through(x, y);
    const glm::dvec3 end = ray.origin + std::min(ray.length, map.reach()) * ray.direction;
    corners.push_back(map(ray.origin.x, ray.origin.z));
    corners.push_back(map(end.x, end.z));
  }
  const std::vector<Point> hull = hull_of(std::move(corners));
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Point &a = hull[i], &b = hull[(i + 1) % hull.size()];
    canvas.line(a.x, a.y, b.x, b.y, 5, kFrustum);
  }
}

void draw_eye(const Map& map, const Snapshot& snapshot, Canvas& canvas) {
  const Vec3 eye = eye_position(snapshot.view), direction = view_direction(snapshot.view);
  const Point at = map(eye.x, eye.z);
  const float length = std::hypot(direction.x, direction.z),
              size = 0.045f * static_cast<float>(canvas.width());
  if (length > 0.1f) {
    canvas.line(at.x, at.y, at.x + size * direction.x / length, at.y + size * direction.z / length, 6,
                kFrustum);
  }
  canvas.disc(at.x, at.y, 18, {255, 255, 255, 255});
  canvas.disc(at.x, at.y, 13, {30, 34, 40, 255});
}

Colour faded(Colour colour, std::uint8_t alpha) {
  colour.a = alpha;
  return colour;
}

void draw_object(const Map& map, const Box& box, Fate fate, Canvas& canvas) {
  const Point low = map(box.min.x, box.min.z), high = map(box.max.x, box.max.z);
  const Colour colour = fate_colour(fate);
  const float area = (high.x - low.x) * (high.y - low.y),
              whole = static_cast<float>(canvas.width()) * static_cast<float>(canvas.height());
  // What covers much of the world, such as a sky, would hide the rest.
  const bool wide = area > 0.1f * whole;
  const std::uint8_t fill = fate == Fate::culled ? 26 : fate == Fate::excess ? 70 : 120;
  const std::uint8_t edge = fate == Fate::culled ? 90 : fate == Fate::excess ? 170 : 255;
  if (!wide) canvas.fill_rectangle(low.x, low.y, high.x, high.y, faded(colour, fill));
  const float thickness = fate == Fate::lost ? 4 : 2;
  canvas.outline_rectangle(low.x, low.y, high.x, high.y, thickness, faded(colour, edge));
}

}  // namespace

Colour fate_colour(Fate fate) noexcept {
  switch (fate) {
    case Fate::culled:
      return {148, 156, 168, 255};
    case Fate::excess:
      return {226, 158, 38, 255};
    case Fate::visible:
      return {32, 132, 208, 255};
    case Fate::lost:
      return {222, 38, 92, 255};
  }
  return {};
}

Canvas draw_top_view(const Scene& scene, const Snapshot& snapshot, const Snapshot::Method& method,
                     std::uint32_t width) {
  const Map map(extent(scene), eye_position(snapshot.view), 2 * width);
  Canvas canvas(map.width(), map.height());
  // The rarer and graver the fate, the later it is drawn, and so on top.
  for (const Fate fate : {Fate::culled, Fate::excess, Fate::visible, Fate::lost}) {
    for (ObjectId object = 0; object < scene.size(); ++object) {
      if (method.fates[object] == fate) draw_object(map, scene.bounds[object], fate, canvas);
    }
  }
  draw_frustum(map, snapshot.view, canvas);
  draw_eye(map, snapshot, canvas);
  return canvas.halved();
}

}  // namespace sightline::report
