// Shader scripts: what they say of a surface, in which order, and what is left of broken ones.
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sightline/workbench/io.hpp>

#include "sample_files.hpp"
#include "workbench/io/alpha_png.hpp"
#include "workbench/io/quake3_faces.hpp"
#include "workbench/io/quake3_tga.hpp"

namespace sightline {
namespace {

using namespace samples;
using namespace io::quake3;
using testing::ElementsAre;

ShaderScripts parse(const std::string& text) {
  return ShaderScripts(std::span(&text, 1));
}

void expect_look(const char* body, Surface surface, Cull cull = Cull::backs) {
  SCOPED_TRACE(body);
  const ShaderScripts scripts = parse("textures/a\n{\n" + std::string(body) + "\n}\n");
  EXPECT_EQ(scripts.broken(), 0u);
  const ShaderLook* look = scripts.find("textures/a");
  ASSERT_NE(look, nullptr);
  EXPECT_EQ(look->surface, surface);
  EXPECT_EQ(look->cull, cull);
}

TEST(Quake3Shaders, TheFirstStageDecides) {
  using enum Surface;
  expect_look("{\nmap a.tga\n}", opaque);
  expect_look("{\nmap a.tga\nalphaFunc GE128\ndepthWrite\n}\n{\nmap $lightmap\nblendFunc filter\n}", cut_out);
  expect_look("{\nmap a.tga\nblendFunc GL_SRC_ALPHA GL_ONE_MINUS_SRC_ALPHA\n}", transparent);
  expect_look("{\nmap a.tga\nblendfunc add\n}", transparent);
  expect_look("{\nmap a.tga\nblendFunc GL_ONE GL_ZERO\n}", opaque);
  expect_look("{\nmap $lightmap\n}\n{\nmap a.tga\nblendFunc filter\nalphaFunc GT0\n}", opaque);
  expect_look("surfaceparm trans\n{\nmap a.tga\n}", opaque);
  expect_look("surfaceparm trans\n{\nmap a.tga\nblendFunc blend\nalphaFunc LT128\n}", cut_out);
  expect_look("sort additive\n{\nmap a.tga\n}", transparent);
  expect_look("sort 9\n{\nmap a.tga\n}", transparent);
  expect_look("sort decal\n{\nmap a.tga\n}", opaque);
  expect_look("sort 3\n{\nmap a.tga\n}", opaque);
  expect_look("surfaceparm nodraw", transparent);
  expect_look("surfaceparm sky\nskyparms env/a 512 -", opaque);
}

TEST(Quake3Shaders, SidesAsCullHasThem) {
  using enum Surface;
  for (const char* word : {"none", "twosided", "DISABLE"})
    expect_look(("cull " + std::string(word) + "\n{\nmap a.tga\n}").c_str(), opaque, Cull::none);
  for (const char* word : {"back", "backside", "backsided"})
    expect_look(("cull " + std::string(word) + "\n{\nmap a.tga\n}").c_str(), opaque, Cull::fronts);
  expect_look("cull front\n{\nmap a.tga\n}", opaque);
  expect_look("deformVertexes autosprite2\n{\nmap a.tga\nblendFunc add\n}", transparent, Cull::none);
}

TEST(Quake3Shaders, TheGamesSyntax) {
  // Comments, quotes, case, arguments that end with a brace, one-line stages.
  expect_look(
      "// cull none\n/* cull none\n */ \"surfaceparm\" trans\nCULL None // yes\n{ map a.tga\nAlphaFunc ge128 "
      "}",
      Surface::cut_out, Cull::none);
  expect_look("q3map_sun 1 1 1 100 70 60\n{\nmap a.tga\nblendFunc add }", Surface::transparent);
  const ShaderScripts scripts =
      parse("Textures\\A\n{\ncull none\n{\nmap b\n}\n}\r\ntextures/editor\n{\nqer_trans 0.5\n}\n");
  ASSERT_NE(scripts.find("TEXTURES/a.TGA"), nullptr);
  EXPECT_EQ(scripts.find("textures/a.b/c"), nullptr);
  EXPECT_EQ(scripts.find("textures/editor"), nullptr) << "what draws nothing is not there";
  EXPECT_EQ(scripts.size(), 1u);
}

TEST(Quake3Shaders, BrokenScriptsAreLeftOutAndCounted) {
  const std::string good = "a\n{\n{\nmap a\n}\n}\n";
  const std::vector<std::string> texts{"a {\n{\nmap a\n}",
                                       "a\nb\n{\n}\n",
                                       "}",
                                       good,
                                       "a\n{\ncull none\n{\nmap a\n}\n}",
                                       std::string(ShaderScripts::kMaxScript + 1, ' '),
                                       ""};
  const ShaderScripts scripts(texts);
  EXPECT_EQ(scripts.broken(), 4u);
  ASSERT_NE(scripts.find("a"), nullptr);
  EXPECT_EQ(scripts.find("a")->cull, Cull::backs) << "the first counts";
  // Depth costs nothing.
  EXPECT_EQ(parse("a\n{\n" + std::string(1000000, '{')).broken(), 1u);
  std::string deep = "a\n{\n";
  for (int i = 0; i < 200000; ++i) deep += "{\n";
  EXPECT_EQ(parse(deep).broken(), 1u);
}

TEST(Quake3Shaders, AnyByteMayBeAnything) {
  const std::string whole =
      "textures/a\n{\ncull none\nsurfaceparm trans // c\n{\nmap a.tga\nalphaFunc GE128\nblendFunc "
      "add\n}\n}\n";
  std::mt19937 random(3);
  for (int round = 0; round < 20000; ++round) {
    std::string text = whole;
    for (int change = 0; change < 1 + round % 4; ++change)
      text[random() % text.size()] = "{}\"/*\n\0 a"[random() % 9];
    (void)parse(text).find("textures/a");
  }
}

TEST(Quake3Shaders, FlagsDecideWithoutAScript) {
  const ShaderScripts none(std::span<const std::string>{});
  const auto surface = [&](std::uint32_t flags, std::uint32_t contents) {
    return look_of({{"textures/a"}, flags, contents}, none);
  };
  EXPECT_EQ(surface(0, 1).surface, Surface::opaque);
  EXPECT_EQ(surface(0, 1).cull, Cull::backs);
  EXPECT_EQ(surface(0x14030, 0).surface, Surface::cut_out) << "islandctf's palm trees";
  EXPECT_EQ(surface(0x10000, 1).surface, Surface::cut_out);
  EXPECT_EQ(surface(0x8000, 1).surface, Surface::cut_out);
  EXPECT_EQ(surface(0x4000, 0).cull, Cull::none);
  EXPECT_EQ(surface(4, 0).surface, Surface::opaque) << "the sky";
  EXPECT_EQ(surface(0x80, 1).surface, Surface::transparent);
  EXPECT_EQ(surface(0, 0x20000001).surface, Surface::transparent);
  // With one, it does.
  const ShaderScripts scripts = parse("textures/a\n{\n{\nmap a\n}\n}\n");
  EXPECT_EQ(look_of({{"textures/a"}, 0x14030, 0}, scripts).surface, Surface::opaque);
  EXPECT_EQ(look_of({{"textures/a"}, 0x80, 0}, scripts).surface, Surface::transparent);
}

TEST(Quake3Shaders, ScriptsBesideALevelAreFound) {
  const TemporaryFolder folder;
  const auto shader = [](const char* says) {
    return to_bytes("textures/wall\n{\n" + std::string(says) + "\n{\nmap a\n}\n}\n");
  };
  write(folder / "level.pk3", to_pk3("maps/sample.bsp", to_bsp(two_rooms())));
  const std::string level = (folder / "level.pk3").string() + ":maps/sample.bsp";
  EXPECT_EQ(load_scene(level).sides[0], Sides::front);
  // Loose files come last, then archives, the last by name first; the same script's name is taken once.
  std::filesystem::create_directory(folder / "scripts");
  write(folder / "scripts/walls.shader", shader("cull none"));
  EXPECT_EQ(load_scene(level).sides[0], Sides::both);
  write(folder / "Pak1.pk3", to_pk3("scripts/WALLS.shader", shader("sort additive")));
  EXPECT_EQ(load_scene(level).material(0), Material(Surface::transparent, Sides::front));
  write(folder / "pak2.pk3", to_pk3("scripts/other.shader", shader("cull twosided\nsort additive")));
  EXPECT_EQ(load_scene(level).material(0), Material(Surface::transparent, Sides::both));
  // One that is broken is left out and said to be.
  write(folder / "zz.pk3", to_bytes(std::string("no archive")));
  const Scene scene = load_scene(level);
  EXPECT_EQ(scene.surface[0], Surface::transparent);
  EXPECT_THAT(scene.ignored, ElementsAre(testing::HasSubstr("zz.pk3: not a readable zip archive")));
  // A loose level lies in "maps".
  std::filesystem::create_directory(folder / "maps");
  write(folder / "maps/sample.bsp", to_bsp(two_rooms()));
  EXPECT_EQ(load_scene((folder / "maps/sample.bsp").string()).surface[0], Surface::transparent);
}

/// The texture's alpha, read by itself.
std::optional<AlphaImage> targa_alpha(const Blob& bytes) {
  io::PixelBudget budget;
  return read_tga_alpha(bytes, budget);
}

/// A Targa of 2 x 2 texels, plain or of one run and one plain packet; alphas from the bottom row: 10, 10,
/// 200, 255.
Blob targa(bool packed) {
  std::vector<int> bytes{0, 0, packed ? 10 : 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 2, 0, 32, 0x28};
  if (packed) bytes.push_back(0x81);
  for (const int alpha : {10, 10, 200, 255}) {
    if (packed && alpha == 200) bytes.push_back(0x01);
    if (packed && alpha == 10 && bytes.back() == 10) continue;
    bytes.insert(bytes.end(), {1, 2, 3, alpha});
  }
  Blob out;
  for (const int byte : bytes) out.push_back(std::byte(byte));
  return out;
}

TEST(Quake3Shaders, CutOutsHaveTheAlphaOfTheFirstStagesImage) {
  const AlphaImage as_stored{2, 2, {200, 255, 10, 10}};
  EXPECT_EQ(targa_alpha(targa(false)), as_stored);
  EXPECT_EQ(targa_alpha(targa(true)), as_stored);
  LoadOptions options;
  const auto image_of = [&](const std::string& stage, const Blob& tga) {
    options.shader_scripts = {"textures/wall\n{\n{\n" + stage + "\n}\n}\n"};
    options.game_file = [&](const std::string& name) { return name == "textures/leaf.tga" ? tga : Blob{}; };
    return read_bsp(to_bsp(two_rooms()), "level", options);
  };
  Scene scene = image_of("map Textures\\Leaf.JPG\nalphaFunc GE128", targa(false));
  EXPECT_EQ(scene.material(0), Material(Surface::cut_out, Sides::front, 0, 128));
  EXPECT_EQ(scene.alpha_images, std::vector{as_stored});
  EXPECT_EQ(scene.texture_coordinates.size(), scene.positions.size());
  EXPECT_EQ(image_of("clampmap textures/leaf\nalphaFunc GT0", targa(true)).alpha_cutoff[0], 1);
  scene = image_of("alphaFunc LT128\nmap textures/leaf.tga", targa(true));
  EXPECT_EQ(scene.alpha_images, (std::vector{AlphaImage{2, 2, {55, 0, 245, 245}}}));
  // No file, no alpha, a texture that moves, no cut-out: drawn whole.
  for (const char* stage :
       {"map textures/other.tga\nalphaFunc GE128", "map $lightmap\nalphaFunc GE128",
        "map textures/leaf.tga\ntcMod scroll 1 0\nalphaFunc GE128", "map textures/leaf.tga"}) {
    scene = image_of(stage, targa(false));
    EXPECT_EQ(scene.alpha_image[0], kNoAlphaImage) << stage;
    EXPECT_TRUE(scene.texture_coordinates.empty());
    EXPECT_TRUE(scene.ignored.empty());
  }
  Blob cut = targa(true);
  cut.resize(cut.size() - 3);
  scene = image_of("map textures/leaf.tga\nalphaFunc GE128", cut);
  EXPECT_EQ(scene.alpha_image[0], kNoAlphaImage);
  EXPECT_THAT(scene.ignored, ElementsAre(testing::HasSubstr("image textures/leaf.tga is a Targa that ends")));
}

// Each claims 64 million texels and ends before them.
TEST(Quake3Shaders, DamagedImagesCountTowardsAllPixels) {
  Blob huge = targa(false);
  huge[13] = huge[15] = std::byte{8192 >> 8};
  huge[12] = huge[14] = std::byte{0};
  LoadOptions options;
  options.game_file = [&](const std::string& name) { return name.ends_with(".tga") ? huge : Blob{}; };
  Level level = two_rooms();
  std::string script;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string name = "textures/" + std::to_string(i);
    level.shaders.push_back({});
    name.copy(level.shaders.back().name.data(), name.size());
    level.faces[i].shader = static_cast<std::int32_t>(level.shaders.size() - 1);
    script += name + "\n{\n{\nmap " + name + ".tga\nalphaFunc GE128\n}\n}\n";
  }
  options.shader_scripts = {script};
  EXPECT_THAT(read_bsp(to_bsp(level), "level", options).ignored,
              ElementsAre(testing::HasSubstr("textures/0.tga is a Targa that ends"),
                          testing::HasSubstr("textures/1.tga is a Targa that ends"),
                          testing::HasSubstr("textures/2.tga brings all images together over 128 million")));
}

TEST(Quake3Shaders, AnArchiveBringsItsOwnScriptsAndImages) {
  const auto script = [](const char* text) { return to_bytes(std::string(text)); };
  const Blob archive =
      to_pk3({{"maps/sample.bsp", to_bsp(two_rooms())},
              {"Scripts/A.Shader", script("textures/wall\n{\n{\nmap TEXTURES/b.tga\nalphaFunc GT0\n}\n}\n")},
              {"scripts/deeper/b.shader", script("textures/glass\n{\n{\nmap a\n}\n}\n")},
              {"scripts/broken.shader", script("textures/wall\n{\n")},
              {"Textures/B.png", io::write_alpha({1, 1, {7}})}});
  const Scene scene = read_pk3(archive, "maps/sample.bsp", "a.pk3");
  EXPECT_EQ(scene.material(0), Material(Surface::cut_out, Sides::front, 0, 1));
  EXPECT_EQ(scene.alpha_images, (std::vector{AlphaImage{1, 1, {7}}}));
  EXPECT_EQ(scene.surface[2], Surface::transparent) << "scripts lie in no folder below";
  EXPECT_THAT(scene.ignored, ElementsAre(testing::HasSubstr("1 shader scripts whose braces do not match")));
}

TEST(Quake3Shaders, BrokenTargasAreOneSentence) {
  std::mt19937 random(9);
  for (const bool packed : {false, true}) {
    for (std::size_t length = 0; length < targa(packed).size(); ++length) {
      Blob cut = targa(packed);
      cut.resize(length);
      EXPECT_NE(error_of([&] { (void)targa_alpha(cut); }), "") << length;
    }
    for (int round = 0; round < 5000; ++round) {
      Blob changed = targa(packed);
      changed[random() % changed.size()] = std::byte(random() & 0xff);
      error_of([&] { (void)targa_alpha(changed); });
    }
  }
}

TEST(Quake3Shaders, TurnedFacesAreSeenFromBehind) {
  LoadOptions options;
  const Scene front = read_bsp(to_bsp(two_rooms()), "front");
  options.shader_scripts = {"textures/wall\n{\ncull backsided\n{\nmap a\n}\n}\n"};
  const Scene back = read_bsp(to_bsp(two_rooms()), "back", options);
  ASSERT_EQ(front.indices.size(), back.indices.size());
  for (std::uint32_t i = 0; i < front.meshes[0].index_count; i += 3) {
    EXPECT_EQ(front.indices[i], back.indices[i]);
    EXPECT_EQ(front.indices[i + 1], back.indices[i + 2]);
  }
  EXPECT_EQ(back.sides[0], Sides::front);
}

}  // namespace
}  // namespace sightline
