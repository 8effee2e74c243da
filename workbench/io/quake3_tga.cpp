#include "workbench/io/quake3_tga.hpp"

#include <algorithm>

#include <fmt/format.h>

#include <sightline/workbench/error.hpp>

namespace sightline::io::quake3 {

namespace {

constexpr std::size_t kHeader = 18, kTexel = 4, kAlphaOfTexel = 3;
enum Kind : std::uint8_t { true_colour = 2, grey = 3, packed_true_colour = 10 };

std::uint8_t byte_at(Bytes bytes, std::size_t at) {
  return std::to_integer<std::uint8_t>(bytes[at]);
}

/// The alphas of `count` texels in the order of the file.
std::vector<std::uint8_t> plain(Bytes data, std::size_t count) {
  if (data.size() / kTexel < count)
    throw Error(fmt::format("is a Targa that ends before its {} texels", count));
  std::vector<std::uint8_t> out(count);
  for (std::size_t i = 0; i < count; ++i) out[i] = byte_at(data, kTexel * i + kAlphaOfTexel);
  return out;
}

std::vector<std::uint8_t> unpacked(Bytes data, std::size_t count) {
  // A packet of five bytes stands for 128 texels at most.
  if (count / 128 > data.size() / 5)
    throw Error(fmt::format("is a Targa that ends before its {} texels", count));
  std::vector<std::uint8_t> out;
  out.reserve(count);
  for (std::size_t at = 0; out.size() < count;) {
    if (at >= data.size()) throw Error("is a Targa that ends within its runs");
    const std::uint8_t head = byte_at(data, at++);
    const std::size_t length = std::min<std::size_t>((head & 0x7f) + 1, count - out.size());
    const std::size_t stored = (head & 0x80) != 0 ? 1 : length;
    if (data.size() - at < kTexel * stored) throw Error("is a Targa that ends within its runs");
    for (std::size_t i = 0; i < length; ++i)
      out.push_back(byte_at(data, at + kTexel * std::min(i, stored - 1) + kAlphaOfTexel));
    at += kTexel * stored;
  }
  return out;
}

}  // namespace

std::optional<AlphaImage> read_tga_alpha(Bytes bytes, PixelBudget& budget) {
  if (bytes.size() < kHeader) throw Error("is too short for a Targa");
  const std::uint8_t kind = byte_at(bytes, 2), bits = byte_at(bytes, 16);
  const std::uint32_t width = read_at<std::uint16_t>(bytes, 12), height = read_at<std::uint16_t>(bytes, 14);
  if (kind != true_colour && kind != grey && kind != packed_true_colour) {
    throw Error(fmt::format("is a Targa of kind {}, expected 2, 3 or 10", kind));
  }
  const std::uint64_t count = std::uint64_t{width} * height;
  if (count == 0 || std::max(width, height) > kMaxImageSide || count > kMaxImagePixels) {
    throw Error(fmt::format("is a Targa of {} x {} texels, expected 1 to {} a side and 64 million in all",
                            width, height, kMaxImageSide));
  }
  if (kind == grey || bits != 8 * kTexel) return {};
  budget.take(count);
  const std::size_t comment = byte_at(bytes, 0);
  const Bytes data = bytes.subspan(std::min(kHeader + comment, bytes.size()));
  const std::vector<std::uint8_t> alphas = kind == true_colour ? plain(data, count) : unpacked(data, count);
  AlphaImage out{width, height, {}};
  out.alpha.reserve(count);
  for (std::uint32_t row = height; row-- > 0;) {
    const auto first = alphas.begin() + static_cast<std::ptrdiff_t>(std::size_t{row} * width);
    out.alpha.insert(out.alpha.end(), first, first + width);
  }
  return out;
}

}  // namespace sightline::io::quake3
