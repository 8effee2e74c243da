// glTF that is broken, lies, or asks for too much.
#include <cstring>
#include <numeric>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sightline/workbench/io.hpp>

#include "sample_files.hpp"
#include "workbench/io/gltf_document.hpp"

namespace sightline {
namespace {

using namespace samples;
using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

std::string refusal_of_gltf(const Blob& bytes) {
  return error_of([&] { read_gltf(bytes, "sample.gltf"); });
}
std::string refusal(const json& document) {
  return refusal_of_gltf(to_bytes(document));
}

Blob sample_glb() {
  json document = one_triangle();
  document["buffers"][0].erase("uri");
  const std::vector<float> data{0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0};
  Blob binary(std::as_bytes(std::span(data)).begin(), std::as_bytes(std::span(data)).end());
  binary[38] = std::byte{1};
  binary[40] = std::byte{2};
  return to_glb(document, binary);
}

TEST(GltfHostile, EveryTruncationIsRefused) {
  for (const Blob& whole : {sample_glb(), to_bytes(one_triangle())}) {
    ASSERT_EQ(refusal_of_gltf(whole), "");
    for (std::size_t size = 0; size < whole.size(); ++size) {
      ASSERT_THAT(refusal_of_gltf({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}),
                  StartsWith("sample.gltf: "))
          << size;
    }
  }
}

TEST(GltfHostile, AnyByteMayBeAnything) {
  std::mt19937 random(13);
  for (const Blob& whole : {sample_glb(), to_bytes(one_triangle())}) {
    for (int round = 0; round < 5000; ++round) {
      Blob bytes = whole;
      for (int change = 0; change <= round % 3; ++change)
        bytes[random() % bytes.size()] = std::byte(random() & 0xff);
      const std::string said = refusal_of_gltf(bytes);
      if (!said.empty()) {
        ASSERT_THAT(said, HasSubstr("sample.gltf"));
      }
    }
  }
}

/// Every value of the document in turn becomes something else: no crash, and one sentence where it matters.
TEST(GltfHostile, EveryValueMayBeAnything) {
  const json whole = one_triangle().flatten();
  const std::vector<json> odd{nullptr,
                              true,
                              -1,
                              0,
                              1,
                              4294967295u,
                              4294967296u,
                              1e300,
                              -0.5,
                              9007199254740993u,
                              "",
                              "text",
                              json::array(),
                              json::object(),
                              json::array({1, 2, 3})};
  int refused = 0;
  for (const auto& [path, value] : whole.items()) {
    for (const json& other : odd) {
      json flat = whole;
      json document = flat.unflatten();
      document[json::json_pointer(path)] = other;
      const std::string said = refusal(document);
      if (!said.empty()) {
        ++refused;
        EXPECT_THAT(said, StartsWith("sample.gltf: ")) << path << " = " << other.dump();
      }
    }
  }
  EXPECT_GT(refused, 150);
}

TEST(GltfHostile, DeepNestingDoesNotOverflowTheStack) {
  constexpr std::size_t kDepth = 500'000;
  std::string brackets = R"({"asset":{"version":"2.0"},"extras":)";
  brackets.append(kDepth, '[');
  std::string closed = brackets;
  closed.append(kDepth, ']') += '}';
  EXPECT_THAT(refusal_of_gltf(to_bytes(closed)), HasSubstr("no triangle"));
  EXPECT_THAT(refusal_of_gltf(to_bytes(brackets)), HasSubstr("not JSON"));
  std::string objects;
  for (std::size_t i = 0; i < kDepth; ++i) objects += R"({"a":)";
  EXPECT_THAT(refusal_of_gltf(to_bytes(objects)), HasSubstr("not JSON"));
}

TEST(GltfHostile, CirclesAndSharedChildren) {
  json document = one_triangle();
  document["nodes"] = json::parse(R"([{"children": [1]}, {"children": [0], "mesh": 0}])");
  EXPECT_THAT(refusal(document), HasSubstr("reached twice"));
  document["nodes"] = json::parse(R"([{"children": [0]}])");
  EXPECT_THAT(refusal(document), HasSubstr("reached twice"));
  document["nodes"] =
      json::parse(R"([{"children": [1, 2]}, {"children": [3]}, {"children": [3]}, {"mesh": 0}])");
  EXPECT_THAT(refusal(document), HasSubstr("node 3 is reached twice"));
  document.erase("scenes");
  document["nodes"] = json::parse(R"([{"children": [1]}, {"children": [0], "mesh": 0}])");
  EXPECT_THAT(refusal(document), HasSubstr("no triangle"));
}

TEST(GltfHostile, VeryDeepHierarchyIsRefused) {
  json document = one_triangle();
  document["nodes"] = json::array();
  for (std::size_t i = 1; i < 20'000; ++i) document["nodes"].push_back({{"children", {i}}});
  document["nodes"].push_back({{"mesh", 0}});
  EXPECT_THAT(refusal(document), HasSubstr("deeper than"));
}

TEST(GltfHostile, HugeClaimsAllocateNothing) {
  json document = one_triangle();
  document["accessors"][0]["count"] = 4'000'000'000u;
  EXPECT_THAT(refusal(document), HasSubstr("accessor 0"));
  document["accessors"][0].erase("bufferView");
  EXPECT_THAT(refusal(document), HasSubstr("more than the file has bytes"));
  document = one_triangle();
  document["buffers"][0]["byteLength"] = 4'000'000'000u;
  EXPECT_THAT(refusal(document), HasSubstr("buffer 0"));
  document = one_triangle();
  document["bufferViews"][0]["byteLength"] = 4'294'967'295u;
  document["bufferViews"][0]["byteOffset"] = 4'294'967'295u;
  EXPECT_THAT(refusal(document), HasSubstr("accessor 0"));
  document = one_triangle();
  document["bufferViews"][0]["byteStride"] = 4'294'967'295u;
  EXPECT_THAT(refusal(document), HasSubstr("accessor 0"));
  document["bufferViews"][0]["byteStride"] = 4;
  EXPECT_THAT(refusal(document), HasSubstr("stride of 4"));
}

/// A thousand strips over one long list of vertices that no byte stands behind.
TEST(GltfHostile, UnfoldingIsBounded) {
  json document = one_triangle();
  const std::string padding(50'000, '\0');
  document["buffers"].push_back({{"byteLength", padding.size()}, {"uri", to_data_uri(to_bytes(padding))}});
  document["meshes"][0]["primitives"] = json::array();
  for (std::size_t i = 0; i < 1000; ++i) {
    document["accessors"].push_back({{"componentType", 5126}, {"type", "VEC3"}, {"count", 50'000}});
    document["meshes"][0]["primitives"].push_back(
        {{"attributes", {{"POSITION", document["accessors"].size() - 1}}}, {"mode", 5}});
  }
  EXPECT_THAT(refusal(document), HasSubstr("unfolds the file"));
}

/// The sample's buffer in a file beside it, spelt in so many ways.
json with_file(const TemporaryFolder& folder, std::size_t spellings) {
  json document = one_triangle();
  const std::vector<float> data{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
  write(folder / "a.bin", std::as_bytes(std::span(data)));
  std::string uri = "a.bin";
  document["buffers"] = json::array();
  for (std::size_t i = 0; i < spellings; ++i, uri.insert(0, "./"))
    document["buffers"].push_back({{"byteLength", 42}, {"uri", uri}});
  return document;
}

TEST(GltfHostile, AFileCountsOnceHoweverItIsSpelt) {
  const TemporaryFolder folder;
  json document = with_file(folder, 100);
  for (std::size_t i = 0; i < 100; ++i) document["buffers"].push_back(document["buffers"][i]);
  document["buffers"][7]["byteLength"] = 44;
  const Blob bytes = to_bytes(document);
  EXPECT_EQ(io::gltf::Document(bytes, folder.path()).buffer_bytes(), 44u);
  document["accessors"][0] = {{"componentType", 5126}, {"type", "VEC3"}, {"count", 45}};
  EXPECT_THAT(error_of([&] { read_gltf(to_bytes(document), "sample.gltf", folder.path()); }),
              HasSubstr("45 elements without a buffer view, more than the file has bytes"));
}

TEST(GltfHostile, AllFilesTogetherAreBounded) {
  const TemporaryFolder folder;
  json document = with_file(folder, 1);
  write(folder / "hole.bin", {});
  std::filesystem::resize_file(folder / "hole.bin", std::uintmax_t{1} << 32);
  document["buffers"].push_back({{"byteLength", 1}, {"uri", "hole.bin"}});
  EXPECT_EQ(error_of([&] { read_gltf(to_bytes(document), "sample.gltf", folder.path()); }),
            "sample.gltf: buffer 1 lies in 'hole.bin', which brings all files together over 4 GiB");
}

/// Many primitives, each with an accessor of its own, that all name one list of a thousand indices.
TEST(GltfHostile, SharedSparseIndicesAreBounded) {
  constexpr std::uint16_t kIndices = 1000;
  std::vector<std::uint16_t> indices(kIndices);
  std::iota(indices.begin(), indices.end(), std::uint16_t{0});
  const Blob values(12 * std::size_t{kIndices});
  json document = one_triangle();
  document["buffers"].push_back(
      {{"byteLength", 2 * kIndices}, {"uri", to_data_uri(std::as_bytes(std::span(indices)))}});
  document["buffers"].push_back({{"byteLength", values.size()}, {"uri", to_data_uri(values)}});
  document["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 2 * kIndices}});
  document["bufferViews"].push_back({{"buffer", 2}, {"byteLength", values.size()}});
  const json sparse{{"count", kIndices},
                    {"indices", {{"bufferView", 2}, {"componentType", 5123}}},
                    {"values", {{"bufferView", 3}}}};
  const auto use = [&](std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) {
      document["meshes"][0]["primitives"].push_back(
          {{"attributes", {{"POSITION", document["accessors"].size()}}}, {"indices", 1}});
      document["accessors"].push_back(
          {{"componentType", 5126}, {"type", "VEC3"}, {"count", kIndices}, {"sparse", sparse}});
    }
    return refusal(document);
  };
  EXPECT_EQ(use(64), "");
  EXPECT_THAT(use(1000), HasSubstr("has more sparse indices than the file's size can stand for"));
}

TEST(GltfHostile, IndicesBeyondThePositions) {
  json document = one_triangle();
  document["accessors"][0]["count"] = 2;
  EXPECT_THAT(refusal(document), HasSubstr("index 2"));
  document = one_triangle();
  document["accessors"][1]["componentType"] = 5126;
  EXPECT_NE(refusal(document), "");
}

TEST(GltfHostile, UnknownRequiredExtensionIsRefused) {
  json document = one_triangle();
  document["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  EXPECT_THAT(refusal(document), HasSubstr("KHR_draco_mesh_compression"));
}

TEST(GltfHostile, NumbersThatAreNone) {
  json document = one_triangle();
  std::vector<float> positions{0, 0, 0, 1, 0, 0, 0, std::numeric_limits<float>::quiet_NaN(), 0, 0, 0};
  document["buffers"][0]["uri"] = to_data_uri(std::as_bytes(std::span(positions)));
  document["meshes"][0]["primitives"][0].erase("indices");
  EXPECT_THAT(refusal(document), HasSubstr("position 2 that is not finite"));
  document = one_triangle();
  document["nodes"][0]["scale"] = {1e38, 1e38, 1e38};
  document["nodes"].push_back({{"children", {0}}, {"scale", {1e38, 1, 1}}});
  document["scenes"][0]["nodes"] = {1};
  EXPECT_THAT(refusal(document), HasSubstr("object 0"));
}

TEST(GltfHostile, TransformsThatTheFormatForbids) {
  const auto said = [](const std::string& node) {
    json document = one_triangle();
    document["nodes"][0].update(json::parse(node));
    return refusal(document);
  };
  EXPECT_EQ(said(R"({"matrix": [1,0,0,0, 0,1,0,0.5, 0,0,1,0, 0,0,0,2]})"),
            "sample.gltf: node 0 has 'matrix' with the last row 0 0.5 0 2, expected 0 0 0 1");
  EXPECT_THAT(said(R"({"matrix": [1,0,0,1e-5, 0,1,0,0, 0,0,1,0, 0,0,0,1]})"), HasSubstr("the last row"));
  EXPECT_THAT(said(R"({"matrix": [0,0,0,0, 0,0,0,0, 0,0,0,0, 0,0,0,0]})"), HasSubstr("the last row"));
  EXPECT_EQ(said(R"({"rotation": [0, 0, 0, 5]})"),
            "sample.gltf: node 0 has 'rotation' of length 5, expected a quaternion of length 1");
  for (const std::string turn : {"0, 0, 0, 0", "0, 0, 0, 1.011", "0, 0.989, 0, 0", "1e300, 0, 0, 1e300"})
    EXPECT_THAT(said(R"({"rotation": [)" + turn + "]}"), HasSubstr("'rotation' of length")) << turn;
  const std::string matrix = R"({"matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1], )";
  for (const std::string part :
       {R"("translation": [0, 0, 0])", R"("rotation": [0, 0, 0, 1])", R"("scale": [1, 1, 1])"})
    EXPECT_THAT(said(matrix + part + "}"), HasSubstr("node 0 has 'matrix' beside")) << part;
}

TEST(GltfHostile, SparseIndicesMustAscendWithinTheCount) {
  for (const std::vector<std::uint16_t>& indices : {std::vector<std::uint16_t>{1, 1}, {2, 1}, {1, 3}}) {
    json document = one_triangle();
    document["buffers"].push_back(
        {{"byteLength", 4}, {"uri", to_data_uri(std::as_bytes(std::span(indices)))}});
    document["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 4}});
    document["accessors"][0]["sparse"] = {{"count", 2},
                                          {"indices", {{"bufferView", 2}, {"componentType", 5123}}},
                                          {"values", {{"bufferView", 0}}}};
    EXPECT_THAT(refusal(document), HasSubstr("do not ascend"));
  }
}

TEST(GltfHostile, WrongVersionsAndContainers) {
  json document = one_triangle();
  document["asset"]["version"] = "1.0";
  EXPECT_THAT(refusal(document), HasSubstr("version '1.0'"));
  Blob glb = sample_glb();
  glb[4] = std::byte{1};
  EXPECT_THAT(refusal_of_gltf(glb), HasSubstr("GLB version 1"));
  glb = sample_glb();
  glb[16] = std::byte{'X'};
  EXPECT_THAT(refusal_of_gltf(glb), HasSubstr("no JSON in its first chunk"));
  glb = sample_glb();
  std::memset(&glb[8], 0xff, 4);
  EXPECT_THAT(refusal_of_gltf(glb), HasSubstr("says it is"));
}

}  // namespace
}  // namespace sightline
