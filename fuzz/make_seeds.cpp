// make_seeds FOLDER: writes FOLDER/fuzz_bsp, FOLDER/fuzz_pk3 and FOLDER/fuzz_gltf with a few whole files
// each.
#include <cstdio>

#include <sightline/io.hpp>

#include "sample_files.hpp"

int main(int argc, char** argv) try {
  using namespace sightline;
  using namespace sightline::samples;
  if (argc != 2) return std::fputs("usage: fuzz_seeds FOLDER\n", stderr), 2;
  const std::filesystem::path folder = argv[1];
  for (const char* target : {"fuzz_bsp", "fuzz_pk3", "fuzz_gltf"})
    std::filesystem::create_directories(folder / target);

  Level level = two_rooms();
  write(folder / "fuzz_bsp/two_rooms.bsp", to_bsp(level));
  write(folder / "fuzz_pk3/two_rooms.pk3", to_pk3("maps/sample.bsp", to_bsp(level)));
  level.visibility.clear();
  write(folder / "fuzz_bsp/no_visibility.bsp", to_bsp(level));

  write(folder / "fuzz_gltf/one_triangle.gltf", to_bytes(one_triangle()));
  write_glb(load_scene("world:forest?trees=3"), folder / "fuzz_gltf/forest.glb");
  write_glb(read_bsp(to_bsp(two_rooms()), "two rooms"), folder / "fuzz_gltf/two_rooms.glb");
  nlohmann::json sparse = one_triangle();
  sparse["accessors"][0]["sparse"] = {{"count", 1},
                                      {"indices", {{"bufferView", 1}, {"componentType", 5123}}},
                                      {"values", {{"bufferView", 0}}}};
  sparse["nodes"] = nlohmann::json::parse(
      R"([{"children": [1], "rotation": [0, 0, 0, 1]}, {"mesh": 0, "scale": [1, 2, 3]}])");
  sparse["meshes"][0]["primitives"][0]["mode"] = 5;
  write(folder / "fuzz_gltf/sparse_strip.gltf", to_bytes(sparse));
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "fuzz_seeds: %s\n", error.what());
  return 2;
}
