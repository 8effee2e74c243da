#include "workbench/scene/materials.hpp"

#include <algorithm>
#include <cmath>

#include <sightline/workbench/error.hpp>

namespace sightline {

namespace scene {

namespace {

void check_images(const Scene& s) {
  for (std::size_t i = 0; i < s.alpha_images.size(); ++i) {
    const AlphaImage& image = s.alpha_images[i];
    if (image.width == 0 || image.height == 0 ||
        std::uint64_t{image.width} * image.height != image.alpha.size()) {
      throw Error("scene '" + s.name + "': alpha image " + std::to_string(i) + ": expected " +
                  std::to_string(image.width) + " x " + std::to_string(image.height) +
                  " texels, at least one, and has " + std::to_string(image.alpha.size()));
    }
  }
}

void check_coordinates(const Scene& s) {
  if (s.texture_coordinates.empty()) {
    const auto none = [](std::uint32_t image) { return image == kNoAlphaImage; };
    if (std::ranges::all_of(s.alpha_image, none)) return;
    throw Error("scene '" + s.name +
                "': an object shows an alpha image, but there are no texture coordinates");
  }
  if (s.texture_coordinates.size() != s.positions.size()) {
    throw Error("scene '" + s.name + "': expected one texture coordinate a position, or none at all");
  }
  const auto finite = [](const TextureCoordinate& c) { return std::isfinite(c.u) && std::isfinite(c.v); };
  if (!std::ranges::all_of(s.texture_coordinates, finite)) {
    throw Error("scene '" + s.name + "': a texture coordinate is not finite");
  }
}

}  // namespace

Sides drawn_sides(Sides of_material, RasterState state) noexcept {
  if (state == RasterState::both_sides) return Sides::both;
  return state == RasterState::front_faces ? Sides::front : of_material;
}

void check_materials(const Scene& s) {
  const std::size_t n = s.size();
  if (s.material_sides.size() != n || s.alpha_image.size() != n || s.alpha_cutoff.size() != n ||
      s.layers.size() != n) {
    throw Error("scene '" + s.name + "': object arrays differ in length");
  }
  for (std::size_t object = 0; object < n; ++object) {
    const auto refuse = [&](const char* expected) {
      throw Error("scene '" + s.name + "': object " + std::to_string(object) + ": " + expected);
    };
    if (s.surface[object] > Surface::transparent) refuse("its surface is of no known kind");
    if (s.sides[object] > Sides::front || s.material_sides[object] > Sides::front) {
      refuse("its sides are of no known kind");
    }
    if (s.alpha_image[object] != kNoAlphaImage && s.alpha_image[object] >= s.alpha_images.size()) {
      refuse("its alpha image is out of range");
    }
  }
  check_images(s);
  check_coordinates(s);
  for (const double coordinate : {s.origin.x, s.origin.y, s.origin.z}) {
    if (!(std::abs(coordinate) <= kWorldReach)) {
      throw Error("scene '" + s.name + "': its origin lies beyond 1e11 m");
    }
  }
}

}  // namespace scene

std::string_view to_string(RasterState state) noexcept {
  switch (state) {
    case RasterState::materials:
      return "materials";
    case RasterState::both_sides:
      return "both sides";
    case RasterState::front_faces:
      return "front faces";
  }
  return "";
}

void set_raster_state(Scene& s, RasterState state) {
  s.raster_state = state;
  s.sides.resize(s.material_sides.size());
  std::ranges::transform(s.material_sides, s.sides.begin(),
                         [&](Sides sides) { return scene::drawn_sides(sides, state); });
}

}  // namespace sightline
