// Scenes as GLB. The binary chunk is the scene's own arrays, then the instances' transforms and the images.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <ranges>
#include <set>
#include <tuple>
#include <vector>

#include <fmt/format.h>

#include <sightline/workbench/io.hpp>

#include "workbench/io/alpha_png.hpp"
#include "workbench/io/files.hpp"
#include "workbench/io/gltf_document.hpp"
#include "workbench/io/gltf_transform.hpp"

namespace sightline {

namespace io::gltf {

namespace {

constexpr int kVertexData = 34962, kIndexData = 34963;
constexpr int kNearest = 9728, kRepeat = 10497;

enum View { positions_view, normals_view, indices_view, coordinates_view, instances_view };

Json vec3(const Vec3& v) {
  return Json::array({v.x, v.y, v.z});
}

/// What tells materials apart: surface, sides, image, cutoff.
using MaterialKey = std::tuple<Surface, Sides, std::uint32_t, std::uint8_t>;

/// A cut-out's alpha is the only one that matters.
MaterialKey key_of(const Material& material) {
  const bool cut_out = material.surface == Surface::cut_out;
  return {material.surface, material.sides, cut_out ? material.alpha_image : kNoAlphaImage,
          cut_out ? material.alpha_cutoff : Material().alpha_cutoff};
}

class GlbWriter {
public:
  explicit GlbWriter(const Scene& scene) : scene_(scene) {}

  Json document() {
    root_["asset"] = {{"version", "2.0"}, {"generator", "sightline"}};
    for (const char* kind : {"materials", "nodes", "meshes", "accessors", "bufferViews"})
      root_[kind] = Json::array();
    add_objects();
    add_viewpoints();
    add_buffers();
    add_scene();
    return std::move(root_);
  }

  /// The binary chunk, piece by piece: the views in their order, then the images.
  [[nodiscard]] std::vector<std::span<const std::byte>> pieces() const {
    std::vector<std::span<const std::byte>> out{
        std::as_bytes(std::span(scene_.positions)), std::as_bytes(std::span(scene_.normals)),
        std::as_bytes(std::span(scene_.indices)), std::as_bytes(std::span(scene_.texture_coordinates)),
        std::as_bytes(std::span(instances_))};
    for (const std::vector<std::byte>& image : images_) out.push_back(image);
    return out;
  }

private:
  struct Accessors {
    Json attributes;
    std::size_t indices = 0;
  };

  /// Objects by mesh and material: a glTF primitive holds its material.
  void add_objects() {
    std::map<std::pair<std::uint32_t, MaterialKey>, std::vector<ObjectId>> groups;
    std::set<MaterialKey> materials;
    for (ObjectId object = 0; object < scene_.size(); ++object) {
      if (scene_.triangles(object) == 0) continue;
      const MaterialKey material = key_of(scene_.material(object));
      materials.insert(material);
      groups[{scene_.mesh[object], material}].push_back(object);
      if (std::get<2>(material) != kNoAlphaImage) shows_image_.insert(scene_.mesh[object]);
    }
    add_materials(materials);
    for (const auto& [key, objects] : groups) {
      const std::size_t mesh = add_mesh(key.first, key.second);
      std::vector<ObjectId> instanced;
      std::vector<Parts> parts;
      for (const ObjectId object : objects) {
        Parts of_object;
        if (objects.size() > 1 && decompose(scene_.transform[object], of_object)) {
          instanced.push_back(object);
          parts.push_back(of_object);
        } else {
          add_node(mesh, object);
        }
      }
      if (!instanced.empty()) add_instances(mesh, instanced, parts);
    }
  }

  /// Both the images, in their order, and the materials that show them.
  void add_materials(const std::set<MaterialKey>& materials) {
    std::map<std::uint32_t, std::size_t> texture_of;
    for (const MaterialKey& material : materials) {
      if (std::get<2>(material) != kNoAlphaImage) texture_of.emplace(std::get<2>(material), 0);
    }
    for (auto& [image, texture] : texture_of) {
      texture = images_.size();
      images_.push_back(write_alpha(scene_.alpha_images[image]));
      images_.back().resize((images_.back().size() + 3) / 4 * 4);
      root_["textures"].push_back({{"source", texture}, {"sampler", 0}});
    }
    if (!texture_of.empty()) {
      root_["samplers"] = Json::array(
          {{{"magFilter", kNearest}, {"minFilter", kNearest}, {"wrapS", kRepeat}, {"wrapT", kRepeat}}});
    }
    for (const MaterialKey& key : materials) {
      const auto& [surface, sides, image, cutoff] = key;
      static constexpr std::array kModes{"OPAQUE", "MASK", "BLEND"};
      Json material = {{"alphaMode", kModes[static_cast<std::size_t>(surface)]},
                       {"doubleSided", sides == Sides::both},
                       {"pbrMetallicRoughness", {{"metallicFactor", 0}}}};  // or else it is of metal
      if (surface == Surface::cut_out) material["alphaCutoff"] = cutoff / 255.0;
      if (image != kNoAlphaImage)
        material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", texture_of.at(image)}};
      material_numbers_.emplace(key, root_["materials"].size());
      root_["materials"].push_back(std::move(material));
    }
  }

  std::size_t add_mesh(std::uint32_t mesh, const MaterialKey& material) {
    const auto [place, added] = accessors_.try_emplace(mesh);
    if (added) place->second = add_accessors(mesh);
    Json primitive = {{"attributes", place->second.attributes},
                      {"indices", place->second.indices},
                      {"material", material_numbers_.at(material)}};
    root_["meshes"].push_back({{"primitives", Json::array({std::move(primitive)})}});
    return root_["meshes"].size() - 1;
  }

  Accessors add_accessors(std::uint32_t number) {
    const Mesh& mesh = scene_.meshes[number];
    Vec3 least = scene_.positions[mesh.first_vertex], greatest = least;
    for (std::uint32_t i = 0; i < mesh.vertex_count; ++i) {
      const Vec3& p = scene_.positions[mesh.first_vertex + i];
      least = {std::min(least.x, p.x), std::min(least.y, p.y), std::min(least.z, p.z)};
      greatest = {std::max(greatest.x, p.x), std::max(greatest.y, p.y), std::max(greatest.z, p.z)};
    }
    const std::size_t vertex_at = sizeof(Vec3) * std::size_t{mesh.first_vertex};
    const std::size_t positions = add_accessor(positions_view, vertex_at, kFloat, "VEC3", mesh.vertex_count);
    root_["accessors"].back()["min"] = vec3(least);
    root_["accessors"].back()["max"] = vec3(greatest);
    Accessors out;
    out.attributes = {{"POSITION", positions},
                      {"NORMAL", add_accessor(normals_view, vertex_at, kFloat, "VEC3", mesh.vertex_count)}};
    if (shows_image_.contains(number)) {
      const std::size_t coordinate_at = sizeof(TextureCoordinate) * std::size_t{mesh.first_vertex};
      out.attributes["TEXCOORD_0"] =
          add_accessor(coordinates_view, coordinate_at, kFloat, "VEC2", mesh.vertex_count);
    }
    const std::size_t index_at = sizeof(std::uint32_t) * std::size_t{mesh.first_index};
    out.indices = add_accessor(indices_view, index_at, kUnsignedInt, "SCALAR", mesh.index_count);
    return out;
  }

  std::size_t add_accessor(View view, std::size_t offset, int component, const char* type,
                           std::size_t count) {
    // Texture coordinates may be absent as a whole.
    const int skipped = view > coordinates_view && scene_.texture_coordinates.empty() ? 1 : 0;
    root_["accessors"].push_back({{"bufferView", view - skipped},
                                  {"byteOffset", offset},
                                  {"componentType", component},
                                  {"type", type},
                                  {"count", count}});
    return root_["accessors"].size() - 1;
  }

  void add_node(std::size_t mesh, ObjectId object) {
    Json node = {{"mesh", mesh}, {"extras", {{"sightline_object", object}}}};
    if (const Affine& affine = scene_.transform[object]; affine != Affine{}) {
      const auto& [x, y, z] = affine.rows;
      node["matrix"] = Json::array({x.x, y.x, z.x, 0, x.y, y.y, z.y, 0, x.z, y.z, z.z, 0, x.w, y.w, z.w, 1});
    }
    root_["nodes"].push_back(std::move(node));
  }

  void add_instances(std::size_t mesh, std::span<const ObjectId> objects, std::span<const Parts> parts) {
    const auto add = [&](const char* type, auto values_of) {
      const std::size_t at = instances_.size() * sizeof(float);
      for (std::size_t i = 0; i < objects.size(); ++i) {
        for (const double value : values_of(i)) instances_.push_back(static_cast<float>(value));
      }
      return add_accessor(instances_view, at, kFloat, type, objects.size());
    };
    Json attributes;
    attributes["TRANSLATION"] = add("VEC3", [&](std::size_t i) { return parts[i].translation; });
    attributes["ROTATION"] = add("VEC4", [&](std::size_t i) { return parts[i].rotation; });
    attributes["SCALE"] = add("VEC3", [&](std::size_t i) { return parts[i].scale; });
    const auto same_again = [&](std::size_t i) {
      return to_affine(compose(rounded(parts[i]))) == scene_.transform[objects[i]];
    };
    if (!std::ranges::all_of(std::views::iota(std::size_t{0}, objects.size()), same_again)) {
      // For this reader, to the bit; others have the parts.
      for (std::size_t row = 0; row < kRowAttributes.size(); ++row) {
        attributes[kRowAttributes[row]] = add("VEC4", [&](std::size_t i) {
          const Vec4& r = scene_.transform[objects[i]].rows[row];
          return std::array<double, 4>{r.x, r.y, r.z, r.w};
        });
      }
    }
    attributes["_OBJECT"] = add("SCALAR", [&](std::size_t i) { return std::array{double{1} * objects[i]}; });
    root_["nodes"].push_back(
        {{"mesh", mesh},
         {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", std::move(attributes)}}}}}});
    root_["extensionsUsed"] = Json::array({"EXT_mesh_gpu_instancing"});
    // A reader that skipped it would show one object where there are many.
    root_["extensionsRequired"] = root_["extensionsUsed"];
  }

  void add_viewpoints() {
    if (scene_.viewpoints.empty()) return;
    root_["cameras"] =
        Json::array({{{"type", "perspective"}, {"perspective", {{"yfov", 1.04719755}, {"znear", 0.1}}}}});
    for (const Viewpoint& view : scene_.viewpoints) {
      root_["nodes"].push_back({{"name", view.name}, {"camera", 0}, {"matrix", camera_matrix(view)}});
    }
  }

  /// The camera looks down its own -z, up as far as its direction lets it.
  static Json camera_matrix(const Viewpoint& view) {
    const double length =
        std::sqrt(double{view.forward.x} * view.forward.x + double{view.forward.y} * view.forward.y +
                  double{view.forward.z} * view.forward.z);
    if (!(length > 0)) throw Error(fmt::format("viewpoint '{}' has no direction", view.name));
    const std::array<double, 3> back{-view.forward.x / length, -view.forward.y / length,
                                     -view.forward.z / length};
    // right = up × back; where that vanishes, any level direction will do.
    std::array<double, 3> right{back[2], 0, -back[0]};
    const double level = std::sqrt(right[0] * right[0] + right[2] * right[2]);
    right = level > 1e-9 ? std::array<double, 3>{right[0] / level, 0, right[2] / level}
                         : std::array<double, 3>{1, 0, 0};
    const std::array<double, 3> up{back[1] * right[2] - back[2] * right[1],
                                   back[2] * right[0] - back[0] * right[2],
                                   back[0] * right[1] - back[1] * right[0]};
    return Json::array({right[0], right[1], right[2], 0, up[0], up[1], up[2], 0, back[0], back[1], back[2], 0,
                        view.eye.x, view.eye.y, view.eye.z, 1});
  }

  void add_buffers() {
    std::size_t at = 0;
    const auto all = pieces();
    for (std::size_t view = 0; view < all.size(); ++view) {
      if (all[view].empty()) continue;
      Json description = {{"buffer", 0}, {"byteOffset", at}, {"byteLength", all[view].size()}};
      if (view <= normals_view) description["byteStride"] = sizeof(Vec3);
      if (view == coordinates_view) description["byteStride"] = sizeof(TextureCoordinate);
      if (view < instances_view) description["target"] = view == indices_view ? kIndexData : kVertexData;
      if (view > instances_view) {
        root_["images"].push_back({{"bufferView", root_["bufferViews"].size()}, {"mimeType", "image/png"}});
      }
      root_["bufferViews"].push_back(std::move(description));
      at += all[view].size();
    }
    root_["buffers"] = Json::array({{{"byteLength", at}}});
  }

  /// All nodes are roots, unless the scene counts from elsewhere: then they are children of one that stands
  /// there.
  void add_scene() {
    Json all = Json::array();
    for (std::size_t i = 0; i < root_["nodes"].size(); ++i) all.push_back(i);
    if (const WorldPoint& origin = scene_.origin; origin != WorldPoint{}) {
      root_["nodes"].push_back({{"children", std::move(all)},
                                {"translation", {origin.x, origin.y, origin.z}},
                                {"extras", {{"sightline_origin", true}}}});
      all = Json::array({root_["nodes"].size() - 1});
    }
    root_["scenes"] = Json::array({{{"nodes", std::move(all)}}});
    root_["scene"] = 0;
  }

  const Scene& scene_;
  Json root_;
  std::map<std::uint32_t, Accessors> accessors_;  ///< of a mesh
  std::map<MaterialKey, std::size_t> material_numbers_;
  std::set<std::uint32_t> shows_image_;  ///< meshes
  std::vector<float> instances_;
  std::vector<std::vector<std::byte>> images_;  ///< PNG, to whole words
};

}  // namespace

}  // namespace io::gltf

void write_glb(const Scene& scene, const std::filesystem::path& path) {
  using namespace io::gltf;
  check(scene);
  if (scene.size() > kMaxObjects) {
    throw Error(fmt::format("{}: cannot hold {} objects, expected at most {}", path.string(), scene.size(),
                            kMaxObjects));
  }
  GlbWriter writer(scene);
  std::string json = writer.document().dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto pieces = writer.pieces();
  std::uint64_t binary = 0;
  for (const auto& piece : pieces) binary += piece.size();
  const std::uint64_t total = 12 + 8 + json.size() + 8 + binary;
  if (total > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(fmt::format("{}: would be {} bytes long, GLB ends at 4 GiB", path.string(), total));
  }
  const auto u32 = [](std::uint64_t value) { return static_cast<std::uint32_t>(value); };
  const std::array<std::uint32_t, 5> head{0x46546c67, 2, u32(total), u32(json.size()), 0x4e4f534a};
  const std::array<std::uint32_t, 2> binary_head{u32(binary), 0x004e4942};
  std::vector<std::span<const std::byte>> all{std::as_bytes(std::span(head)), std::as_bytes(std::span(json)),
                                              std::as_bytes(std::span(binary_head))};
  all.insert(all.end(), pieces.begin(), pieces.end());
  io::write_file(path, all);
}

}  // namespace sightline
