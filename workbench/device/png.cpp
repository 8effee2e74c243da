#include <cstdio>
#include <filesystem>

#include <fmt/format.h>

#include <sightline/workbench/error.hpp>

#include "workbench/device/renderer.hpp"

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
  const std::string temporary = path + ".tmp";
  const int ok =
      stbi_write_png(temporary.c_str(), static_cast<int>(picture.width), static_cast<int>(picture.height), 4,
                     picture.pixels.data(), static_cast<int>(picture.width * 4));
  std::error_code failed;
  if (ok) std::filesystem::rename(temporary, path, failed);
  if (!ok || failed) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw Error(fmt::format("{}: the picture cannot be written there", path));
  }
}

}  // namespace sightline::device
