// make_seeds FOLDER: writes FOLDER/fuzz_bsp, fuzz_pk3, fuzz_gltf, fuzz_image, fuzz_shaders, fuzz_pvs and
// fuzz_snapshot with a few whole files each.
#include <algorithm>
#include <cstdio>
#include <numeric>

#include <sightline/snapshot.hpp>
#include <sightline/workbench/error.hpp>
#include <sightline/workbench/io.hpp>

#include "library/pvs/cell_coding.hpp"
#include "library/pvs/set_coding.hpp"
#include "sample_files.hpp"
#include "workbench/io/alpha_png.hpp"
#include "workbench/scene/patterns.hpp"

namespace {

using namespace sightline;
using namespace sightline::samples;

void write_scenes_and_images(const std::filesystem::path& folder) {
  write(folder / "fuzz_gltf/one_triangle.gltf", to_bytes(one_triangle()));
  write_glb(load_scene("world:forest?trees=3"), folder / "fuzz_gltf/forest.glb");
  write_glb(read_bsp(to_bsp(two_rooms()), "two rooms"), folder / "fuzz_gltf/two_rooms.glb");
  write_glb(load_scene("world:cards?show=leaves"), folder / "fuzz_gltf/leaf_cards.glb");
  write_glb(load_scene("world:cards?show=grate"), folder / "fuzz_gltf/grate.glb");
  write(folder / "fuzz_image/leaves.png", io::write_alpha(scene::leaves_pattern(16, 0.5f, 1)));
  write(folder / "fuzz_image/grate.png", io::write_alpha(scene::grate_pattern(5, 2, 1)));
  Blob targa(18 + 5, std::byte{0x81});  // one run of two texels
  std::fill_n(targa.begin(), 18, std::byte{});
  targa[2] = std::byte{10}, targa[12] = std::byte{2}, targa[14] = std::byte{1}, targa[16] = std::byte{32};
  write(folder / "fuzz_image/run.tga", targa);
  write(folder / "fuzz_shaders/two.shader",
        to_bytes(std::string(
            "textures/a\n{\ncull none\nsurfaceparm trans // seen\n{\nmap a.tga\nalphaFunc GE128\n}\n}\n\f"
            "textures/b\n{\nsort additive\n/* blended */\n{\nmap \"b\"\nblendFunc GL_ONE GL_ZERO\n}\n}\n")));
  nlohmann::json sparse = one_triangle();
  sparse["accessors"][0]["sparse"] = {{"count", 1},
                                      {"indices", {{"bufferView", 1}, {"componentType", 5123}}},
                                      {"values", {{"bufferView", 0}}}};
  sparse["nodes"] = nlohmann::json::parse(
      R"([{"children": [1], "rotation": [0, 0, 0, 1]}, {"mesh": 0, "scale": [1, 2, 3]}])");
  sparse["meshes"][0]["primitives"][0]["mode"] = 5;
  write(folder / "fuzz_gltf/sparse_strip.gltf", to_bytes(sparse));
}

// Two worlds: of a few boxes, and of columns and free ids in several sectors.
void write_snapshots(const std::filesystem::path& folder) {
  for (const int count : {3, 400}) {
    std::vector<Box> boxes;
    for (int i = 0; i < count; ++i) {
      const auto x = static_cast<float>(i * 37 % 100 * 40), z = static_cast<float>(i * 11 % 50);
      boxes.push_back({{x, 0, z}, {x + 1, 1, z + 1}});
    }
    World world;
    std::vector<Handle> handles(boxes.size());
    std::vector<std::uint32_t> numbers(boxes.size(), 3);
    if (!world.insert(BoxView(boxes), handles)) throw Error("a box is refused");
    if (count > 3 && (!world.set_layers(handles, numbers) || !world.set_values(handles, numbers) ||
                      !world.set_distances(handles, std::vector<DistanceRange>(boxes.size())) ||
                      !world.remove(std::span<const Handle>(handles).first(20))))
      throw Error("a column is refused");
    Blob file;
    const SnapshotSink sink{[](void* user, std::span<const std::byte> bytes) {
                              auto& to = *static_cast<Blob*>(user);
                              to.insert(to.end(), bytes.begin(), bytes.end());
                              return true;
                            },
                            &file};
    if (!save(world, sink)) throw Error("a world is not saved");
    write(folder / ("fuzz_snapshot/" + std::to_string(count)), file);
  }
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) return std::fputs("usage: fuzz_seeds FOLDER\n", stderr), 2;
  const std::filesystem::path folder = argv[1];
  for (const char* target :
       {"fuzz_bsp", "fuzz_pk3", "fuzz_gltf", "fuzz_image", "fuzz_shaders", "fuzz_pvs", "fuzz_snapshot"})
    std::filesystem::create_directories(folder / target);

  Level level = two_rooms();
  write(folder / "fuzz_bsp/two_rooms.bsp", to_bsp(level));
  write(folder / "fuzz_pk3/two_rooms.pk3", to_pk3("maps/sample.bsp", to_bsp(level)));
  level.visibility.clear();
  write(folder / "fuzz_bsp/no_visibility.bsp", to_bsp(level));

  write_scenes_and_images(folder);
  write_snapshots(folder);

  // Twelve cells of sixty objects, as fuzz_pvs reads them: the file, each layout, and lone sets.
  CellPvs cells;
  cells.bounds = {{0, 0, 0}, {3, 2, 2}};
  cells.counts = {3, 2, 2}, cells.objects = 60, cells.scene = 1;
  cells.first.push_back(0);
  for (std::uint32_t cell = 0; cell < 12; ++cell) {
    cells.open.push_back(cell % 5 != 4);
    for (std::uint32_t o = cell; cells.open.back() && o < 60; o += 1 + o * cell % 7)
      cells.visible.push_back(o);
    cells.first.push_back(cells.visible.size());
  }
  write(folder / "fuzz_pvs/twelve_cells.pvs", *write_pvs(cells));
  const std::vector<std::uint32_t> order = pvs::object_order(cells);
  for (const pvs::Layout layout : pvs::kLayouts) {
    write(folder / ("fuzz_pvs/layout_" + std::to_string(static_cast<int>(layout))),
          pvs::code_cells(cells, layout, order));
  }
  std::vector<std::uint32_t> members(90000);
  std::iota(members.begin(), members.end(), 5u);
  write(folder / "fuzz_pvs/runs", pvs::pack_set(members));
  write(folder / "fuzz_pvs/bits", pvs::pack_set(std::span(members).first(5000), pvs::Runs::plain));
  write(folder / "fuzz_pvs/few", pvs::pack_set(std::span(members).first(3), pvs::Runs::plain));
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "fuzz_seeds: %s\n", error.what());
  return 2;
}
