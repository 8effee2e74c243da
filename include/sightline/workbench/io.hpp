// Scenes from files and to files. All functions throw sightline::Error: one sentence that names the file,
// what is wrong, where, and what was expected. Counts, offsets and indices are checked before use, and what
// is allocated is bounded by what the file really holds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/scene.hpp>

namespace sightline {

struct LoadOptions {
  /// Segments along each side of a quadratic Bézier patch of a Quake 3 level, 1 … 32. One value for a whole
  /// level, so that patches which share a border share its vertices to the bit.
  std::uint32_t patch_level = 6;
  /// The texts of the game's shader scripts; of two that name a surface the first counts. load_scene and
  /// read_pk3 put those they find behind these.
  std::vector<std::string> shader_scripts = {};
  /// A file of the game by its name, such as "textures/a.tga": its bytes, none where there is no such file.
  /// load_scene and read_pk3 look into the archives, unless one is given.
  std::function<std::vector<std::byte>(const std::string& name)> game_file = {};
};

/// Loads a scene and checks it.
///
/// Specification: a generated world ("world:NAME?key=value"), a file ending in .glb, .gltf or .bsp, or a
/// level in an archive: "archive.pk3:maps/name.bsp". A relative .pk3 that is not in the current directory is
/// looked for in the folders of the environment variable SIGHTLINE_DATA (separated by ':'), then where Debian
/// puts OpenArena's data, /usr/share/games/openarena/baseoa. A level's shader scripts are those in all .pk3
/// archives of its archive's folder, those of a .bsp lie in the folder's archives or those of the folder
/// above "maps": what the last archive by name holds counts before what another does.
Scene load_scene(std::string_view specification, const LoadOptions& options = {});

/// Reads a Quake 3 level (IBSP version 46) from memory. `name` is the scene's name, and what errors call it.
///
/// Objects are the level's faces: object id == face index, one mesh each, in the file's order.
/// - 1 Quake unit is 0.0254 m; axes (x, y, z) become (x, z, -y), which is y up and still right-handed.
/// - Triangles turn counter-clockwise as seen from the side that the game draws.
/// - Patches (type 2) are tessellated with LoadOptions::patch_level.
/// - Flares (type 4) have no geometry, the game draws a sprite; they become a small octahedron, 0.1 m
///   from tip to centre, at the flare's origin, transparent.
/// - A face without a triangle stays an object of its vertices, or of one point, so that ids stay face
///   indices.
/// - Shader scripts say what is cut out (alphaFunc in the first stage), what is transparent (a first
///   stage that blends, or a late sort), and which sides are drawn (cull). Cut-outs have the alpha of the
///   first stage's image, .tga or .png, where the game has it, it can be read, and its texture does not
///   move; else they are drawn whole.
/// - Without a script the flags do: translucent contents are transparent; shadows by alpha, filtered
///   light and contents that are not solid may have holes, so they are cut out, drawn on both sides. Fog
///   and the flag 'no draw' are transparent. All else is opaque and drawn from its front.
/// - `_farplanedist` of the world's entity is LevelPvs::far_plane.
/// - Moving parts (doors, lifts) stand at the origin of the entity that shows them, and belong to no leaf.
/// Scene::level holds the tree, the leaves' faces and the visibility lump (without one: all see all).
/// Viewpoints are the players' spawn points at eye height, 50 units over the floor; waypoints are those and
/// the items.
Scene read_bsp(std::span<const std::byte> bytes, std::string name, const LoadOptions& options = {});

/// Reads one level out of a .pk3 (zip) archive held in memory. `name` is the archive's, for errors.
Scene read_pk3(std::span<const std::byte> archive, std::string_view entry, std::string name,
               const LoadOptions& options = {});

/// Reads glTF 2.0 from memory, binary (GLB) or text, told apart by their first bytes. External buffers are
/// read from `folder` and nowhere else; without one they are refused.
///
/// One object per (node, primitive), or per instance of EXT_mesh_gpu_instancing. Primitives that are the same
/// share a mesh. Triangle lists, strips and fans are read, points and lines left out. Missing normals are
/// computed. Materials with alphaMode BLEND are transparent, with MASK cut out by the alpha of their base
/// colour's PNG (a JPEG has none, and other formats are not read: then they are drawn whole), repeated
/// whatever the sampler says; without doubleSided only fronts are drawn. Perspective cameras become
/// viewpoints. Animations, skins and morph targets are not looked at (Scene::ignored); required extensions
/// that are not known are refused.
///
/// Transforms are composed in doubles. Where all lies so far out that floats are too coarse (more than 100
/// km, or a kilometre and 16 times its own size), Scene::origin is the rounded centre.
Scene read_gltf(std::span<const std::byte> bytes, std::string name, const std::filesystem::path& folder = {});

/// Writes a scene as GLB: each mesh once, objects as nodes or, where many share a mesh and their transforms
/// are a rotation, a translation and a scale, as instances of EXT_mesh_gpu_instancing. Viewpoints become
/// cameras. Materials say alphaMode, alphaCutoff and doubleSided, cut-outs bring their image along as PNG,
/// and a scene with an origin stands under a node that is placed there: what is read back is the same scene,
/// to the bit. The level's visibility and the waypoints are not kept, glTF
/// has no place for them. Written under a temporary name in the same folder and renamed.
void write_glb(const Scene& scene, const std::filesystem::path& path);

}  // namespace sightline
