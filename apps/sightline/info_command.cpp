// sightline info: what is in a scene.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <ranges>

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
  fmt::print("scene       {}\n", scene.name);
  fmt::print("objects     {} ({})\n", scene.size(), surfaces_of(scene));
  print_materials(scene);
  fmt::print("meshes      {}\n", scene.meshes.size());
  fmt::print("triangles   {} drawn, {} stored\n", triangle_count(scene), stored);
  print_place(scene);
  fmt::print("viewpoints  {}\n", scene.viewpoints.size());
  if (scene.level) print_level(*scene.level);
  for (const std::string& ignored : scene.ignored) fmt::print("ignored     {}\n", ignored);
}

}  // namespace

void add_info(CLI::App& app, int& exit) {
  CLI::App& command = *app.add_subcommand(
      "info", "Say what is in a scene: objects and their surfaces, meshes, triangles, bounds");
  auto scene = std::make_shared<std::string>();
  command.add_option("SCENE", *scene, kSceneHelp)->required();
  on_run(command, exit, [scene] {
    print(load_scene(*scene));
    return Exit::done;
  });
}

}  // namespace sightline::app
