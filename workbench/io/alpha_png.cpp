#include "workbench/io/alpha_png.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include <fmt/format.h>
#include <png.h>

#include <sightline/workbench/error.hpp>

namespace sightline::io {

namespace {

/// libpng's own reader and writer of whole images, which keep its jumps to themselves.
class PngImage {
public:
  PngImage() { image.version = PNG_IMAGE_VERSION; }
  ~PngImage() { png_image_free(&image); }
  PngImage(const PngImage&) = delete;
  PngImage& operator=(const PngImage&) = delete;
  [[noreturn]] void fail(const char* does) {
    image.message[sizeof image.message - 1] = '\0';
    throw Error(fmt::format("{}: {}", does, image.message));
  }

  png_image image{};
};

bool begins_with(Bytes bytes, std::span<const unsigned char> start) noexcept {
  return bytes.size() >= start.size() && std::memcmp(bytes.data(), start.data(), start.size()) == 0;
}

}  // namespace

bool is_png(Bytes bytes) noexcept {
  static constexpr std::array<unsigned char, 8> kStart{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  return begins_with(bytes, kStart);
}

bool is_jpeg(Bytes bytes) noexcept {
  static constexpr std::array<unsigned char, 3> kStart{0xff, 0xd8, 0xff};
  return begins_with(bytes, kStart);
}

void PixelBudget::take(std::uint64_t pixels) {
  if (pixels > left_) throw Error("brings all images together over 128 million pixels");
  left_ -= pixels;
}

std::optional<AlphaImage> read_alpha(Bytes bytes, PixelBudget& budget) {
  if (is_jpeg(bytes)) return {};
  if (!is_png(bytes)) throw Error("is neither a PNG nor a JPEG");
  PngImage png;
  if (png_image_begin_read_from_memory(&png.image, bytes.data(), bytes.size()) == 0)
    png.fail("is no whole PNG");
  const std::uint32_t width = png.image.width, height = png.image.height;
  // Deflate cannot do better than 1032 : 1, nor a pixel with less than a bit.
  const std::uint64_t pixels = std::uint64_t{width} * height,
                      credible = 8 * 1032 * std::uint64_t{bytes.size()};
  if (std::max(width, height) > kMaxImageSide || pixels > kMaxImagePixels || pixels > credible) {
    throw Error(
        fmt::format("has {} x {} pixels in {} bytes, expected at most {} a side and 64 million in all", width,
                    height, bytes.size(), kMaxImageSide));
  }
  if ((png.image.format & PNG_FORMAT_FLAG_ALPHA) == 0) return {};
  budget.take(pixels);
  png.image.format = PNG_FORMAT_GA;
  std::vector<std::uint8_t> grey_and_alpha(PNG_IMAGE_SIZE(png.image));
  if (png_image_finish_read(&png.image, nullptr, grey_and_alpha.data(), 0, nullptr) == 0)
    png.fail("is a broken PNG");
  AlphaImage out{width, height, std::vector<std::uint8_t>(pixels)};
  for (std::size_t i = 0; i < pixels; ++i) out.alpha[i] = grey_and_alpha[2 * i + 1];
  return out;
}

std::vector<std::byte> write_alpha(const AlphaImage& alpha) {
  PngImage png;
  png.image.width = alpha.width, png.image.height = alpha.height;
  png.image.format = PNG_FORMAT_GA;
  std::vector<std::uint8_t> grey_and_alpha(2 * alpha.alpha.size(), 255);
  for (std::size_t i = 0; i < alpha.alpha.size(); ++i) grey_and_alpha[2 * i + 1] = alpha.alpha[i];
  png_alloc_size_t size = 0;
  if (png_image_write_get_memory_size(png.image, size, 0, grey_and_alpha.data(), 0, nullptr) == 0)
    png.fail("cannot be written as PNG");
  std::vector<std::byte> out(size);
  if (png_image_write_to_memory(&png.image, out.data(), &size, 0, grey_and_alpha.data(), 0, nullptr) == 0)
    png.fail("cannot be written as PNG");
  out.resize(size);
  return out;
}

}  // namespace sightline::io
