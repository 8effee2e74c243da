#include "workbench/io/quake3_images.hpp"

#include <optional>
#include <utility>

#include <sightline/workbench/error.hpp>

#include "workbench/io/quake3_tga.hpp"

namespace sightline::io::quake3 {

std::uint32_t LevelImages::image_of(const ShaderLook& look) {
  if (look.surface != Surface::cut_out || look.image.empty() || !game_file_) return kNoAlphaImage;
  const auto [place, added] = known_.try_emplace({look.image, look.inverted}, kNoAlphaImage);
  if (added) place->second = read(look.image, look.inverted);
  return place->second;
}

std::uint32_t LevelImages::read(const std::string& name, bool inverted) {
  for (const char* extension : {".tga", ".jpg", ".png"}) {
    const std::string file = name + extension;
    try {
      const std::vector<std::byte> bytes = game_file_(file);
      if (bytes.empty()) continue;
      std::optional<AlphaImage> alpha =
          extension == std::string_view(".tga") ? read_tga_alpha(bytes, budget_) : read_alpha(bytes, budget_);
      if (!alpha) return kNoAlphaImage;
      for (std::uint8_t& a : alpha->alpha) a = inverted ? static_cast<std::uint8_t>(255 - a) : a;
      return scene_.add_alpha_image(std::move(*alpha));
    } catch (const Error& error) {
      scene_.ignored.push_back("image " + file + " " + error.what() + "; what it cuts out is drawn whole");
      return kNoAlphaImage;
    }
  }
  return kNoAlphaImage;
}

}  // namespace sightline::io::quake3
