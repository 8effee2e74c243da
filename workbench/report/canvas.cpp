#include "workbench/report/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <sightline/workbench/error.hpp>

#include "workbench/io/text_file.hpp"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wsign-compare"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace sightline::report {

Canvas::Canvas(std::uint32_t width, std::uint32_t height)
    : width_(width), height_(height), pixels_(std::size_t{width} * height, Colour{0, 0, 0, 0}) {}

void Canvas::blend(std::int64_t x, std::int64_t y, Colour over) noexcept {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
  Colour& under = pixels_[static_cast<std::size_t>(y) * width_ + static_cast<std::size_t>(x)];
  const float a = static_cast<float>(over.a) / 255, b = static_cast<float>(under.a) / 255 * (1 - a),
              sum = a + b;
  if (sum <= 0) return;
  const auto mix = [&](std::uint8_t o, std::uint8_t u) {
    return static_cast<std::uint8_t>(
        std::lround((static_cast<float>(o) * a + static_cast<float>(u) * b) / sum));
  };
  under = {mix(over.r, under.r), mix(over.g, under.g), mix(over.b, under.b),
           static_cast<std::uint8_t>(std::lround(sum * 255))};
}

void Canvas::fill_rectangle(float min_x, float min_y, float max_x, float max_y, Colour colour) {
  const auto clipped = [](float value, std::uint32_t limit) {
    return static_cast<std::int64_t>(std::floor(std::clamp(value, 0.0f, static_cast<float>(limit))));
  };
  // Never thinner than a pixel, so that small things do not vanish.
  const std::int64_t x0 = clipped(min_x, width_), x1 = std::max(x0 + 1, clipped(max_x, width_));
  const std::int64_t y0 = clipped(min_y, height_), y1 = std::max(y0 + 1, clipped(max_y, height_));
  if (max_x < 0 || max_y < 0 || min_x > static_cast<float>(width_) || min_y > static_cast<float>(height_))
    return;
  for (std::int64_t y = y0; y < y1; ++y) {
    for (std::int64_t x = x0; x < x1; ++x) blend(x, y, colour);
  }
}

void Canvas::outline_rectangle(float min_x, float min_y, float max_x, float max_y, float t, Colour colour) {
  if (max_x - min_x <= 2 * t || max_y - min_y <= 2 * t)
    return fill_rectangle(min_x, min_y, max_x, max_y, colour);
  fill_rectangle(min_x, min_y, max_x, min_y + t, colour);
  fill_rectangle(min_x, max_y - t, max_x, max_y, colour);
  fill_rectangle(min_x, min_y + t, min_x + t, max_y - t, colour);
  fill_rectangle(max_x - t, min_y + t, max_x, max_y - t, colour);
}

void Canvas::line(float x0, float y0, float x1, float y1, float thickness, Colour colour) {
  const float length_squared = (x1 - x0) * (x1 - x0) + (y1 - y0) * (y1 - y0), half = 0.5f * thickness;
  const auto low = [&](float a, float b) {
    return static_cast<std::int64_t>(std::max(0.0f, std::min(a, b) - half));
  };
  const auto high = [&](float a, float b, std::uint32_t limit) {
    return static_cast<std::int64_t>(std::min(static_cast<float>(limit), std::max(a, b) + half + 1));
  };
  for (std::int64_t y = low(y0, y1); y < high(y0, y1, height_); ++y) {
    for (std::int64_t x = low(x0, x1); x < high(x0, x1, width_); ++x) {
      const float px = static_cast<float>(x) + 0.5f - x0, py = static_cast<float>(y) + 0.5f - y0;
      const float t =
          length_squared > 0 ? std::clamp((px * (x1 - x0) + py * (y1 - y0)) / length_squared, 0.0f, 1.0f) : 0;
      if (std::hypot(px - t * (x1 - x0), py - t * (y1 - y0)) <= half) blend(x, y, colour);
    }
  }
}

void Canvas::disc(float x, float y, float radius, Colour colour) {
  line(x, y, x, y, 2 * radius, colour);
}

Canvas Canvas::halved() const {
  Canvas half(std::max(1u, width_ / 2), std::max(1u, height_ / 2));
  for (std::uint32_t y = 0; y < half.height_; ++y) {
    for (std::uint32_t x = 0; x < half.width_; ++x) {
      std::uint32_t r = 0, g = 0, b = 0, a = 0;
      for (std::uint32_t i = 0; i < 4; ++i) {
        const Colour c = at(std::min(2 * x + i % 2, width_ - 1), std::min(2 * y + i / 2, height_ - 1));
        r += c.r * c.a, g += c.g * c.a, b += c.b * c.a, a += c.a;
      }
      const auto mean = [&](std::uint32_t sum) {
        return static_cast<std::uint8_t>(a == 0 ? 0 : (sum + a / 2) / a);
      };
      half.set(x, y, {mean(r), mean(g), mean(b), static_cast<std::uint8_t>((a + 2) / 4)});
    }
  }
  return half;
}

void Canvas::write_png(const std::filesystem::path& file) const {
  std::string bytes;
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data),
                                               static_cast<std::size_t>(size));
  };
  const int stride = static_cast<int>(width_ * sizeof(Colour));
  if (stbi_write_png_to_func(append, &bytes, static_cast<int>(width_), static_cast<int>(height_), 4,
                             pixels_.data(), stride) == 0) {
    throw Error(file.string() + ": the picture could not be packed as PNG");
  }
  io::write_file(file, bytes);
}

}  // namespace sightline::report
