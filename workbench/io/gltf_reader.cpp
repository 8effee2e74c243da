// From a glTF document to a scene: the node hierarchy, instances, materials and cameras.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <sightline/workbench/io.hpp>

#include "library/geometry/linear.hpp"
#include "workbench/io/gltf_document.hpp"
#include "workbench/io/gltf_material.hpp"
#include "workbench/io/gltf_mesh.hpp"
#include "workbench/io/gltf_transform.hpp"
#include "workbench/scene/far_origin.hpp"

namespace sightline {

namespace io::gltf {

namespace {

constexpr std::uint32_t kMaxDepth = 4096;
// Bounds are computed from the vertices of each object: more than this takes minutes.
constexpr std::uint64_t kMaxTransformed = std::uint64_t{1} << 35;

void refuse_unknown_extensions(const Json& root) {
  static constexpr std::string_view kKnown[] = {"EXT_mesh_gpu_instancing", "KHR_mesh_quantization",
                                                "KHR_lights_punctual",     "KHR_texture_transform",
                                                "KHR_texture_basisu",      "EXT_texture_webp"};
  for (const Json& required : array_of(root, "extensionsRequired")) {
    const std::string name = required.is_string() ? required.get<std::string>() : "?";
    if (name.starts_with("KHR_materials_")) continue;
    if (std::find(std::begin(kKnown), std::end(kKnown), name) == std::end(kKnown)) {
      throw Error(fmt::format("requires the extension '{}', which is not supported", name.substr(0, 60)));
    }
  }
}

std::uint64_t index_of(const Json& value) {
  const double number = number_of(value, "node index");
  if (number < 0 || number >= 4294967296.0 || number != std::floor(number)) {
    throw Error("has a node index that is not a whole number from 0");
  }
  return static_cast<std::uint64_t>(number);
}

/// The nodes of the scene to show; without scenes, those that are nobody's child.
std::vector<std::uint64_t> roots(const Document& document) {
  std::vector<std::uint64_t> out;
  if (!array_of(document.root(), "scenes").empty()) {
    const Json& shown = document.at("scenes", whole_of(document.root(), "scene", 0));
    for (const Json& node : array_of(shown, "nodes")) out.push_back(index_of(node));
    return out;
  }
  const Json::array_t& nodes = array_of(document.root(), "nodes");
  std::vector<std::uint8_t> is_child(nodes.size(), 0);
  for (const Json& node : nodes) {
    for (const Json& child : array_of(node, "children")) {
      if (const std::uint64_t c = index_of(child); c < nodes.size()) is_child[c] = 1;
    }
  }
  for (std::uint64_t i = 0; i < nodes.size(); ++i) {
    if (is_child[i] == 0) out.push_back(i);
  }
  return out;
}

/// The origin that write_glb kept, as the place of a root that it marked.
std::optional<WorldPoint> kept_origin(const Document& document) {
  const Json::array_t& nodes = array_of(document.root(), "nodes");
  for (const std::uint64_t root : roots(document)) {
    if (root >= nodes.size()) continue;
    const Json& node = nodes[root];
    const Json *extras = find(node, "extras"), *place = find(node, "translation");
    if (extras == nullptr || find(*extras, "sightline_origin") == nullptr || place == nullptr) continue;
    std::array<double, 3> at;
    numbers_of(*place, "translation", at);
    return WorldPoint{at[0], at[1], at[2]};
  }
  return {};
}

// So far exporters round a matrix's last row, and the length of a quaternion.
constexpr double kRowRounding = 1e-6, kTurnRounding = 0.01;

Transform node_matrix(const Json& matrix) {
  std::array<double, 16> m;
  numbers_of(matrix, "matrix", m);
  const std::array<double, 4> row{m[3], m[7], m[11], m[15]}, expected{0, 0, 0, 1};
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (!(std::abs(row[i] - expected[i]) <= kRowRounding))
      throw Error(fmt::format("has 'matrix' with the last row {}, expected 0 0 0 1", fmt::join(row, " ")));
  }
  m[3] = m[7] = m[11] = 0, m[15] = 1;
  return glm::make_mat4(m.data());
}

void read_turn(const Json& rotation, std::array<double, 4>& out) {
  numbers_of(rotation, "rotation", out);
  const double length = glm::length(glm::make_vec4(out.data()));
  if (!(std::abs(length - 1) <= kTurnRounding))
    throw Error(fmt::format("has 'rotation' of length {:.4g}, expected a quaternion of length 1", length));
}

class SceneReader {
public:
  SceneReader(Document& document, std::uint64_t file_bytes, Scene& scene)
      : document_(document),
        scene_(scene),
        materials_(document, scene),
        meshes_(document, materials_, file_bytes, scene) {}

  /// Places everything relative to the scene's origin.
  void read() {
    const Json::array_t& nodes = array_of(document_.root(), "nodes");
    const WorldPoint& origin = scene_.origin;
    const Transform world = glm::translate(Transform(1), -glm::dvec3(origin.x, origin.y, origin.z));
    std::vector<Pending> pending;
    for (const std::uint64_t root : roots(document_)) pending.push_back({root, 0, world});
    std::reverse(pending.begin(), pending.end());
    std::vector<std::uint8_t> visited(nodes.size(), 0);
    while (!pending.empty()) {
      const Pending at = pending.back();
      pending.pop_back();
      if (at.node >= nodes.size()) {
        throw Error(fmt::format("refers to node {}, but has {}", at.node, nodes.size()));
      }
      if (std::exchange(visited[at.node], std::uint8_t{1}) != 0) {
        throw Error(fmt::format("node {} is reached twice, expected nodes to form trees", at.node));
      }
      if (at.depth > kMaxDepth)
        throw Error(fmt::format("node {} lies deeper than {} levels", at.node, kMaxDepth));
      try {
        read_node(nodes[at.node], at, pending);
      } catch (const Error& error) {
        throw Error(fmt::format("node {} {}", at.node, error.what()));
      }
    }
    restore_order();
    const auto shows_image = [](std::uint32_t image) { return image != kNoAlphaImage; };
    if (std::ranges::any_of(scene_.alpha_image, shows_image))
      scene_.texture_coordinates.resize(scene_.positions.size());
  }

private:
  struct Pending {
    std::uint64_t node;
    std::uint32_t depth;
    Transform parent;
  };

  static Transform local_transform(const Json& node) {
    const Json *translation = find(node, "translation"), *rotation = find(node, "rotation"),
               *scale = find(node, "scale");
    if (const Json* matrix = find(node, "matrix")) {
      if (translation != nullptr || rotation != nullptr || scale != nullptr)
        throw Error("has 'matrix' beside 'translation', 'rotation' or 'scale', expected one or the other");
      return node_matrix(*matrix);
    }
    Parts parts;
    if (translation != nullptr) numbers_of(*translation, "translation", parts.translation);
    if (rotation != nullptr) read_turn(*rotation, parts.rotation);
    if (scale != nullptr) numbers_of(*scale, "scale", parts.scale);
    return compose(parts);
  }

  void read_node(const Json& node, const Pending& at, std::vector<Pending>& pending) {
    const Transform world = at.parent * local_transform(node);
    if (const std::uint64_t camera = whole_of(node, "camera", kNone); camera != kNone)
      add_camera(node, camera, world);
    if (const std::uint64_t mesh = whole_of(node, "mesh", kNone); mesh != kNone)
      add_objects(node, mesh, world);
    const Json::array_t& children = array_of(node, "children");
    for (auto child = children.rbegin(); child != children.rend(); ++child) {
      pending.push_back({index_of(*child), at.depth + 1, world});
    }
  }

  void add_camera(const Json& node, std::uint64_t index, const Transform& world) {
    const Json& camera = document_.at("cameras", index);
    if (text_of(camera, "type") != "perspective") return;
    // A camera looks down its own -z.
    const glm::dvec3 back(world[2]);
    const double length = glm::length(back);
    const Affine affine = to_affine(world);
    const Vec3 eye{affine.rows[0].w, affine.rows[1].w, affine.rows[2].w};
    if (!(length > 0) || !std::isfinite(length) || !std::isfinite(eye.x) || !std::isfinite(eye.y) ||
        !std::isfinite(eye.z)) {
      throw Error("holds a camera that has no finite place or direction");
    }
    std::string name = text_of(node, "name");
    if (name.empty()) name = text_of(camera, "name");
    if (name.empty()) name = fmt::format("camera_{}", scene_.viewpoints.size() + 1);
    scene_.viewpoints.push_back({std::move(name), eye, geometry::to_vec3(-back / length)});
  }

  void add_objects(const Json& node, std::uint64_t mesh_index, const Transform& world) {
    const Json& mesh = document_.at("meshes", mesh_index);
    const Json* extensions = find(node, "extensions");
    const Json* instancing = extensions != nullptr ? find(*extensions, "EXT_mesh_gpu_instancing") : nullptr;
    const Json* extras = find(node, "extras");
    const std::uint64_t own_id = extras != nullptr ? order_of(*extras) : kNone;
    for (const Json& primitive : array_of(mesh, "primitives")) {
      const std::uint32_t shape = meshes_.mesh_of(primitive);
      if (shape == kNoMesh) continue;
      const Material material = material_of(primitive);
      if (instancing == nullptr) {
        add_object(shape, to_affine(world), material, own_id);
      } else {
        add_instances(*instancing, shape, world, material);
      }
    }
  }

  void add_instances(const Json& instancing, std::uint32_t shape, const Transform& world,
                     const Material& material) {
    const Json* attributes = find(instancing, "attributes");
    const auto attribute = [&](const char* name, std::string_view type) -> const Accessor* {
      const std::uint64_t index = attributes != nullptr ? whole_of(*attributes, name, kNone) : kNone;
      if (index == kNone) return nullptr;
      const Accessor& accessor = document_.accessor(index);
      if (accessor.type() != type) throw Error(fmt::format("has instances whose {} is not {}", name, type));
      return &accessor;
    };
    const Accessor* translation = attribute("TRANSLATION", "VEC3");
    const Accessor* rotation = attribute("ROTATION", "VEC4");
    const Accessor* scale = attribute("SCALE", "VEC3");
    const Accessor* order = attribute("_OBJECT", "SCALAR");
    std::array<const Accessor*, 3> rows{};
    std::ranges::transform(kRowAttributes, rows.begin(),
                           [&](const char* name) { return attribute(name, "VEC4"); });
    std::uint64_t count = kNone;
    for (const Accessor* accessor : {translation, rotation, scale, order, rows[0], rows[1], rows[2]}) {
      if (accessor == nullptr) continue;
      if (count != kNone && accessor->count() != count)
        throw Error("has instance attributes of different counts");
      count = accessor->count();
    }
    if (count == kNone) throw Error("has EXT_mesh_gpu_instancing without an attribute that is known");
    const bool has_rows = std::ranges::all_of(rows, [](const Accessor* row) { return row != nullptr; });
    for (std::uint64_t i = 0; i < count; ++i) {
      const auto fill = [&](const Accessor* from, std::span<double> out) {
        if (from == nullptr) return;
        for (std::uint32_t k = 0; k < out.size(); ++k) out[k] = from->component(i, k);
      };
      Transform local(1);
      if (has_rows) {
        std::array<double, 16> m{};
        for (std::size_t row = 0; row < rows.size(); ++row) fill(rows[row], std::span(m).subspan(4 * row, 4));
        m[15] = 1;
        local = glm::transpose(glm::make_mat4(m.data()));
      } else {
        Parts parts;
        fill(translation, parts.translation);
        fill(rotation, parts.rotation);
        fill(scale, parts.scale);
        local = compose(parts);
      }
      const float id = order != nullptr ? order->component(i, 0) : -1;
      add_object(shape, to_affine(world * local), material,
                 id >= 0 && id < static_cast<float>(kMaxObjects) ? static_cast<std::uint64_t>(id) : kNone);
    }
  }

  /// Of a primitive that has a mesh. An image without coordinates to lie on says nothing.
  [[nodiscard]] Material material_of(const Json& primitive) const {
    const Look& look = materials_.look_of(primitive);
    Material out = look.material;
    const std::string set = fmt::format("TEXCOORD_{}", look.coordinate_set);
    if (out.alpha_image != kNoAlphaImage && find(*find(primitive, "attributes"), set.c_str()) == nullptr &&
        scene_.alpha_images[out.alpha_image].alpha.size() > 1) {
      out.alpha_image = kNoAlphaImage;
    }
    return out;
  }

  static std::uint64_t order_of(const Json& extras) {
    const Json* id = find(extras, "sightline_object");
    return id != nullptr && id->is_number_unsigned() ? id->get<std::uint64_t>() : kNone;
  }

  void add_object(std::uint32_t shape, const Affine& affine, const Material& material, std::uint64_t id) {
    if (scene_.size() >= kMaxObjects)
      throw Error(fmt::format("brings the scene over {} objects", kMaxObjects));
    transformed_ += scene_.meshes[shape].vertex_count;
    if (transformed_ > kMaxTransformed) {
      throw Error(fmt::format("brings all objects together over {} vertices", kMaxTransformed));
    }
    scene_.add_object(shape, affine, material);
    ids_.push_back(id);
  }

  /// Gives objects the ids they had when write_glb wrote them, if the file says so for each.
  void restore_order() {
    const std::size_t n = scene_.size();
    std::vector<std::uint32_t> from(n, kNoObject);
    bool sorted = true;
    for (std::size_t i = 0; i < n; ++i) {
      if (ids_[i] >= n || from[ids_[i]] != kNoObject) return;
      from[ids_[i]] = static_cast<std::uint32_t>(i);
      sorted = sorted && ids_[i] == i;
    }
    if (sorted) return;
    const auto reorder = [&](auto& values) {
      auto moved = values;
      for (std::size_t i = 0; i < n; ++i) moved[i] = values[from[i]];
      values = std::move(moved);
    };
    reorder(scene_.mesh);
    reorder(scene_.radius);
    reorder(scene_.transform);
    reorder(scene_.surface);
    reorder(scene_.sides);
    reorder(scene_.material_sides);
    reorder(scene_.alpha_image);
    reorder(scene_.alpha_cutoff);
    reorder(scene_.layers);
    Boxes& b = scene_.bounds;
    for (auto* array : {&b.min_x, &b.min_y, &b.min_z, &b.max_x, &b.max_y, &b.max_z}) reorder(*array);
  }

  Document& document_;
  Scene& scene_;
  MaterialReader materials_;
  MeshReader meshes_;
  std::uint64_t transformed_ = 0;   ///< vertices of all objects, a shared mesh counted for each
  std::vector<std::uint64_t> ids_;  ///< one an object: kNone, or the id it had when it was written
};

/// What the document says that no part of this does.
std::vector<std::string> ignored_parts(const Document& document) {
  const Json& root = document.root();
  std::vector<std::string> out;
  const std::size_t skins = array_of(root, "skins").size(), animations = array_of(root, "animations").size();
  std::size_t morphed = 0;
  for (const Json& mesh : array_of(root, "meshes")) {
    for (const Json& primitive : array_of(mesh, "primitives"))
      morphed += !array_of(primitive, "targets").empty();
  }
  if (skins != 0) {
    out.push_back(
        fmt::format("{} skins: their meshes are drawn as modelled, and what a skeleton moves out of those "
                    "bounds would be culled with them",
                    skins));
  }
  if (morphed != 0) {
    out.push_back(
        fmt::format("morph targets of {} primitives: drawn with every weight at 0, and what they add to the "
                    "bounds is not there",
                    morphed));
  }
  if (animations != 0) {
    out.push_back(fmt::format("{} animations: nodes stand where the file first has them", animations));
  }
  return out;
}

Scene read_relative_to(const WorldPoint& origin, Document& document, std::uint64_t bytes,
                       const std::string& name) {
  Scene scene;
  scene.name = name;
  scene.origin = origin;
  SceneReader(document, bytes, scene).read();
  if (scene.empty()) throw Error("shows no triangle, expected at least one");
  return scene;
}

}  // namespace

}  // namespace io::gltf

Scene read_gltf(std::span<const std::byte> bytes, std::string name, const std::filesystem::path& folder) {
  using namespace io::gltf;
  Scene scene;
  try {
    Document document(bytes, folder);
    refuse_unknown_extensions(document.root());
    const std::optional<WorldPoint> kept = kept_origin(document);
    scene = read_relative_to(kept.value_or(WorldPoint{}), document, bytes.size(), name);
    if (!kept) {
      const WorldPoint origin = scene::far_origin(extent(scene));
      if (origin != WorldPoint{}) scene = read_relative_to(origin, document, bytes.size(), name);
    }
    for (std::string& part : ignored_parts(document)) scene.ignored.push_back(std::move(part));
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", name, error.what()));
  }
  check(scene);
  return scene;
}

}  // namespace sightline
