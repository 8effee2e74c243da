// Any bytes as an image: its alpha, of the size it says and the same when it is written and read again, or an
// Error.
#include <sightline/workbench/error.hpp>

#include "workbench/io/alpha_png.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sightline;
  std::optional<AlphaImage> image;
  try {
    image = io::read_alpha(std::as_bytes(std::span(data, size)));
  } catch (const Error&) {
    return 0;
  }
  if (!image) return 0;
  if (image->alpha.size() != std::uint64_t{image->width} * image->height) __builtin_trap();
  if (image->alpha.size() < 65536 && io::read_alpha(io::write_alpha(*image)) != image) __builtin_trap();
  return 0;
}
