#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <sightline/workbench/error.hpp>

#include "workbench/device/renderer.hpp"
#include "workbench/io/files.hpp"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace sightline::device {

void save_png(const Picture& picture, const std::string& path) {
  std::vector<std::byte> file;
  const auto append = [](void* to, void* bytes, int size) {
    const std::span more(static_cast<const std::byte*>(bytes), static_cast<std::size_t>(size));
    auto& all = *static_cast<std::vector<std::byte>*>(to);
    all.insert(all.end(), more.begin(), more.end());
  };
  const auto width = static_cast<int>(picture.width), height = static_cast<int>(picture.height);
  if (!stbi_write_png_to_func(append, &file, width, height, 4, picture.pixels.data(), 4 * width))
    throw Error(path + ": there is not enough memory to write the picture");
  const std::array pieces{std::span<const std::byte>(file)};
  io::write_file(path, pieces);
}

}  // namespace sightline::device
