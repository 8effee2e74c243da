// Quake 3 levels. Format: the records of quake3_format.hpp behind a header of 17 lumps.
#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include <sightline/workbench/io.hpp>

#include "workbench/io/quake3_entities.hpp"
#include "workbench/io/quake3_faces.hpp"
#include "workbench/io/quake3_images.hpp"
#include "workbench/io/quake3_lumps.hpp"
#include "workbench/io/quake3_shaders.hpp"

namespace sightline {

namespace io::quake3 {

namespace {

constexpr std::uint32_t kMaxPatchLevel = 32;

/// The faces of each model: model 0 is the world, the others are its moving parts.
std::vector<std::pair<std::size_t, std::size_t>> read_models(const Level& level, std::size_t face_count) {
  const Records<ModelRecord> records(level.lump(LumpId::models), "models");
  std::vector<std::pair<std::size_t, std::size_t>> models;
  std::uint64_t budget = face_count;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const ModelRecord model = records.at(static_cast<std::int64_t>(i));
    if (model.first_face < 0 || model.face_count < 0 ||
        !fits(static_cast<std::uint64_t>(model.first_face), static_cast<std::uint64_t>(model.face_count),
              face_count) ||
        static_cast<std::uint64_t>(model.face_count) > budget) {
      throw Error(fmt::format("model {} refers to faces {} … +{}, but the level holds {}, each in one model",
                              i, model.first_face, model.face_count, face_count));
    }
    budget -= static_cast<std::uint64_t>(model.face_count);
    models.emplace_back(model.first_face, model.face_count);
  }
  if (models.empty()) throw Error("has no models, expected at least that of the world");
  return models;
}

/// Where each face's model stands: a moving part's vertices count from the origin of the entity that shows
/// it.
std::vector<Affine> place_faces(const std::vector<Entity>& entities,
                                std::span<const std::pair<std::size_t, std::size_t>> models,
                                std::size_t face_count) {
  std::vector<Affine> places(face_count);
  for (const auto& [model, origin] : model_origins(entities)) {
    if (model == 0 || model >= models.size()) continue;
    const Vec3 p = to_point(origin);
    const auto [first, count] = models[model];
    std::fill_n(places.begin() + static_cast<std::ptrdiff_t>(first), count,
                Affine{{Vec4{1, 0, 0, p.x}, Vec4{0, 1, 0, p.y}, Vec4{0, 0, 1, p.z}}});
  }
  return places;
}

/// Unit length; up where there is no direction.
Vec3 normalised(const Vec3& v) {
  const double length = std::sqrt(double{v.x} * v.x + double{v.y} * v.y + double{v.z} * v.z);
  if (!(length > 1e-12) || !std::isfinite(length)) return {0, 1, 0};
  return {static_cast<float>(v.x / length), static_cast<float>(v.y / length),
          static_cast<float>(v.z / length)};
}

void read_faces(const Level& level, const LoadOptions& options, const ShaderScripts& scripts,
                std::span<const Affine> places, Scene& scene) {
  const Records<FaceRecord> faces(level.lump(LumpId::faces), "faces");
  const Records<ShaderRecord> shaders(level.lump(LumpId::shaders), "shaders");
  FaceReader reader(level.lump(LumpId::vertices), level.lump(LumpId::mesh_vertices), options.patch_level);
  LevelImages images(options.game_file, scene);
  std::vector<Vec3> positions, normals;
  std::vector<TextureCoordinate> coordinates;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    try {
      const FaceRecord face = faces.at(static_cast<std::int64_t>(i));
      ShaderLook look = look_of(shaders.at(face.shader), scripts);
      if (face.type == flare) look = {.surface = Surface::transparent, .cull = Cull::none};
      const std::uint32_t image = images.image_of(look);
      const FaceShape shape = reader.read(face, look.cull);
      positions.clear();
      normals.clear();
      coordinates.clear();
      for (const Surfel& s : shape.vertices) {
        positions.push_back(s.position);
        normals.push_back(normalised(s.normal));
        if (image != kNoAlphaImage) coordinates.push_back(s.texture);
      }
      if (scene.positions.size() + positions.size() > std::numeric_limits<std::uint32_t>::max()) {
        throw Error("brings the level over 2^32 vertices");
      }
      const Sides sides = look.cull == Cull::none ? Sides::both : Sides::front;
      scene.add_object(scene.add_mesh(positions, normals, shape.indices, coordinates), places[i],
                       {look.surface, sides, image, look.alpha_cutoff});
    } catch (const Error& error) {
      throw Error(fmt::format("face {} {}", i, error.what()));
    }
  }
}

Box box_of(const Int3& min, const Int3& max) {
  const auto point = [](const Int3& p) {
    return to_point({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
  };
  const Vec3 a = point(min), b = point(max);
  return {{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
          {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}};
}

Plane plane_of(const PlaneRecord& record) {
  const double x = record.normal[0], y = record.normal[1], z = record.normal[2];
  const double length = std::sqrt(x * x + y * y + z * z);
  if (!std::isfinite(length) || !std::isfinite(record.distance) || std::abs(length - 1) > 1e-3) {
    throw Error("has a plane without a finite unit normal");
  }
  return {to_axes(record.normal), -record.distance * kMetresPerUnit};
}

void read_tree(const Level& level, LevelPvs& pvs) {
  const Records<PlaneRecord> planes(level.lump(LumpId::planes), "planes");
  const Records<NodeRecord> nodes(level.lump(LumpId::nodes), "nodes");
  pvs.nodes.reserve(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const NodeRecord node = nodes.at(static_cast<std::int64_t>(i));
    try {
      pvs.nodes.push_back({plane_of(planes.at(node.plane)), node.front, node.back});
    } catch (const Error& error) {
      throw Error(fmt::format("node {} {}", i, error.what()));
    }
  }
}

void read_leaves(const Level& level, std::size_t face_count, LevelPvs& pvs) {
  const Records<LeafRecord> leaves(level.lump(LumpId::leaves), "leaves");
  const Records<std::int32_t> leaf_faces(level.lump(LumpId::leaf_faces), "leaf faces");
  pvs.leaves.reserve(leaves.size());
  pvs.leaf_objects.resize(leaf_faces.size());
  for (std::size_t i = 0; i < leaf_faces.size(); ++i) {
    const std::int32_t face = leaf_faces.at(static_cast<std::int64_t>(i));
    if (face < 0 || static_cast<std::size_t>(face) >= face_count) {
      throw Error(fmt::format("leaf face {} is face {}, but the level holds {}", i, face, face_count));
    }
    pvs.leaf_objects[i] = static_cast<std::uint32_t>(face);
  }
  // As with the faces' vertices: leaves own their ranges, and what walks all leaves must not walk for ever.
  std::uint64_t budget = 2 * std::uint64_t{leaf_faces.size()} + 1024;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const LeafRecord leaf = leaves.at(static_cast<std::int64_t>(i));
    try {
      leaf_faces.require(leaf.first_face, leaf.face_count);
    } catch (const Error& error) {
      throw Error(fmt::format("leaf {} {}", i, error.what()));
    }
    if (static_cast<std::uint64_t>(leaf.face_count) > budget) {
      throw Error(fmt::format("leaf {} claims {} faces that other leaves claim too", i, leaf.face_count));
    }
    budget -= static_cast<std::uint64_t>(leaf.face_count);
    // A compiler numbers clusters through; more of them than leaves is nonsense that others would allocate
    // for.
    if (leaf.cluster >= static_cast<std::int64_t>(leaves.size())) {
      throw Error(fmt::format("leaf {} has cluster {}, but the level holds {} leaves", i, leaf.cluster,
                              leaves.size()));
    }
    pvs.clusters = std::max(pvs.clusters, static_cast<std::uint32_t>(std::max(leaf.cluster, -1) + 1));
    const auto first = static_cast<std::uint32_t>(leaf.first_face),
               count = static_cast<std::uint32_t>(leaf.face_count);
    pvs.leaves.push_back({std::max(leaf.cluster, -1), box_of(leaf.min, leaf.max), first, count});
  }
}

/// Without the lump every cluster sees every other, as when a level was compiled without its visibility
/// stage.
void read_visibility(const Level& level, LevelPvs& pvs) {
  const Bytes lump = level.lump(LumpId::visibility);
  if (lump.empty()) return;
  if (lump.size() < 8)
    throw Error(fmt::format("has a visibility lump of {} bytes, expected at least 8", lump.size()));
  const auto clusters = read_at<std::uint32_t>(lump, 0), bytes = read_at<std::uint32_t>(lump, 4);
  if (std::uint64_t{bytes} * 8 < clusters || !fits(8, std::uint64_t{clusters} * bytes, lump.size())) {
    throw Error(fmt::format("has a visibility lump of {} bytes for {} clusters of {} bytes", lump.size(),
                            clusters, bytes));
  }
  if (clusters < pvs.clusters) {
    throw Error(
        fmt::format("has a leaf in cluster {}, but visibility for {} clusters", pvs.clusters - 1, clusters));
  }
  const auto* data = reinterpret_cast<const std::uint8_t*>(lump.data()) + 8;
  pvs.clusters = clusters;
  pvs.bytes_per_cluster = bytes;
  pvs.visibility.assign(data, data + std::size_t{clusters} * bytes);
}

/// Each moving part has a leaf of its own that the world's tree does not reach, with a cluster that says
/// nothing: the part moves. Such leaves are emptied, so that their faces belong to no leaf.
void drop_unreached_leaves(LevelPvs& pvs) {
  std::vector<std::uint8_t> node_reached(pvs.nodes.size(), 0), leaf_reached(pvs.leaves.size(), 0);
  if (pvs.nodes.empty()) {
    leaf_reached[0] = 1;
  } else {
    node_reached[0] = 1;
  }
  for (std::size_t i = 0; i < pvs.nodes.size(); ++i) {  // children come after their parents
    if (node_reached[i] == 0) continue;
    for (const std::int32_t child : {pvs.nodes[i].front, pvs.nodes[i].back}) {
      (child >= 0 ? node_reached[static_cast<std::size_t>(child)]
                  : leaf_reached[static_cast<std::size_t>(-(child + 1))]) = 1;
    }
  }
  for (std::size_t i = 0; i < pvs.leaves.size(); ++i) {
    LevelPvs::Leaf& leaf = pvs.leaves[i];
    if (leaf_reached[i] == 0) {
      leaf.cluster = -1;
      leaf.object_count = 0;
    }
    for (std::uint32_t f = 0; f < leaf.object_count; ++f) {
      pvs.in_some_leaf[pvs.leaf_objects[leaf.first_object + f]] = 1;
    }
  }
}

LevelPvs read_level_pvs(const Level& level, const std::pair<std::size_t, std::size_t>& world_faces,
                        std::size_t face_count) {
  LevelPvs pvs;
  pvs.in_some_leaf.assign(face_count, 0);
  pvs.in_world_model.assign(face_count, 0);
  std::fill_n(pvs.in_world_model.begin() + static_cast<std::ptrdiff_t>(world_faces.first), world_faces.second,
              std::uint8_t{1});
  read_tree(level, pvs);
  read_leaves(level, face_count, pvs);
  read_visibility(level, pvs);
  check(pvs, face_count);
  drop_unreached_leaves(pvs);
  return pvs;
}

Scene read(Bytes bytes, std::string name, const LoadOptions& options) {
  const Level level(bytes);
  Scene scene;
  scene.name = std::move(name);
  const Bytes text = level.lump(LumpId::entities);
  const std::vector<Entity> entities =
      parse_entities({reinterpret_cast<const char*>(text.data()), text.size()});
  const std::size_t face_count = Records<FaceRecord>(level.lump(LumpId::faces), "faces").size();
  const auto models = read_models(level, face_count);
  const ShaderScripts scripts(options.shader_scripts);
  if (scripts.broken() != 0) {
    scene.ignored.push_back(fmt::format(
        "{} shader scripts whose braces do not match: left out, as the game does", scripts.broken()));
  }
  read_faces(level, options, scripts, place_faces(entities, models, face_count), scene);
  scene.level = read_level_pvs(level, models[0], face_count);
  scene.level->far_plane = far_plane(entities);
  check(scene);
  add_places(entities, scene);
  return scene;
}

}  // namespace

}  // namespace io::quake3

Scene read_bsp(std::span<const std::byte> bytes, std::string name, const LoadOptions& options) {
  using namespace io::quake3;
  if (options.patch_level < 1 || options.patch_level > kMaxPatchLevel) {
    throw Error(
        fmt::format("{}: patch level {}, expected 1 … {}", name, options.patch_level, kMaxPatchLevel));
  }
  try {
    return read(bytes, name, options);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", name, error.what()));
  }
}

}  // namespace sightline
