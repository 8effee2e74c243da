// sightline info: what is in a scene.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <ranges>
#include <vector>

#include <sightline/occluder.hpp>
#include <sightline/workbench/affine.hpp>
#include <sightline/workbench/error.hpp>
#include <sightline/workbench/io.hpp>

#include "command.hpp"

namespace sightline::app {

namespace {

/// How many objects each kind of surface has, those with none left out.
std::string surfaces_of(const Scene& scene) {
  std::string text;
  const auto add = [&](Surface surface, const char* name) {
    const auto count = std::ranges::count(scene.surface, surface);
    if (count != 0 || surface == Surface::opaque)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, name);
  };
  add(Surface::opaque, "opaque");
  add(Surface::cut_out, "cut out");
  add(Surface::transparent, "transparent");
  return text;
}

void print_materials(const Scene& scene) {
  const auto front = std::ranges::count(scene.material_sides, Sides::front);
  fmt::print("sides       {} objects drawn on both sides, {} from their front alone\n",
             static_cast<std::ptrdiff_t>(scene.size()) - front, front);
  const auto whole =
      std::ranges::count_if(std::views::iota(std::size_t{0}, scene.size()), [&](std::size_t o) {
        return scene.surface[o] == Surface::cut_out && scene.alpha_image[o] == kNoAlphaImage;
      });
  fmt::print("cut-outs    {} alpha images; {} objects without one, drawn whole\n", scene.alpha_images.size(),
             whole);
}

void print_place(const Scene& scene) {
  const Box all = extent(scene);
  const WorldPoint &o = scene.origin, min{o.x + all.min.x, o.y + all.min.y, o.z + all.min.z},
                   max{o.x + all.max.x, o.y + all.max.y, o.z + all.max.z};
  fmt::print("bounds      ({:.2f}, {:.2f}, {:.2f}) to ({:.2f}, {:.2f}, {:.2f}) m\n", min.x, min.y, min.z,
             max.x, max.y, max.z);
  fmt::print("extent      {:.2f} x {:.2f} x {:.2f} m\n", all.max.x - all.min.x, all.max.y - all.min.y,
             all.max.z - all.min.z);
  if (o != WorldPoint{})
    fmt::print("origin      ({:.2f}, {:.2f}, {:.2f}) m, which positions count from\n", o.x, o.y, o.z);
}

void print_level(const LevelPvs& level) {
  fmt::print("level PVS   {} leaves, {} clusters, {} bytes{}\n", level.leaves.size(), level.clusters,
             level.visibility.size(),
             level.visibility.empty() ? " (none stored: everything may be seen)" : "");
  if (std::isfinite(level.far_plane))
    fmt::print("far plane   {:.2f} m: the level is not drawn beyond\n", level.far_plane);
}

void print(const Scene& scene) {
  std::uint64_t stored = 0;
  for (const Mesh& mesh : scene.meshes) stored += mesh.index_count / 3;
  fmt::print("scene       {}\n", printable(scene.name));
  fmt::print("objects     {} ({})\n", scene.size(), surfaces_of(scene));
  print_materials(scene);
  fmt::print("meshes      {}\n", scene.meshes.size());
  fmt::print("triangles   {} drawn, {} stored\n", triangle_count(scene), stored);
  print_place(scene);
  fmt::print("viewpoints  {}\n", scene.viewpoints.size());
  if (scene.level) print_level(*scene.level);
  for (const std::string& ignored : scene.ignored) fmt::print("ignored     {}\n", printable(ignored));
}

// All opaque triangles in world space, as occlusion takes a level.
OccluderMesh occluders_of(const Scene& scene, TJunctions junctions) {
  std::vector<Vec3> corners;
  for (ObjectId o = 0; o < scene.size(); ++o) {
    if (scene.surface[o] != Surface::opaque) continue;
    const Mesh& mesh = scene.meshes[scene.mesh[o]];
    const bool turned = mirrors(scene.transform[o]);
    for (std::uint32_t i = 0; i < mesh.index_count; ++i) {
      const std::uint32_t k = turned ? i - i % 3 + 2 - i % 3 : i;
      const std::uint32_t vertex = mesh.first_vertex + scene.indices[mesh.first_index + k];
      corners.push_back(transform_point(scene.transform[o], scene.positions[vertex]));
    }
  }
  std::vector<std::uint32_t> indices(corners.size());
  std::iota(indices.begin(), indices.end(), 0u);
  return or_throw(OccluderMesh::make(corners, indices, Sides::front, junctions));
}

// How many edges of its occluders are seams, and where the longest are that stay open.
void print_seams(const Scene& scene) {
  const OccluderMesh mesh = occluders_of(scene, TJunctions::closed);
  const std::size_t open = mesh.open_edges(),
                    junctions = occluders_of(scene, TJunctions::open).open_edges() - open;
  fmt::print("seams       {} of {} edges shared, {} along others in pieces (T-junctions), {} open\n",
             3 * mesh.triangles() - open - junctions, 3 * mesh.triangles(), junctions, open);
  std::vector<OccluderEdge> edges(open);
  mesh.open_edges(edges);
  const auto length = [](const OccluderEdge& e) {
    return std::hypot(e.to.x - e.from.x, e.to.y - e.from.y, e.to.z - e.from.z);
  };
  std::ranges::stable_sort(edges, std::greater(), length);
  constexpr std::size_t kLongest = 10;
  for (const OccluderEdge& e : edges | std::views::take(kLongest))
    fmt::print("open        {:.2f} m from ({:.3f}, {:.3f}, {:.3f}) to ({:.3f}, {:.3f}, {:.3f})\n", length(e),
               e.from.x, e.from.y, e.from.z, e.to.x, e.to.y, e.to.z);
}

}  // namespace

void add_info(CLI::App& app, int& exit) {
  CLI::App& command = *app.add_subcommand(
      "info", "Say what is in a scene: objects and their surfaces, meshes, triangles, bounds");
  auto scene = std::make_shared<std::string>();
  command.add_option("SCENE", *scene, kSceneHelp)->required();
  auto seams = std::make_shared<bool>(false);
  command
      .add_flag(
          "--seams", *seams,
          "Also how many edges of its occluders meet others, and the longest that do not: beside those, "
          "occlusion leaves single pixels open")
      ->disable_flag_override();
  on_run(command, exit, [scene, seams] {
    const Scene loaded = load_scene(*scene);
    print(loaded);
    if (*seams) print_seams(loaded);
    return Exit::done;
  });
}

}  // namespace sightline::app
