// glTF written by hand: each feature the reader knows.
#include <cmath>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sightline/workbench/io.hpp>

#include "sample_files.hpp"

namespace sightline {
namespace {

using namespace samples;
using nlohmann::json;
using testing::HasSubstr;

Scene read(const json& document) {
  return read_gltf(to_bytes(document), "sample.gltf");
}

/// Adds a buffer, a view and an accessor over the values; the accessor's index.
template <class T>
std::size_t add_accessor(json& document, const std::vector<T>& values, int component_type, const char* type,
                         std::size_t count) {
  const auto bytes = std::as_bytes(std::span(values));
  document["buffers"].push_back({{"byteLength", bytes.size()}, {"uri", to_data_uri(bytes)}});
  document["bufferViews"].push_back(
      {{"buffer", document["buffers"].size() - 1}, {"byteLength", bytes.size()}});
  document["accessors"].push_back({{"bufferView", document["bufferViews"].size() - 1},
                                   {"componentType", component_type},
                                   {"type", type},
                                   {"count", count}});
  return document["accessors"].size() - 1;
}

/// Five points of a plane, x along the row, for strips and fans: (0,0) (0,1) (1,0) (1,1) (2,0).
std::size_t add_row(json& document) {
  return add_accessor<float>(document, {0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 2, 0, 0}, 5126, "VEC3", 5);
}

TEST(Gltf, OneTriangle) {
  const Scene scene = read(one_triangle());
  ASSERT_EQ(scene.size(), 1u);
  EXPECT_EQ(scene.bounds[0], (Box{{0, 0, 0}, {1, 1, 0}}));
  EXPECT_EQ(scene.indices, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(scene.normals[0], (Vec3{0, 0, 1})) << "computed, for the file has none";
  EXPECT_EQ(scene.surface[0], Surface::opaque);
  EXPECT_EQ(scene.name, "sample.gltf");
}

TEST(Gltf, BinaryContainer) {
  json document = one_triangle();
  const std::vector<float> data{0, 0, 0, 2, 0, 0, 0, 2, 0};
  Blob binary(std::as_bytes(std::span(data)).begin(), std::as_bytes(std::span(data)).end());
  for (const int index : {0, 1, 2}) {
    binary.push_back(std::byte(index));
    binary.push_back({});
  }
  binary.resize(44);
  document["buffers"][0].erase("uri");
  EXPECT_EQ(read_gltf(to_glb(document, binary), "sample.glb").bounds[0].max.x, 2);
}

TEST(Gltf, HierarchyMultipliesFromTheRoot) {
  json document = one_triangle();
  // Scale by 2 after moving by (1, 0, 0); the parent turns by 90° about y: x becomes -z.
  document["nodes"] = json::parse(R"([
    {"rotation": [0, 0.7071067811865476, 0, 0.7071067811865476], "children": [1]},
    {"translation": [1, 0, 0], "scale": [2, 2, 2], "mesh": 0}])");
  const Box box = read(document).bounds[0];
  EXPECT_NEAR(box.min.z, -3, 1e-6);
  EXPECT_NEAR(box.max.z, -1, 1e-6);
  EXPECT_NEAR(box.max.y, 2, 1e-6);
  EXPECT_NEAR(box.max.x, 0, 1e-6);
}

TEST(Gltf, MatrixIsColumnMajor) {
  json document = one_triangle();
  document["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 3, 0, 0, 0, 0, 1, 0, 10, 20, 30, 1};
  EXPECT_EQ(read(document).bounds[0], (Box{{10, 20, 30}, {11, 23, 30}}));
}

TEST(Gltf, TransformsMayBeRounded) {
  json document = one_triangle();
  json& node = document["nodes"][0];
  node["matrix"] = {1, 0, 0, 1e-7, 0, 3, 0, -1e-7, 0, 0, 1, 0, 10, 20, 30, 1.0000001};
  EXPECT_EQ(read(document).bounds[0], (Box{{10, 20, 30}, {11, 23, 30}}));
  node.erase("matrix");
  for (const double length : {0.991, 1.009}) {
    node["rotation"] = {0, 0, length, 0};
    const Box box = read(document).bounds[0];
    EXPECT_NEAR(box.min.x, -1, 1e-6);
    EXPECT_NEAR(box.min.y, -1, 1e-6);
  }
}

TEST(Gltf, WithoutScenesTheRootsAreShown) {
  json document = one_triangle();
  document.erase("scene");
  document.erase("scenes");
  document["nodes"] = json::parse(R"([{"mesh": 0}, {"children": [0, 2]}, {"mesh": 0}])");
  EXPECT_EQ(read(document).size(), 2u);
}

TEST(Gltf, NodesShareMeshes) {
  json document = one_triangle();
  document["nodes"] = json::parse(R"([{"mesh": 0}, {"mesh": 0, "translation": [5, 0, 0]}, {"mesh": 1}])");
  document["scenes"][0]["nodes"] = {0, 1, 2};
  document["meshes"].push_back(document["meshes"][0]);
  const Scene scene = read(document);
  EXPECT_EQ(scene.size(), 3u);
  EXPECT_EQ(scene.meshes.size(), 1u) << "primitives that are the same share a mesh";
}

TEST(Gltf, InstancesBecomeObjects) {
  json document = one_triangle();
  const std::size_t translation = add_accessor<float>(document, {1, 0, 0, 2, 0, 0, 3, 0, 0}, 5126, "VEC3", 3);
  const std::size_t scale = add_accessor<float>(document, {1, 1, 1, 2, 2, 2, 3, 3, 3}, 5126, "VEC3", 3);
  const std::size_t rotation =
      add_accessor<std::int16_t>(document, {0, 0, 0, 32767, 0, 0, 0, 32767, 0, 32767, 0, 0}, 5122, "VEC4", 3);
  document["accessors"][rotation]["normalized"] = true;
  document["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  document["nodes"][0]["translation"] = {0, 10, 0};
  document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", translation}, {"ROTATION", rotation}, {"SCALE", scale}};
  const Scene scene = read(document);
  ASSERT_EQ(scene.size(), 3u);
  EXPECT_EQ(scene.bounds[0], (Box{{1, 10, 0}, {2, 11, 0}}));
  EXPECT_EQ(scene.bounds[1], (Box{{2, 10, 0}, {4, 12, 0}}));
  EXPECT_EQ(scene.bounds[2], (Box{{0, 10, 0}, {3, 13, 0}})) << "half a turn about y";
}

TEST(Gltf, IndexTypesAndNone) {
  for (const int type : {5121, 5123, 5125}) {
    json document = one_triangle();
    std::size_t accessor = 0;
    if (type == 5121) accessor = add_accessor<std::uint8_t>(document, {2, 0, 1}, type, "SCALAR", 3);
    if (type == 5123) accessor = add_accessor<std::uint16_t>(document, {2, 0, 1}, type, "SCALAR", 3);
    if (type == 5125) accessor = add_accessor<std::uint32_t>(document, {2, 0, 1}, type, "SCALAR", 3);
    document["meshes"][0]["primitives"][0]["indices"] = accessor;
    EXPECT_EQ(read(document).indices, (std::vector<std::uint32_t>{2, 0, 1})) << type;
  }
  json document = one_triangle();
  document["meshes"][0]["primitives"][0].erase("indices");
  EXPECT_EQ(read(document).indices, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(Gltf, StripsAndFansKeepTheirWinding) {
  json document = one_triangle();
  json& primitive = document["meshes"][0]["primitives"][0];
  primitive.erase("indices");
  primitive["attributes"]["POSITION"] = add_row(document);
  document["meshes"][0]["primitives"][0]["mode"] = 5;
  Scene scene = read(document);
  EXPECT_EQ(scene.indices, (std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2, 2, 3, 4}));
  for (const Vec3& normal : scene.normals) EXPECT_EQ(normal, (Vec3{0, 0, -1}));
  document["meshes"][0]["primitives"][0]["mode"] = 6;
  scene = read(document);
  EXPECT_EQ(scene.indices, (std::vector<std::uint32_t>{1, 2, 0, 2, 3, 0, 3, 4, 0}));
}

TEST(Gltf, PointsAndLinesAreLeftOut) {
  for (const int mode : {0, 1, 2, 3}) {
    json document = one_triangle();
    document["meshes"][0]["primitives"].push_back(document["meshes"][0]["primitives"][0]);
    document["meshes"][0]["primitives"][1]["mode"] = mode;
    EXPECT_EQ(read(document).size(), 1u);
  }
}

TEST(Gltf, OnlyUsedVerticesCount) {
  json document = one_triangle();
  document["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = add_row(document);
  document["meshes"][0]["primitives"][0]["indices"] =
      add_accessor<std::uint8_t>(document, {4, 2, 3}, 5121, "SCALAR", 3);
  const Scene scene = read(document);
  EXPECT_EQ(scene.positions.size(), 3u);
  EXPECT_EQ(scene.bounds[0], (Box{{1, 0, 0}, {2, 1, 0}}));
}

TEST(Gltf, StrideAndOffset) {
  json document = one_triangle();
  // Each position is followed by a float that is none of ours; the first element is skipped.
  document["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
      add_accessor<float>(document, {9, 9, 9, 9, 0, 0, 0, 9, 4, 0, 0, 9, 0, 4, 0, 9}, 5126, "VEC3", 3);
  document["bufferViews"].back()["byteStride"] = 16;
  document["accessors"].back()["byteOffset"] = 16;
  EXPECT_EQ(read(document).bounds[0], (Box{{0, 0, 0}, {4, 4, 0}}));
}

TEST(Gltf, SparseAccessors) {
  json document = one_triangle();
  add_accessor<std::uint16_t>(document, {1, 2}, 5123, "SCALAR", 2);
  add_accessor<float>(document, {7, 0, 0, 0, 8, 0}, 5126, "VEC3", 2);
  const json sparse = {{"count", 2},
                       {"indices", {{"bufferView", 2}, {"componentType", 5123}}},
                       {"values", {{"bufferView", 3}}}};
  document["accessors"][0]["sparse"] = sparse;
  EXPECT_EQ(read(document).bounds[0], (Box{{0, 0, 0}, {7, 8, 0}}));
  document["accessors"][0].erase("bufferView");
  EXPECT_EQ(read(document).bounds[0], (Box{{0, 0, 0}, {7, 8, 0}})) << "what is not replaced is zero";
}

TEST(Gltf, QuantisedPositions) {
  json document = one_triangle();
  const std::size_t accessor =
      add_accessor<std::uint16_t>(document, {0, 0, 0, 0, 65535, 0, 0, 0, 0, 65535, 0, 0}, 5123, "VEC3", 3);
  document["bufferViews"].back()["byteStride"] = 8;
  document["accessors"].back()["normalized"] = true;
  document["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = accessor;
  document["extensionsRequired"] = {"KHR_mesh_quantization"};
  EXPECT_EQ(read(document).bounds[0], (Box{{0, 0, 0}, {1, 1, 0}}));
}

TEST(Gltf, GivenNormalsAreKept) {
  json document = one_triangle();
  document["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
      add_accessor<float>(document, {1, 0, 0, 0, 3, 0, 0, 0, 0}, 5126, "VEC3", 3);
  const Scene scene = read(document);
  EXPECT_EQ(scene.normals, (std::vector<Vec3>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
}

TEST(Gltf, CamerasAreViewpoints) {
  json document = one_triangle();
  document["cameras"] = json::parse(R"([
    {"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}, "name": "eye"},
    {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 1}}])");
  document["nodes"].push_back({{"camera", 0}, {"translation", {1, 2, 3}}});
  document["nodes"].push_back({{"camera", 1}});
  document["scenes"][0]["nodes"] = {0, 1, 2};
  const Scene scene = read(document);
  ASSERT_EQ(scene.viewpoints.size(), 1u);
  EXPECT_EQ(scene.viewpoints[0].name, "eye");
  EXPECT_EQ(scene.viewpoints[0].eye, (Vec3{1, 2, 3}));
  EXPECT_EQ(scene.viewpoints[0].forward, (Vec3{0, 0, -1}));
}

TEST(Gltf, FarAwayPositionsCountFromAnOriginNearby) {
  json document = one_triangle();
  // Half a metre is below what floats tell apart at 10,000 km.
  document["nodes"] = json::parse(R"([{"translation": [1e7, 0, -2e7], "children": [1]},
    {"translation": [0.5, 10, 0.25], "mesh": 0}, {"translation": [10000003, 1, -20000000], "camera": 0}])");
  document["scenes"][0]["nodes"] = {0, 2};
  document["cameras"] = json::parse(R"([{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}])");
  const Scene scene = read(document);
  EXPECT_NEAR(scene.origin.x, 1e7, 200);
  EXPECT_EQ(scene.origin.y, 0);
  EXPECT_EQ(std::fmod(scene.origin.x, 256), 0);
  const double x = scene.origin.x + scene.bounds[0].min.x, z = scene.origin.z + scene.bounds[0].min.z;
  EXPECT_EQ(x, 1e7 + 0.5);
  EXPECT_EQ(z, -2e7 + 0.25);
  EXPECT_EQ(scene.bounds[0].max.x - scene.bounds[0].min.x, 1);
  EXPECT_EQ(scene.origin.x + scene.viewpoints[0].eye.x, 10000003);
  // A scene around 0 stays there, and so does one that is merely off its centre.
  document["nodes"][0]["translation"] = {900, 0, 0};
  document["nodes"][2]["translation"] = {0, 0, 0};
  EXPECT_EQ(read(document).origin, WorldPoint{});
}

TEST(Gltf, SaysWhatItLeavesOut) {
  json document = one_triangle();
  EXPECT_TRUE(read(document).ignored.empty());
  document["skins"] = json::parse(R"([{"joints": [0]}, {"joints": [0]}])");
  document["animations"] = json::parse(R"([{"channels": [], "samplers": []}])");
  document["meshes"][0]["primitives"][0]["targets"] = json::parse(R"([{"POSITION": 0}])");
  EXPECT_THAT(read(document).ignored,
              testing::ElementsAre(testing::StartsWith("2 skins: "),
                                   testing::StartsWith("morph targets of 1 primitives: "),
                                   testing::StartsWith("1 animations: ")));
}

TEST(Gltf, BuffersBesideTheFile) {
  const TemporaryFolder folder;
  json document = one_triangle();
  const std::vector<float> positions{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
  std::filesystem::create_directory(folder / "data here");
  write(folder / "data here/a.bin", std::as_bytes(std::span(positions)));
  document["buffers"][0]["uri"] = "data%20here/a.bin";
  document["meshes"][0]["primitives"][0].erase("indices");
  EXPECT_EQ(read_gltf(to_bytes(document), "sample.gltf", folder.path()).size(), 1u);
  EXPECT_THAT(error_of([&] { read(document); }), HasSubstr("expected all data within this one"));
}

TEST(Gltf, BuffersNeverComeFromOutsideTheFolder) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "inner");
  write(folder / "secret.bin", Blob(100));
  std::filesystem::create_symlink(folder / "secret.bin", folder / "inner/link.bin");
  const std::string absolute = (folder / "secret.bin").string();
  for (const std::string& uri :
       {std::string("../secret.bin"), std::string("%2e%2e/secret.bin"), absolute, "file://" + absolute,
        std::string("a/../../secret.bin"), std::string("link.bin"), std::string(""), std::string("."),
        std::string("missing.bin")}) {
    json document = one_triangle();
    document["buffers"][0]["uri"] = uri;
    EXPECT_THAT(error_of([&] { read_gltf(to_bytes(document), "sample.gltf", folder / "inner"); }),
                HasSubstr("sample.gltf: buffer 0"))
        << uri;
  }
}

}  // namespace
}  // namespace sightline
