// Any bytes as an image, and as a Targa: its alpha, of the size it says and the same when it is written as
// PNG and read again, or an Error.
#include <sightline/workbench/error.hpp>

#include "workbench/io/alpha_png.hpp"
#include "workbench/io/quake3_tga.hpp"

namespace {

using namespace sightline;

template <class Read>
void examine(Read read, io::Bytes bytes) {
  std::optional<AlphaImage> image;
  io::PixelBudget budget;
  try {
    image = read(bytes, budget);
  } catch (const Error&) {
  }
  if (!image) return;
  if (image->alpha.size() != std::uint64_t{image->width} * image->height) __builtin_trap();
  if (image->alpha.size() < 65536 && io::read_alpha(io::write_alpha(*image), budget) != image)
    __builtin_trap();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const io::Bytes bytes = std::as_bytes(std::span(data, size));
  examine(io::read_alpha, bytes);
  examine(io::quake3::read_tga_alpha, bytes);
  return 0;
}
