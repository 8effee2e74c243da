// What write_glb writes, opened by a reader of somebody else's: the same materials, triangle for triangle.
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <tuple>

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>
#include <assimp/Importer.hpp>

#include <sightline/workbench/io.hpp>

#include "sample_files.hpp"
#include "support/cards.hpp"

namespace sightline {
namespace {

/// Alpha mode, both sides, cutoff in 255ths, whether there is a texture.
using Look = std::tuple<std::string, bool, int, bool>;
/// Triangles of the meshes that look so, each mesh once.
using Census = std::map<Look, std::multiset<std::uint64_t>>;

Look look_of(const Material& material) {
  static const char* const kModes[]{"OPAQUE", "MASK", "BLEND"};
  const bool cut_out = material.surface == Surface::cut_out;
  return {kModes[static_cast<std::size_t>(material.surface)], material.sides == Sides::both,
          cut_out ? material.alpha_cutoff : -1, cut_out && material.alpha_image != kNoAlphaImage};
}

Look look_of(const aiMaterial& material) {
  aiString mode("OPAQUE");
  bool both = false;
  ai_real cutoff = -1;
  material.Get(AI_MATKEY_GLTF_ALPHAMODE, mode);
  material.Get(AI_MATKEY_TWOSIDED, both);
  const bool masked = mode == aiString("MASK");
  if (masked) material.Get(AI_MATKEY_GLTF_ALPHACUTOFF, cutoff);
  return {mode.C_Str(), both, masked ? static_cast<int>(std::lround(255 * cutoff)) : -1,
          material.GetTextureCount(aiTextureType_BASE_COLOR) > 0};
}

Census census(const Scene& scene) {
  std::set<std::tuple<std::uint32_t, Look>> seen;
  Census out;
  for (ObjectId object = 0; object < scene.size(); ++object) {
    const Look look = look_of(scene.material(object));
    if (scene.triangles(object) != 0 && seen.emplace(scene.mesh[object], look).second)
      out[look].insert(scene.triangles(object));
  }
  return out;
}

Census census(const aiScene& scene) {
  Census out;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[i];
    out[look_of(*scene.mMaterials[mesh.mMaterialIndex])].insert(mesh.mNumFaces);
  }
  return out;
}

void expect_the_same_in_assimp(const Scene& scene) {
  SCOPED_TRACE(scene.name);
  const samples::TemporaryFolder folder;
  const std::string path = (folder / "scene.glb").string();
  write_glb(scene, path);
  Assimp::Importer importer;
  const aiScene* read = importer.ReadFile(path, 0);
  ASSERT_NE(read, nullptr) << importer.GetErrorString();
  EXPECT_EQ(census(*read), census(scene));
}

TEST(Assimp, SeesTheMaterialsThatWereWritten) {
  for (const Scene& scene : test::card_scenes()) expect_the_same_in_assimp(scene);
  for (const char* world : {"world:regular?columns=4&rows=4", "world:irregular?spheres=50",
                            "world:forest?trees=100", "world:foliage", "world:city?objects=2000"}) {
    expect_the_same_in_assimp(load_scene(world));
  }
}

TEST(Assimp, SeesTheMaterialsOfALevel) {
  if (!std::filesystem::exists("/usr/share/games/openarena/baseoa/pak1-maps.pk3"))
    GTEST_SKIP() << "install openarena-081-maps for the real levels";
  expect_the_same_in_assimp(load_scene("pak1-maps.pk3:maps/islandctf.bsp"));
}

}  // namespace
}  // namespace sightline
