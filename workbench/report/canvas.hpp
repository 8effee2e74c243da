// A small picture to draw on, with see-through colours; written as PNG.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace sightline::report {

struct Colour {
  std::uint8_t r = 0, g = 0, b = 0, a = 255;
};

/// Coordinates are in pixels, x right, y down; what lies outside is cut off.
class Canvas {
public:
  Canvas(std::uint32_t width, std::uint32_t height);

  [[nodiscard]] std::uint32_t width() const noexcept { return width_; }
  [[nodiscard]] std::uint32_t height() const noexcept { return height_; }
  void set(std::uint32_t x, std::uint32_t y, Colour colour) noexcept {
    pixels_[std::size_t{y} * width_ + x] = colour;
  }
  [[nodiscard]] Colour at(std::uint32_t x, std::uint32_t y) const noexcept {
    return pixels_[std::size_t{y} * width_ + x];
  }

  void fill_rectangle(float min_x, float min_y, float max_x, float max_y, Colour colour);
  void outline_rectangle(float min_x, float min_y, float max_x, float max_y, float thickness, Colour colour);
  void line(float x0, float y0, float x1, float y1, float thickness, Colour colour);
  void disc(float x, float y, float radius, Colour colour);

  /// Half the size, each pixel the mean of four: what was drawn at twice the size comes out smooth.
  [[nodiscard]] Canvas halved() const;
  /// Throws Error where it cannot be written.
  void write_png(const std::filesystem::path& file) const;

private:
  void blend(std::int64_t x, std::int64_t y, Colour colour) noexcept;

  std::uint32_t width_, height_;
  std::vector<Colour> pixels_;  ///< straight alpha
};

}  // namespace sightline::report
