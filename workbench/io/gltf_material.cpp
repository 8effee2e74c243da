#include "workbench/io/gltf_material.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <sightline/workbench/error.hpp>

#include "workbench/io/alpha_png.hpp"

namespace sightline::io::gltf {

namespace {

bool says(const Json& object, const char* key) {
  const Json* found = find(object, key);
  return found != nullptr && found->is_boolean() && found->get<bool>();
}

double number_or(const Json& object, const char* key, double fallback) {
  const Json* found = find(object, key);
  return found != nullptr ? number_of(*found, key) : fallback;
}

/// glTF's default where the material says none.
std::string alpha_mode_of(const Json& material) {
  if (find(material, "alphaMode") == nullptr) return "OPAQUE";
  std::string mode = text_of(material, "alphaMode");
  if (mode != "OPAQUE" && mode != "MASK" && mode != "BLEND")
    throw Error("has 'alphaMode' that is not OPAQUE, MASK or BLEND");
  return mode;
}

/// KHR_texture_transform: scaled, then turned, then moved.
void read_move(const Json& transform, std::uint64_t material, Look& look) {
  std::array<double, 2> offset{0, 0}, scale{1, 1};
  if (const Json* found = find(transform, "offset")) numbers_of(*found, "offset", offset);
  if (const Json* found = find(transform, "scale")) numbers_of(*found, "scale", scale);
  const double angle = number_or(transform, "rotation", 0), c = std::cos(angle), s = std::sin(angle);
  look.coordinate_set = whole_of(transform, "texCoord", look.coordinate_set);
  const std::array<double, 6> move{c * scale[0],  s * scale[1], offset[0],
                                   -s * scale[0], c * scale[1], offset[1]};
  if (move == look.move) return;
  look.move = move;
  look.moved_by = material;
}

}  // namespace

MaterialReader::MaterialReader(Document& document, Scene& scene) : document_(document), scene_(scene) {
  const Json::array_t& materials = array_of(document.root(), "materials");
  looks_.reserve(materials.size());
  for (std::size_t i = 0; i < materials.size(); ++i) {
    try {
      looks_.push_back(read(materials[i], i));
    } catch (const Error& error) {
      throw Error(fmt::format("material {} {}", i, error.what()));
    }
  }
  read_images();
  if (unread_ != 0) {
    scene.ignored.push_back(fmt::format(
        "the images of {} materials, in formats that are not read: what they cut out is drawn whole",
        unread_));
  }
}

const Look& MaterialReader::look_of(const Json& primitive) const {
  const std::uint64_t material = whole_of(primitive, "material", kNone);
  if (material == kNone) return default_;
  if (material >= looks_.size()) throw Error(fmt::format("has material {} of {}", material, looks_.size()));
  return looks_[material];
}

Look MaterialReader::read(const Json& material, std::uint64_t index) {
  Look look;
  const std::string mode = alpha_mode_of(material);
  look.material.sides = says(material, "doubleSided") ? Sides::both : Sides::front;
  if (mode == "BLEND") look.material.surface = Surface::transparent;
  if (mode == "MASK") read_cut_out(material, index, look);
  return look;
}

void MaterialReader::read_cut_out(const Json& material, std::uint64_t index, Look& look) {
  look.material.surface = Surface::cut_out;
  const double cutoff = number_or(material, "alphaCutoff", 0.5);
  double factor = 1;
  std::uint64_t image = kNone;
  if (const Json* base = find(material, "pbrMetallicRoughness")) {
    std::array<double, 4> colour{1, 1, 1, 1};
    if (const Json* found = find(*base, "baseColorFactor")) numbers_of(*found, "baseColorFactor", colour);
    factor = colour[3];
    if (const Json* texture = find(*base, "baseColorTexture")) {
      image = image_of(*texture);
      unread_ += image == kNone;
      look.coordinate_set = whole_of(*texture, "texCoord", 0);
      const Json* extensions = find(*texture, "extensions");
      const Json* move = extensions != nullptr ? find(*extensions, "KHR_texture_transform") : nullptr;
      if (move != nullptr) read_move(*move, index, look);
    }
  }
  // Drawn where alpha · factor >= cutoff. The least alpha of 255 that is, but for what rounding adds.
  const double least = factor > 0 ? std::ceil(cutoff / factor * 255 - 1e-6) : cutoff > 0 ? 256 : 0;
  if (least > 255) {  // nowhere
    if (nothing_ == kNoAlphaImage) nothing_ = scene_.add_alpha_image({1, 1, {0}});
    look.material.alpha_image = nothing_;
    look.material.alpha_cutoff = 255;
    return;
  }
  look.material.alpha_cutoff = static_cast<std::uint8_t>(std::max(least, 0.0));
  if (image != kNone) of_image_[image].push_back(index);
}

std::uint64_t MaterialReader::image_of(const Json& texture_info) const {
  const Json& texture = document_.at("textures", whole_of(texture_info, "index"));
  return whole_of(texture, "source", kNone);  // none where only an extension's format is there
}

void MaterialReader::read_images() {
  PixelBudget budget;
  for (const auto& [image, materials] : of_image_) {
    try {
      std::optional<AlphaImage> alpha = read_alpha(document_.image(image), budget);
      if (!alpha) continue;
      const std::uint32_t number = scene_.add_alpha_image(std::move(*alpha));
      for (const std::size_t material : materials) looks_[material].material.alpha_image = number;
    } catch (const Error& error) {
      throw Error(fmt::format("image {} {}", image, error.what()));
    }
  }
}

}  // namespace sightline::io::gltf
