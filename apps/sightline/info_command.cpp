// sightline info: what is in a scene.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>

#include <sightline/workbench/io.hpp>

#include "command.hpp"

namespace sightline::app {

namespace {

void print(const Scene& scene) {
  const Box all = extent(scene);
  const auto transparent = std::count(scene.surface.begin(), scene.surface.end(), Surface::transparent);
  std::uint64_t stored = 0;
  for (const Mesh& mesh : scene.meshes) stored += mesh.index_count / 3;
  fmt::print("scene       {}\n", scene.name);
  fmt::print("objects     {} ({} opaque, {} transparent)\n", scene.size(),
             static_cast<std::ptrdiff_t>(scene.size()) - transparent, transparent);
  fmt::print("meshes      {}\n", scene.meshes.size());
  fmt::print("triangles   {} drawn, {} stored\n", triangle_count(scene), stored);
  fmt::print("bounds      ({:.2f}, {:.2f}, {:.2f}) to ({:.2f}, {:.2f}, {:.2f}) m\n", all.min.x, all.min.y,
             all.min.z, all.max.x, all.max.y, all.max.z);
  fmt::print("extent      {:.2f} x {:.2f} x {:.2f} m\n", all.max.x - all.min.x, all.max.y - all.min.y,
             all.max.z - all.min.z);
  fmt::print("viewpoints  {}\n", scene.viewpoints.size());
  if (!scene.level) return;
  const LevelPvs& level = *scene.level;
  fmt::print("level PVS   {} leaves, {} clusters, {} bytes{}\n", level.leaves.size(), level.clusters,
             level.visibility.size(),
             level.visibility.empty() ? " (none stored: everything may be seen)" : "");
}

}  // namespace

void add_info(CLI::App& app, int& exit) {
  CLI::App& command =
      *app.add_subcommand("info", "Say what is in a scene: objects, meshes, triangles, bounds, extent");
  auto scene = std::make_shared<std::string>();
  command.add_option("SCENE", *scene, kSceneHelp)->required();
  on_run(command, exit, [scene] {
    print(load_scene(*scene));
    return Exit::done;
  });
}

}  // namespace sightline::app
