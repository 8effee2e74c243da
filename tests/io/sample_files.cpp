#include "sample_files.hpp"

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include <zip.h>

namespace sightline::samples {

using namespace io::quake3;

namespace {

VertexRecord vertex(float x, float y, float z, Float3 normal) {
  return {{x, y, z}, {}, normal, 0};
}

FaceRecord face(std::int32_t type, std::int32_t first_vertex, std::int32_t vertex_count,
                std::int32_t first_index, std::int32_t index_count, std::int32_t shader = 0) {
  FaceRecord out{};
  out.shader = shader;
  out.type = type;
  out.first_vertex = first_vertex;
  out.vertex_count = vertex_count;
  out.first_mesh_vertex = first_index;
  out.mesh_vertex_count = index_count;
  return out;
}

void append(Blob& to, const void* data, std::size_t size) {
  const auto* bytes = static_cast<const std::byte*>(data);
  to.insert(to.end(), bytes, bytes + size);
}

void append_number(Blob& to, std::uint32_t value) {
  append(to, &value, sizeof value);
}

}  // namespace

Level two_rooms() {
  Level level;
  level.entities =
      "{\n\"classname\" \"worldspawn\"\n\"message\" \"two rooms\"\n}\n"
      "{\n\"classname\" \"info_player_deathmatch\"\n\"origin\" \"64 0 24\"\n\"angle\" \"90\"\n}\n"
      "{\n\"classname\" \"info_player_deathmatch\"\n\"origin\" \"-64 0 24\"\n\"angles\" \"0 180 0\"\n}\n"
      "{\n\"classname\" \"weapon_railgun\"\n\"origin\" \"32 32 16\"\n}\n"
      "{\n\"classname\" \"func_door\"\n\"model\" \"*1\"\n\"origin\" \"0 100 0\"\n}\n"
      "{\n\"classname\" \"light\"\n\"origin\" \"0 0 0\"\n}\n"
      "{\n\"classname\" \"info_player_deathmatch\"\n\"origin\" \"nowhere\"\n}\n";
  level.shaders = {{{"textures/wall"}, 0, 1}, {{"textures/glass"}, 0, 0x20000001}};
  level.planes = {{{1, 0, 0}, 0}};
  level.nodes = {{0, -1, -2, {-128, -128, -128}, {128, 128, 128}}};
  level.leaves = {{0, 0, {0, -128, -128}, {128, 128, 128}, 0, 3, 0, 0},
                  {1, 0, {-128, -128, -128}, {0, 128, 128}, 3, 2, 0, 0},
                  {0, 0, {0, 0, 0}, {1, 1, 1}, 5, 1, 0, 0}};
  level.leaf_faces = {0, 3, 4, 1, 2, 5};
  level.models = {{{-128, -128, -128}, {128, 128, 128}, 0, 5, 0, 0}, {{0, 0, 0}, {1, 1, 1}, 5, 1, 0, 0}};
  // 0 … 3: the wall, by its indices clockwise as seen from its front (from smaller x).
  const Float3 towards_room{-1, 0, 0};
  level.vertices = {vertex(128, -64, 0, towards_room), vertex(128, -64, 64, towards_room),
                    vertex(128, 64, 64, towards_room), vertex(128, 64, 0, towards_room)};
  // 4 … 12: a patch that bulges upwards.
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      level.vertices.push_back(vertex(-128.0f + 32 * static_cast<float>(column), 32 * static_cast<float>(row),
                                      column == 1 ? 64.0f : 0.0f, {0, 0, 1}));
    }
  }
  // 13 … 15: a triangle; 16 a lone vertex; 17 … 19 the door.
  for (const float lift : {8.0f, 16.0f}) {
    if (lift == 16) level.vertices.push_back(vertex(4, 4, 4, {0, 0, 1}));
    const float x = lift == 8 ? -40.0f : 40.0f;
    level.vertices.push_back(vertex(x, 0, lift, {0, 0, 1}));
    level.vertices.push_back(vertex(x, 20, lift, {0, 0, 1}));
    level.vertices.push_back(vertex(x + 20, 0, lift, {0, 0, 1}));
  }
  level.mesh_vertices = {0, 2, 1, 0, 3, 2, 0, 1, 2};
  level.faces = {face(polygon, 0, 4, 0, 6), face(patch, 4, 9, 0, 0),    face(triangles, 13, 3, 6, 3, 1),
                 face(flare, 0, 0, 0, 0),   face(polygon, 16, 1, 0, 0), face(polygon, 17, 3, 6, 3)};
  level.faces[1].patch_width = level.faces[1].patch_height = 3;
  level.faces[3].light_map_origin = {100, 50, 25};
  level.visibility = {2, 0, 0, 0, 1, 0, 0, 0, 0b01, 0b11};
  return level;
}

Blob to_bsp(const Level& level) {
  constexpr std::size_t kLumps = static_cast<std::size_t>(LumpId::count);
  Blob body;
  std::array<std::array<std::uint32_t, 2>, kLumps> directory{};
  const auto add = [&](LumpId id, const auto& values) {
    while (body.size() % 4 != 0) body.push_back({});
    const std::size_t size = values.size() * sizeof(values[0]);
    directory[static_cast<std::size_t>(id)] = {static_cast<std::uint32_t>(8 + 8 * kLumps + body.size()),
                                               static_cast<std::uint32_t>(size)};
    append(body, values.data(), size);
  };
  add(LumpId::entities, level.entities);
  add(LumpId::shaders, level.shaders);
  add(LumpId::planes, level.planes);
  add(LumpId::nodes, level.nodes);
  add(LumpId::leaves, level.leaves);
  add(LumpId::leaf_faces, level.leaf_faces);
  add(LumpId::models, level.models);
  add(LumpId::vertices, level.vertices);
  add(LumpId::mesh_vertices, level.mesh_vertices);
  add(LumpId::faces, level.faces);
  add(LumpId::visibility, level.visibility);
  Blob out;
  append(out, "IBSP", 4);
  append_number(out, 46);
  append(out, directory.data(), sizeof directory);
  append(out, body.data(), body.size());
  return out;
}

Blob to_pk3(const std::string& entry, std::span<const std::byte> content) {
  return to_pk3({{entry, Blob(content.begin(), content.end())}});
}

Blob to_pk3(const std::vector<std::pair<std::string, Blob>>& entries) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* memory = zip_source_buffer_create(nullptr, 0, 0, &error);
  zip_source_keep(memory);
  zip_t* archive = zip_open_from_source(memory, ZIP_TRUNCATE, &error);
  bool good = true;
  for (const auto& [name, content] : entries) {
    zip_source_t* source = zip_source_buffer(archive, content.data(), content.size(), 0);
    good = good && zip_file_add(archive, name.c_str(), source, 0) >= 0;
  }
  if (!good || zip_close(archive) != 0) throw std::runtime_error("cannot make the sample archive");
  zip_stat_t stat;
  zip_source_stat(memory, &stat);
  Blob out(stat.size);
  zip_source_open(memory);
  zip_source_read(memory, out.data(), out.size());
  zip_source_close(memory);
  zip_source_free(memory);
  return out;
}

std::string to_data_uri(std::span<const std::byte> bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out = "data:application/octet-stream;base64,";
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (i + k < bytes.size() ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0);
    }
    for (std::size_t k = 0; k < 4; ++k)
      out.push_back(i + k <= bytes.size() ? kDigits[bits >> (18 - 6 * k) & 63] : '=');
  }
  return out;
}

nlohmann::json one_triangle() {
  const std::array<float, 9> positions{0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::array<std::uint16_t, 3> indices{0, 1, 2};
  Blob data;
  append(data, positions.data(), sizeof positions);
  append(data, indices.data(), sizeof indices);
  nlohmann::json json = nlohmann::json::parse(R"({
    "asset": {"version": "2.0"},
    "scene": 0,
    "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
    "accessors": [
      {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3},
      {"bufferView": 1, "componentType": 5123, "type": "SCALAR", "count": 3}
    ],
    "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
    "buffers": [{"byteLength": 42}]
  })");
  json["buffers"][0]["uri"] = to_data_uri(data);
  return json;
}

Blob to_bytes(const std::string& text) {
  Blob out;
  append(out, text.data(), text.size());
  return out;
}

Blob to_bytes(const nlohmann::json& document) {
  return to_bytes(document.dump());
}

Blob to_glb(const nlohmann::json& document, std::span<const std::byte> binary) {
  std::string json = document.dump();
  json.resize((json.size() + 3) / 4 * 4, ' ');
  Blob out;
  append(out, "glTF", 4);
  append_number(out, 2);
  append_number(out, static_cast<std::uint32_t>(28 + json.size() + binary.size()));
  append_number(out, static_cast<std::uint32_t>(json.size()));
  append(out, "JSON", 4);
  append(out, json.data(), json.size());
  append_number(out, static_cast<std::uint32_t>(binary.size()));
  append(out, "BIN\0", 4);
  append(out, binary.data(), binary.size());
  return out;
}

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "sightline_test_XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("cannot make a temporary folder");
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

void write(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace sightline::samples
