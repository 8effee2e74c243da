#include <algorithm>
#include <array>
#include <cmath>

#include "workbench/oracle/pixel_rays.hpp"
#include "workbench/report/pictures.hpp"

namespace sightline::report {
namespace {

/// Hues by the golden angle, so that ids near each other look different.
std::array<float, 3> id_colour(ObjectId id) {
  const float hue = std::fmod(static_cast<float>(id % 100'000) * 0.61803399f, 1.0f);
  const float saturation = 0.45f + 0.12f * static_cast<float>(id % 3),
              value = 0.95f - 0.07f * static_cast<float>(id / 3 % 3);
  std::array<float, 3> rgb{};
  for (std::size_t c = 0; c < 3; ++c) {
    const float k = std::fmod(5 - 2 * static_cast<float>(c) + 6 * hue, 6.0f);
    rgb[c] = value * (1 - saturation * std::clamp(std::min(k, 4 - k), 0.0f, 1.0f));
  }
  return rgb;
}

class Shader {
public:
  Shader(const View& view, const oracle::ItemBuffer& truth) : truth_(truth), rays_(view) {}

  /// How squarely the surface faces the eye, from the places its neighbouring pixels show; 1 where alone.
  [[nodiscard]] float facing(std::uint32_t x, std::uint32_t y) const {
    const std::uint32_t left = same(x, y, x == 0 ? x : x - 1, y) ? x - 1 : x;
    const std::uint32_t right = same(x, y, x + 1, y) ? x + 1 : x;
    const std::uint32_t up = same(x, y, x, y == 0 ? y : y - 1) ? y - 1 : y;
    const std::uint32_t down = same(x, y, x, y + 1) ? y + 1 : y;
    if (left == right || up == down) return 0.8f;
    const glm::dvec3 normal = glm::cross(place(right, y) - place(left, y), place(x, down) - place(x, up));
    const double length = glm::length(normal);
    if (!(length > 0)) return 0.8f;
    return static_cast<float>(std::fabs(glm::dot(normal, rays_.through(x, y).direction)) / length);
  }

private:
  [[nodiscard]] bool same(std::uint32_t x, std::uint32_t y, std::uint32_t nx, std::uint32_t ny) const {
    if ((nx == x && ny == y) || nx >= truth_.width || ny >= truth_.height) return false;
    return truth_.ids[std::size_t{ny} * truth_.width + nx] == truth_.ids[std::size_t{y} * truth_.width + x];
  }
  [[nodiscard]] glm::dvec3 place(std::uint32_t x, std::uint32_t y) const {
    const oracle::PixelRay ray = rays_.through(x, y);
    return ray.origin + double{truth_.distances[std::size_t{y} * truth_.width + x]} * ray.direction;
  }

  const oracle::ItemBuffer& truth_;
  oracle::PixelRays rays_;
};

}  // namespace

Canvas draw_item_buffer(const View& view, const oracle::ItemBuffer& truth) {
  Canvas canvas(truth.width, truth.height);
  const Shader shader(view, truth);
  for (std::uint32_t y = 0; y < truth.height; ++y) {
    for (std::uint32_t x = 0; x < truth.width; ++x) {
      const ObjectId id = truth.ids[std::size_t{y} * truth.width + x];
      if (id == kNoObject) continue;
      const float light = 0.45f + 0.55f * shader.facing(x, y);
      const std::array<float, 3> rgb = id_colour(id);
      const auto byte = [&](float c) {
        return static_cast<std::uint8_t>(std::lround(255 * std::min(1.0f, c * light)));
      };
      canvas.set(x, y, {byte(rgb[0]), byte(rgb[1]), byte(rgb[2]), 255});
    }
  }
  return canvas.halved();
}

}  // namespace sightline::report
