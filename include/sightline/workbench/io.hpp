// Scenes from files and to files. All functions throw sightline::Error: one sentence that names the file,
// what is wrong, where, and what was expected. Counts, offsets and indices are checked before use, and what
// is allocated is bounded by what the file really holds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/scene.hpp>

namespace sightline {

struct LoadOptions {
  /// Segments along each side of a quadratic Bézier patch of a Quake 3 level, 1 … 32. One value for a whole
  /// level, so that patches which share a border share its vertices to the bit.
  std::uint32_t patch_level = 6;
};

/// Loads a scene and checks it.
///
/// Specification: a generated world ("world:NAME?key=value"), a file ending in .glb, .gltf or .bsp, or a
/// level in an archive: "archive.pk3:maps/name.bsp". A relative .pk3 that is not in the current directory is
/// looked for in the folders of the environment variable SIGHTLINE_DATA (separated by ':'), then where Debian
/// puts OpenArena's data, /usr/share/games/openarena/baseoa.
Scene load_scene(std::string_view specification, const LoadOptions& options = {});

/// Reads a Quake 3 level (IBSP version 46) from memory. `name` is the scene's name, and what errors call it.
///
/// Objects are the level's faces: object id == face index, one mesh each, in the file's order.
/// - 1 Quake unit is 0.0254 m; axes (x, y, z) become (x, z, -y), which is y up and still right-handed.
/// - Triangles are wound counter-clockwise as seen from the side the stored normals point to.
/// - Patches (type 2) are tessellated with LoadOptions::patch_level.
/// - Flares (type 4) have no geometry, the game draws a sprite; they become a small octahedron, 0.1 m
///   from tip to centre, at the flare's origin, transparent.
/// - A face without a triangle stays an object of its vertices, or of one point, so that ids
///   stay face indices.
/// - Faces whose shader has translucent or fog contents or the flag 'no draw' are transparent.
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
/// computed. Materials with alphaMode BLEND are transparent; perspective cameras become viewpoints. Images,
/// animations, skins and morph targets are not looked at; required extensions that are not known are refused.
Scene read_gltf(std::span<const std::byte> bytes, std::string name, const std::filesystem::path& folder = {});

/// Writes a scene as GLB: each mesh once, objects as nodes or, where many share a mesh and their transforms
/// are a rotation, a translation and a scale, as instances of EXT_mesh_gpu_instancing. Viewpoints become
/// cameras, transparent objects get a material with alphaMode BLEND. The level's visibility and the waypoints
/// are not kept, glTF has no place for them. Written under a temporary name in the same folder and renamed.
void write_glb(const Scene& scene, const std::filesystem::path& path);

}  // namespace sightline
