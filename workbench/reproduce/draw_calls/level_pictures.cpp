// Each level from above: the cells of the three structures and the way that the walk takes; and what is drawn
// of one view without and with occlusion.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include <sightline/workbench/error.hpp>
#include <sightline/workbench/io.hpp>

#include "workbench/methods/draw_calls/draw_call_method.hpp"
#include "workbench/report/canvas.hpp"
#include "workbench/reproduce/draw_calls/draw_call_sections.hpp"

namespace sightline::reproduce {

namespace {

using report::Colour;

constexpr std::uint32_t kWidth = 320, kHeight = 180;  // of the views

constexpr Colour kObjects{90, 110, 130, 18}, kCells{31, 119, 200, 110}, kDrawn{31, 119, 200, 60},
    kWay{217, 85, 63, 255};

std::string file_of_level(const LevelWalk& walk, std::string_view what) {
  return fmt::format("{}-{}.png", short_level(walk), what);
}

/// x to the right, z down, at twice the size of the picture.
class FromAbove {
public:
  explicit FromAbove(const Scene& scene)
      : all_(extent(scene)),
        scale_((kAcross - 2 * kMargin) / std::max(all_.max.x - all_.min.x, all_.max.z - all_.min.z)),
        canvas_(static_cast<std::uint32_t>(x(all_.max.x) + kMargin),
                static_cast<std::uint32_t>(z(all_.max.z) + kMargin)) {
    canvas_.fill_rectangle(0, 0, static_cast<float>(canvas_.width()), static_cast<float>(canvas_.height()),
                           {250, 250, 248});
    for (ObjectId object = 0; object < scene.size(); ++object) fill(scene.bounds[object], kObjects);
  }

  void fill(const Box& box, Colour colour) {
    canvas_.fill_rectangle(x(box.min.x), z(box.min.z), x(box.max.x), z(box.max.z), colour);
  }
  void outline(const Box& box, Colour colour) {
    canvas_.outline_rectangle(x(box.min.x), z(box.min.z), x(box.max.x), z(box.max.z), 2, colour);
  }
  void line(const Vec3& a, const Vec3& b) { canvas_.line(x(a.x), z(a.z), x(b.x), z(b.z), 4, kWay); }
  void disc(const Vec3& at) { canvas_.disc(x(at.x), z(at.z), 7, kWay); }
  void write(const std::filesystem::path& file) const { canvas_.halved().write_png(file); }

private:
  static constexpr float kAcross = 1400, kMargin = 20;

  [[nodiscard]] float x(float at) const { return kMargin + (at - all_.min.x) * scale_; }
  [[nodiscard]] float z(float at) const { return kMargin + (at - all_.min.z) * scale_; }

  Box all_;
  float scale_;
  report::Canvas canvas_;
};

void draw_cells(const Scene& scene, const LevelWalk& walk, std::string_view structure,
                const std::filesystem::path& file) {
  const auto method = create_method(fmt::format("drawcall-wise-{}", structure), scene);
  FromAbove picture(scene);
  for (const Box& cell : static_cast<const methods::DrawCallMethod&>(*method).cells())
    picture.outline(cell, kCells);
  const auto& cameras = walk.path.cameras;
  for (std::size_t c = 1; c < cameras.size(); ++c) picture.line(cameras[c - 1].eye, cameras[c].eye);
  for (const Camera& camera : cameras) picture.disc(camera.eye);
  picture.write(file);
}

/// The walk's camera that has the most in view.
const Camera& widest(const LevelWalk& walk, Method& method) {
  const Camera* widest = nullptr;
  std::size_t most = 0;
  Frame frame;
  for (const Camera& camera : walk.path.cameras) {
    cull(method, or_throw(make_view(camera, kWidth, kHeight)), frame);
    if (!widest || frame.visible.size() > most) widest = &camera, most = frame.visible.size();
  }
  return *widest;
}

// Objects of which something is drawn.
void draw_kept(const Scene& scene, const Camera& camera, Method& method, const std::filesystem::path& file) {
  Frame frame;
  cull(method, or_throw(make_view(camera, kWidth, kHeight)), frame);
  FromAbove picture(scene);
  for (const ObjectId object : frame.visible) picture.fill(scene.bounds[object], kDrawn);
  const Vec3 ahead{camera.eye.x + 4 * camera.forward.x, camera.eye.y, camera.eye.z + 4 * camera.forward.z};
  picture.line(camera.eye, ahead);
  picture.disc(camera.eye);
  picture.write(file);
}

}  // namespace

PaperSection levels_section(const LevelWalks& walks) {
  PaperSection section{
      "pictures", "the levels from above, with the cells at height 4 and the walk", {}, {}, {}};
  for (const LevelWalk& walk : walks) {
    const std::string level = short_level(walk);
    for (const auto structure : kWalkStructures) {
      section.html += picture(file_of_level(walk, structure),
                              fmt::format("{}, {}: the cells of the {}", level, walk.kind, structure));
    }
    section.html += before_after(
        file_of_level(walk, "plain"), file_of_level(walk, "masked"),
        fmt::format("{}: what drawcall-wise-octree draws of one view, without and with occlusion", level));
  }
  return section;
}

void write_level_pictures(const std::string& folder, const DrawCallMeasurement& measured) {
  const std::filesystem::path to = folder;
  std::error_code failed;
  std::filesystem::create_directories(to, failed);
  if (failed) throw Error(fmt::format("{}: the folder cannot be made: {}", folder, failed.message()));
  for (const LevelWalk& walk : measured.walks) {
    const Scene scene = load_scene(walk.level);
    for (const auto structure : kWalkStructures)
      draw_cells(scene, walk, structure, to / file_of_level(walk, structure));
    const auto plain = create_method("drawcall-wise-octree", scene),
               masked = create_method("drawcall-wise-octree?occlusion=masked", scene);
    const Camera& camera = widest(walk, *plain);
    draw_kept(scene, camera, *plain, to / file_of_level(walk, "plain"));
    draw_kept(scene, camera, *masked, to / file_of_level(walk, "masked"));
  }
}

}  // namespace sightline::reproduce
