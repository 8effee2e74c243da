// The alpha of images that nobody vouches for, and the PNG that a scene's alpha is written as.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <sightline/workbench/scene.hpp>

#include "workbench/io/byte_reader.hpp"

namespace sightline::io {

/// What a side of an image, and an image, may have at most.
inline constexpr std::uint32_t kMaxImageSide = 16384;
inline constexpr std::uint64_t kMaxImagePixels = std::uint64_t{1} << 26;

/// Pixels that a scene's images may still be decoded to: a file can name one image many times, and one that
/// turns out broken was work too.
class PixelBudget {
public:
  /// Throws Error where that is more than is left.
  void take(std::uint64_t pixels);

private:
  std::uint64_t left_ = 2 * kMaxImagePixels;
};

/// Whether the bytes begin as a PNG or a JPEG.
bool is_png(Bytes bytes) noexcept;
bool is_jpeg(Bytes bytes) noexcept;

/// The alpha of a PNG or JPEG; nothing where it has none, as no JPEG has: those are not decoded. What a PNG
/// has in 16 bits is rounded to 8. Throws Error for other formats, for damaged ones, and beyond the limits.
std::optional<AlphaImage> read_alpha(Bytes bytes, PixelBudget& budget);

/// White, with this alpha.
std::vector<std::byte> write_alpha(const AlphaImage& image);

}  // namespace sightline::io
