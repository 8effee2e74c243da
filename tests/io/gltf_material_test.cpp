// What glTF materials become: surfaces, sides, and the alpha of cut-outs out of images that may be broken.
#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sightline/workbench/io.hpp>

#include "sample_files.hpp"
#include "workbench/io/alpha_png.hpp"

namespace sightline {
namespace {

using namespace samples;
using nlohmann::json;
using testing::HasSubstr;

const AlphaImage kAlpha{4, 2, {0, 50, 100, 127, 128, 200, 250, 255}};

Scene read_document(const json& document, const std::filesystem::path& folder = {}) {
  return read_gltf(to_bytes(document), "sample.gltf", folder);
}

Blob png() {
  return io::write_alpha(kAlpha);
}

/// The smallest that begins as one.
Blob jpeg() {
  Blob out;
  for (const int byte : {0xff, 0xd8, 0xff, 0xe0, 0, 16}) out.push_back(std::byte(byte));
  return out;
}

std::size_t add_view(json& document, std::span<const std::byte> bytes) {
  document["buffers"].push_back({{"byteLength", bytes.size()}, {"uri", to_data_uri(bytes)}});
  document["bufferViews"].push_back(
      {{"buffer", document["buffers"].size() - 1}, {"byteLength", bytes.size()}});
  return document["bufferViews"].size() - 1;
}

/// Texture coordinates of three vertices as the first set.
template <class T>
void add_coordinates(json& document, const std::vector<T>& values, int component_type, const char* set) {
  document["accessors"].push_back({{"bufferView", add_view(document, std::as_bytes(std::span(values)))},
                                   {"componentType", component_type},
                                   {"type", "VEC2"},
                                   {"normalized", component_type != 5126},
                                   {"count", 3}});
  document["meshes"][0]["primitives"][0]["attributes"][set] = document["accessors"].size() - 1;
}

/// A triangle with a material of an image and coordinates.
json leaf_triangle(const json& image) {
  json document = one_triangle();
  add_coordinates<float>(document, {0, 0, 1, 0, 0, 2}, 5126, "TEXCOORD_0");
  document["materials"] =
      json::parse(R"([{"alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])");
  document["textures"] = json::parse(R"([{"source": 0}])");
  document["images"] = json::array({image});
  document["meshes"][0]["primitives"][0]["material"] = 0;
  return document;
}

json with_image(std::span<const std::byte> bytes) {
  json document = leaf_triangle({});
  document["images"][0] = {{"bufferView", add_view(document, bytes)}, {"mimeType", "image/png"}};
  return document;
}

TEST(GltfMaterial, ModesAndSides) {
  json document = one_triangle();
  EXPECT_EQ(read_document(document).material(0), Material(Surface::opaque, Sides::front)) << "glTF's default";
  document["materials"] =
      json::parse(R"([{}, {"doubleSided": true}, {"alphaMode": "MASK", "doubleSided": false},
    {"alphaMode": "BLEND", "doubleSided": true}, {"alphaMode": "OPAQUE", "alphaCutoff": 0.1},
    {"alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true}])");
  const std::vector<Material> expected{
      {Surface::opaque, Sides::front},  {Surface::opaque, Sides::both},
      {Surface::cut_out, Sides::front}, {Surface::transparent, Sides::both},
      {Surface::opaque, Sides::front},  {Surface::cut_out, Sides::both, kNoAlphaImage, 64}};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    document["meshes"][0]["primitives"][0]["material"] = i;
    EXPECT_EQ(read_document(document).material(0), expected[i]) << i;
  }
  document["meshes"][0]["primitives"][0]["material"] = 6;
  EXPECT_THAT(error_of([&] { read_document(document); }), HasSubstr("material 6 of 6"));
}

TEST(GltfMaterial, ImagesWithinAndBesideTheFile) {
  const TemporaryFolder folder;
  write(folder / "leaf.png", png());
  for (const json& document : {with_image(png()), leaf_triangle({{"uri", to_data_uri(png())}}),
                               leaf_triangle({{"uri", "leaf.png"}})}) {
    const Scene scene = read_document(document, folder.path());
    EXPECT_EQ(scene.material(0), Material(Surface::cut_out, Sides::front, 0, 128));
    ASSERT_EQ(scene.alpha_images.size(), 1u);
    EXPECT_EQ(scene.alpha_images[0], kAlpha);
    EXPECT_EQ(scene.texture_coordinates, (std::vector<TextureCoordinate>{{0, 0}, {1, 0}, {0, 2}}));
  }
  EXPECT_THAT(error_of([&] {
                read_document(leaf_triangle({{"uri", "leaf.png"}}));
              }),
              HasSubstr("image 0 lies in another file"));
}

TEST(GltfMaterial, TheFactorCountsIntoTheCutoff) {
  json document = with_image(png());
  json& base = document["materials"][0]["pbrMetallicRoughness"];
  // alpha · 0.5 >= 0.25
  base["baseColorFactor"] = {1, 1, 1, 0.5};
  document["materials"][0]["alphaCutoff"] = 0.25;
  EXPECT_EQ(read_document(document).alpha_cutoff[0], 128);
  // What reaches the cutoff nowhere is drawn nowhere.
  document["materials"][0]["alphaCutoff"] = 0.75;
  const Scene nowhere = read_document(document);
  ASSERT_NE(nowhere.alpha_image[0], kNoAlphaImage);
  EXPECT_EQ(nowhere.alpha_images[nowhere.alpha_image[0]], (AlphaImage{1, 1, {0}}));
  EXPECT_GT(nowhere.alpha_cutoff[0], 0);
  document["materials"][0]["alphaCutoff"] = -1;
  EXPECT_EQ(read_document(document).alpha_cutoff[0], 0);
  // The same without a texture.
  base.erase("baseColorTexture");
  document["materials"][0]["alphaCutoff"] = 0.6;
  EXPECT_NE(read_document(document).alpha_image[0], kNoAlphaImage);
  EXPECT_NO_THROW(check(read_document(document)));
  document["materials"][0]["alphaCutoff"] = 0.4;
  EXPECT_EQ(read_document(document).alpha_image[0], kNoAlphaImage);
}

TEST(GltfMaterial, WhatHasNoAlphaIsDrawnWhole) {
  EXPECT_EQ(read_document(with_image(jpeg())).material(0), Material(Surface::cut_out, Sides::front));
  json document = with_image(png());
  document["textures"][0] = json::parse(R"({"extensions": {"EXT_texture_webp": {"source": 0}}})");
  EXPECT_EQ(read_document(document).alpha_image[0], kNoAlphaImage);
  EXPECT_THAT(read_document(document).ignored, testing::ElementsAre(HasSubstr("the images of 1 materials")));
  document = with_image(png());
  document["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
  EXPECT_EQ(read_document(document).alpha_image[0], kNoAlphaImage);
}

TEST(GltfMaterial, ImagesOfWhatIsNotCutOutAreNotLookedAt) {
  json document = with_image(jpeg());
  document["images"][0] = {{"uri", "no/such/file.png"}};
  for (const char* mode : {"OPAQUE", "BLEND"}) {
    document["materials"][0]["alphaMode"] = mode;
    const Scene scene = read_document(document);
    EXPECT_TRUE(scene.alpha_images.empty());
    EXPECT_TRUE(scene.texture_coordinates.empty());
  }
}

TEST(GltfMaterial, CoordinatesOfEveryKindAndSet) {
  json document = with_image(png());
  add_coordinates<std::uint8_t>(document, {0, 0, 255, 0, 0, 51}, 5121, "TEXCOORD_1");
  json& texture = document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
  texture["texCoord"] = 1;
  EXPECT_EQ(read_document(document).texture_coordinates,
            (std::vector<TextureCoordinate>{{0, 0}, {1, 0}, {0, 51 / 255.0f}}));
  // Scaled, a quarter turn against the clock as seen (v points down), moved.
  texture["extensions"]["KHR_texture_transform"] = json::parse(
      R"({"texCoord": 0, "offset": [0.5, 0.25], "rotation": 1.5707963267948966, "scale": [2, 4]})");
  const std::vector<TextureCoordinate> moved = read_document(document).texture_coordinates;
  const std::vector<TextureCoordinate> expected{{0.5f, 0.25f}, {0.5f, -1.75f}, {8.5f, 0.25f}};
  ASSERT_EQ(moved.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(moved[i].u, expected[i].u, 1e-6);
    EXPECT_NEAR(moved[i].v, expected[i].v, 1e-6);
  }
}

TEST(GltfMaterial, OnlyWhatDiffersIsAnotherMesh) {
  json document = with_image(png());
  document["materials"].push_back(json::object());
  document["materials"].push_back(document["materials"][0]);
  document["materials"][2]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]
          ["KHR_texture_transform"] = {{"scale", {2, 2}}};
  json& primitives = document["meshes"][0]["primitives"];
  for (const int material : {1, 2}) {
    primitives.push_back(primitives[0]);
    primitives.back()["material"] = material;
  }
  const Scene scene = read_document(document);
  EXPECT_EQ(scene.mesh, (std::vector<std::uint32_t>{0, 0, 1}));
  EXPECT_EQ(scene.texture_coordinates[5], (TextureCoordinate{0, 4}));
}

TEST(GltfMaterialHostile, BrokenImagesAreOneSentence) {
  Blob bytes = png();
  const auto said = [](const Blob& image) { return error_of([&] { read_document(with_image(image)); }); };
  EXPECT_THAT(said({}), HasSubstr("image 0 is neither a PNG nor a JPEG"));
  EXPECT_THAT(said({bytes.begin(), bytes.begin() + 20}), HasSubstr("image 0 is no whole PNG"));
  // A header may claim what it likes.
  Blob wide = bytes;
  wide[18] = std::byte{0x7f};
  EXPECT_THAT(said(wide), HasSubstr("image 0 "));
  std::mt19937 random(5);
  for (std::size_t length = 1; length < bytes.size(); ++length) {
    EXPECT_NO_FATAL_FAILURE(said({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)}));
  }
  for (int round = 0; round < 3000; ++round) {
    Blob changed = bytes;
    changed[random() % changed.size()] = std::byte(random() & 0xff);
    said(changed);  // a scene or a sentence
  }
}

TEST(GltfMaterialHostile, ModesThatTheFormatLacks) {
  json document = one_triangle();
  for (const json& mode : {json("FOO"), json("opaque"), json(""), json(3), json(nullptr), json::array()}) {
    document["materials"] = {json::object(), {{"alphaMode", mode}}};
    EXPECT_EQ(error_of([&] { read_document(document); }),
              "sample.gltf: material 1 has 'alphaMode' that is not OPAQUE, MASK or BLEND")
        << mode.dump();
  }
}

TEST(GltfMaterialHostile, ReferencesAndNumbers) {
  json document = with_image(png());
  document["textures"][0]["source"] = 1;
  EXPECT_THAT(error_of([&] { read_document(document); }), HasSubstr("element 1 of 'images'"));
  document = with_image(png());
  document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 3;
  EXPECT_THAT(error_of([&] { read_document(document); }),
              HasSubstr("material 0 refers to element 3 of 'textures'"));
  document = with_image(png());
  document["materials"][0]["alphaCutoff"] = "much";
  EXPECT_THAT(error_of([&] { read_document(document); }), HasSubstr("material 0 has 'alphaCutoff'"));
  document = with_image(png());
  add_coordinates<float>(document, {0, 0, 1, 0, NAN, 2}, 5126, "TEXCOORD_0");
  EXPECT_THAT(error_of([&] { read_document(document); }),
              HasSubstr("texture coordinate 2 that is not finite"));
}

TEST(AlphaPng, SixteenBitsAndLimits) {
  io::PixelBudget budget;
  EXPECT_EQ(io::read_alpha(png(), budget), kAlpha);
  EXPECT_EQ(io::read_alpha(jpeg(), budget), std::nullopt);
  // 20,000 pixels wide: the header alone, with its checksum.
  AlphaImage wide{20000, 1, std::vector<std::uint8_t>(20000, 7)};
  EXPECT_THAT(error_of([&] { (void)io::read_alpha(io::write_alpha(wide), budget); }),
              HasSubstr("20000 x 1 pixels"));
}

// What is damaged was decoded up to where it is.
TEST(AlphaPng, DamagedImagesCountTowardsAllPixels) {
  io::PixelBudget budget;
  budget.take(2 * io::kMaxImagePixels - kAlpha.alpha.size());
  std::vector<std::byte> cut = png();
  cut.resize(cut.size() - 16);
  EXPECT_THAT(error_of([&] { (void)io::read_alpha(cut, budget); }), HasSubstr("is a broken PNG"));
  EXPECT_THAT(error_of([&] { (void)io::read_alpha(png(), budget); }), HasSubstr("over 128 million pixels"));
}

}  // namespace
}  // namespace sightline
