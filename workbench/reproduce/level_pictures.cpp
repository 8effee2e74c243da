// Each level from above, with the cells of the three structures and the way that the walk takes.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/io.hpp>

#include "workbench/methods/draw_calls/draw_call_method.hpp"
#include "workbench/report/canvas.hpp"
#include "workbench/reproduce/draw_call_sections.hpp"

namespace sightline::reproduce {

namespace {

std::string file_of_level(const LevelWalk& walk, std::string_view structure) {
  return fmt::format("{}-{}.png", short_level(walk), structure);
}

// x to the right, z down: cells outlined, the walk on top.
void draw_from_above(const Scene& scene, const LevelWalk& walk, std::string_view structure,
                     const std::filesystem::path& file) {
  const auto method = create_method(fmt::format("drawcall-wise-{}", structure), scene);
  const Box all = extent(scene);
  constexpr float kWidth = 1400, kMargin = 20;
  const float scale = (kWidth - 2 * kMargin) / std::max(all.max.x - all.min.x, all.max.z - all.min.z);
  const auto x = [&](float at) { return kMargin + (at - all.min.x) * scale; };
  const auto z = [&](float at) { return kMargin + (at - all.min.z) * scale; };
  report::Canvas canvas(static_cast<std::uint32_t>(x(all.max.x) + kMargin),
                        static_cast<std::uint32_t>(z(all.max.z) + kMargin));
  canvas.fill_rectangle(0, 0, static_cast<float>(canvas.width()), static_cast<float>(canvas.height()),
                        {250, 250, 248});
  for (std::size_t object = 0; object < scene.size(); ++object) {
    const Box b = scene.bounds[object];
    canvas.fill_rectangle(x(b.min.x), z(b.min.z), x(b.max.x), z(b.max.z), {90, 110, 130, 18});
  }
  for (const Box& cell : static_cast<const methods::DrawCallMethod&>(*method).cells()) {
    canvas.outline_rectangle(x(cell.min.x), z(cell.min.z), x(cell.max.x), z(cell.max.z), 2,
                             {31, 119, 200, 110});
  }
  const auto& cameras = walk.path.cameras;
  for (std::size_t c = 1; c < cameras.size(); ++c) {
    canvas.line(x(cameras[c - 1].eye.x), z(cameras[c - 1].eye.z), x(cameras[c].eye.x), z(cameras[c].eye.z), 4,
                {217, 85, 63});
  }
  for (const Camera& camera : cameras) canvas.disc(x(camera.eye.x), z(camera.eye.z), 7, {217, 85, 63});
  canvas.halved().write_png(file);
}

}  // namespace

PaperSection levels_section(const LevelWalks& walks) {
  PaperSection section{
      "pictures", "the levels from above, with the cells at height 4 and the walk", {}, {}, {}};
  for (const LevelWalk& walk : walks) {
    for (const auto structure : kWalkStructures) {
      section.html +=
          picture(file_of_level(walk, structure),
                  fmt::format("{}, {}: the cells of the {}", short_level(walk), walk.kind, structure));
    }
  }
  return section;
}

void write_level_pictures(const std::string& folder, const DrawCallMeasurement& measured) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw Error(fmt::format("{}: the folder cannot be made: {}", folder, failed.message()));
  for (const LevelWalk& walk : measured.walks) {
    const Scene scene = load_scene(walk.level);
    for (const auto structure : kWalkStructures)
      draw_from_above(scene, walk, structure, std::filesystem::path(folder) / file_of_level(walk, structure));
  }
}

}  // namespace sightline::reproduce
