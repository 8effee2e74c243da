// sightline generate: a generated world as a file.
#include <fmt/format.h>

#include <memory>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/io.hpp>
#include <sightline/workbench/worlds.hpp>

#include "command.hpp"

namespace sightline::app {

namespace {

std::string list_of_worlds() {
  std::string text = "Worlds and their parameters:\n";
  for (const WorldInfo& world : worlds()) {
    text += fmt::format("  {:<10} {}\n", world.name, world.summary);
    for (const ParameterInfo& p : world.parameters) {
      text += fmt::format("  {:10} ?{}={}  ({}) {}\n", "", p.name, p.fallback, range_of(p), p.summary);
    }
  }
  return text;
}

}  // namespace

void add_generate(CLI::App& app, int& exit) {
  CLI::App& command = *app.add_subcommand("generate", "Write a generated world as a GLB file");
  command.footer(list_of_worlds());
  auto world = std::make_shared<std::string>(), file = std::make_shared<std::string>();
  command.add_option("WORLD", *world, "the world, with parameters as a query: forest?trees=30000&seed=7")
      ->required();
  command.add_option("-o,--output", *file, "the file to write")
      ->required()
      ->check(output_file(".glb"))
      ->type_name("FILE.glb");
  on_run(command, exit, [world, file] {
    const std::string name = world->starts_with("world:") ? world->substr(6) : *world;
    const Scene scene = generate_world(name);
    write_glb(scene, *file);
    fmt::print("{}: {} objects, {} triangles\n", printable(*file), scene.size(), triangle_count(scene));
    return Exit::done;
  });
}

}  // namespace sightline::app
