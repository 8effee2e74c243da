#include "workbench/reproduce/ray_pvs/ray_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>

#include <sightline/workbench/error.hpp>

#include "workbench/methods/ray_pvs/nearest_box.hpp"
#include "workbench/report/canvas.hpp"
#include "workbench/reproduce/painted.hpp"
#include "workbench/reproduce/ray_pvs/ray_views.hpp"

namespace sightline::reproduce {

namespace {

using report::Canvas;
using report::Colour;

struct Pixel {
  float x, y;
};

/// Where a point stands in the picture; nothing behind the eye.
std::optional<Pixel> project(const Mat4& clip, const View& view, const Vec3& p) {
  const auto row = [&](std::size_t r) {
    return clip.m[r] * p.x + clip.m[4 + r] * p.y + clip.m[8 + r] * p.z + clip.m[12 + r];
  };
  const float w = row(3);
  if (w <= 0) return std::nullopt;
  return Pixel{(0.5f + 0.5f * row(0) / w) * static_cast<float>(view.width),
               (0.5f - 0.5f * row(1) / w) * static_cast<float>(view.height)};
}

Canvas canvas_of(const device::Picture& picture) {
  Canvas canvas(picture.width, picture.height);
  for (std::uint32_t y = 0; y < picture.height; ++y) {
    for (std::uint32_t x = 0; x < picture.width; ++x) {
      const std::uint32_t p = picture.pixels[std::size_t{y} * picture.width + x];
      const auto byte = [&](int at) { return static_cast<std::uint8_t>(p >> at & 255); };
      canvas.set(x, y, {byte(0), byte(8), byte(16), 255});
    }
  }
  return canvas;
}

void draw_box(Canvas& canvas, const View& view, const Mat4& clip, const Box& box, float thickness,
              Colour colour) {
  std::array<std::optional<Pixel>, 8> corners;
  for (std::size_t i = 0; i < 8; ++i) {
    corners[i] = project(
        clip, view,
        {i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z});
  }
  for (std::size_t i = 0; i < 8; ++i) {
    for (const std::size_t axis : {1u, 2u, 4u}) {
      if ((i & axis) != 0 || !corners[i] || !corners[i | axis]) continue;
      const Pixel a = *corners[i], b = *corners[i | axis];
      canvas.line(a.x, a.y, b.x, b.y, thickness, colour);
    }
  }
}

/// From aside and above, with the side towards V in front; farther than V, so that the tree's root fits in.
View aside_view(const Scene& scene, const RayPvsOptions& options) {
  const Vec3 eye = eye_around(scene, 35, 30);
  return view_of_model({1.12f * eye.x, 1.12f * eye.y, 1.12f * eye.z}, options);
}

/// Straight from above, V beyond the lower edge.
View above_view(const Scene& scene, const RayPvsOptions& options) {
  const Box all = extent(scene);
  const float height =
      std::max(all.max.x - all.min.x, (all.max.z - all.min.z) * static_cast<float>(options.height) /
                                          static_cast<float>(options.width));
  return or_throw(make_view({.eye = {0, all.max.y + 1000, 0},
                             .forward = {0, -1, 0},
                             .up = {-1, 0, 0},
                             .orthographic_height = 1.05f * height,
                             .near_plane = 10,
                             .far_plane = all.max.y - all.min.y + 2000},
                            options.width, options.height));
}

device::Picture drawn(device::Renderer& renderer, const View& view, std::span<const ObjectId> objects) {
  Frame frame;
  frame.visible.assign(objects.begin(), objects.end());
  draw_frame(renderer, view, frame);
  return renderer.picture();
}

std::vector<ObjectId> all_of(const Scene& scene) {
  std::vector<ObjectId> all(scene.size());
  for (ObjectId object = 0; object < scene.size(); ++object) all[object] = object;
  return all;
}

/// Saves a picture of the model and tells of it.
void save(const RayPainter& painter, const device::Picture& picture, const char* name, RayPicture told,
          std::vector<RayPicture>& pictures) {
  told.file = fmt::format("model-{}-{}.png", painter.model, name);
  device::save_png(picture, (std::filesystem::path(painter.options.pictures) / told.file).string());
  pictures.push_back(std::move(told));
}

/// Figure 6: the tree's boxes over the faded model, first those of a few levels, then the leaves'.
void draw_tree_pictures(const RayPainter& painter, const View& view, const device::Picture& lit,
                        std::vector<RayPicture>& pictures) {
  constexpr std::uint32_t kLevels = 6;
  constexpr std::array<Colour, kLevels> kColours{Colour{222, 38, 92, 255},  Colour{226, 158, 38, 255},
                                                 Colour{42, 157, 110, 255}, Colour{32, 132, 208, 255},
                                                 Colour{176, 79, 192, 255}, Colour{90, 90, 90, 255}};
  const Scene& scene = painter.renderer.scene();
  rays::Bvh bvh;
  bvh.build(scene.bounds);
  Canvas levels = canvas_of(lit);
  levels.fill_rectangle(0, 0, static_cast<float>(lit.width), static_cast<float>(lit.height),
                        {255, 255, 255, 150});
  Canvas leaves = levels;
  const Mat4 clip = world_to_clip(view);
  std::vector<std::size_t> ends;  // of the subtrees around a node: one a level
  for (std::size_t i = 0; i < bvh.nodes().size(); ++i) {
    const rays::BvhNode& node = bvh.nodes()[i];
    while (!ends.empty() && ends.back() <= i) ends.pop_back();
    const std::size_t depth = ends.size();
    const Box box{node.min, node.max};
    if (depth < kLevels) draw_box(levels, view, clip, box, depth < 3 ? 3.0f : 1.5f, kColours[depth]);
    if (node.object != kNoObject) draw_box(leaves, view, clip, box, 1, {32, 132, 208, 50});
    ends.push_back(i + 1 + node.descendants);
  }
  const auto write = [&](const Canvas& canvas, const char* name, std::string caption) {
    RayPicture told{"figure 6", fmt::format("model-{}-{}.png", painter.model, name), std::move(caption), ""};
    canvas.write_png(std::filesystem::path(painter.options.pictures) / told.file);
    pictures.push_back(std::move(told));
  };
  write(levels, "tree",
        fmt::format("Model {}: the boxes of the tree's first {} levels, each level in a colour, the root's "
                    "red.",
                    painter.model, kLevels));
  write(leaves, "leaves", fmt::format("The boxes of its {} leaves, one a mesh.", scene.size()));
}

}  // namespace

void draw_model_pictures(const RayPainter& painter, const View& from_v, std::span<const ObjectId> kept,
                         std::vector<RayPicture>& pictures) {
  std::filesystem::create_directories(painter.options.pictures);
  const Scene& scene = painter.renderer.scene();
  const std::vector<ObjectId> all = all_of(scene);
  std::vector<std::uint32_t> colours(scene.size(), kCulledColour);
  for (const ObjectId object : kept) colours[object] = kKeptColour;
  const std::string model = fmt::format("Model {}", painter.model);

  const View aside = aside_view(scene, painter.options);
  const device::Picture lit = drawn(painter.renderer, aside, all);
  save(painter, lit, "aside", {"figure 11", "", model + ".", ""}, pictures);
  if (painter.model == 1) draw_tree_pictures(painter, aside, lit, pictures);

  const device::Picture everything = drawn(painter.renderer, from_v, all);
  save(painter, everything, "everything", {"", "", "", ""}, pictures);
  const std::string before = pictures.back().file;
  pictures.pop_back();  // it is shown under the next one's slider
  save(painter, drawn(painter.renderer, from_v, kept), "pvs",
       {"figure 12a", "", model + " from V: everything, and the PVS alone.", before}, pictures);
  save(painter, painted(everything, painter.judge.render(from_v), colours), "kept",
       {"figure 12a", "",
        model + " from V, everything drawn: orange is kept, grey is culled though it shows.", ""},
       pictures);
  const View above = above_view(scene, painter.options);
  save(
      painter, painted(drawn(painter.renderer, above, all), painter.judge.render(above), colours), "above",
      {"figure 12b", "", model + " from above, V beyond the lower edge: orange is kept, grey is culled.", ""},
      pictures);
}

std::uint32_t red_to_green(double share) {
  // Through yellow: of red and green one is always full.
  const double s = std::clamp(share, 0.0, 1.0);
  const auto byte = [](double of) { return static_cast<std::uint32_t>(std::lround(of)); };
  return 0xff000000u | byte(40) << 16 | byte(210 * std::min(1.0, 2 * s)) << 8 |
         byte(220 * std::min(1.0, 2 - 2 * s));
}

void draw_viewpoints_picture(device::Renderer& renderer, std::span<const RayViewpoint> viewpoints,
                             const RayPvsOptions& options, std::vector<RayPicture>& pictures) {
  std::filesystem::create_directories(options.pictures);
  const Scene& scene = renderer.scene();
  const Vec3 from = eye_around(scene, 35, 35);
  constexpr float kFarther = 2.5f;
  const Vec3 eye{kFarther * from.x, kFarther * from.y, kFarther * from.z};
  const View view = or_throw(make_view({.eye = eye,
                                        .forward = {-eye.x, -eye.y, -eye.z},
                                        .vertical_fov = 0.8f,
                                        .near_plane = 100,
                                        .far_plane = 3e5f},
                                       options.width, options.height));
  Canvas canvas = canvas_of(drawn(renderer, view, all_of(scene)));
  double least = 1e300, most = 0;
  for (const RayViewpoint& at : viewpoints)
    least = std::min(least, at.ratio()), most = std::max(most, at.ratio());
  const Mat4 clip = world_to_clip(view);
  for (const RayViewpoint& at : viewpoints) {
    const auto pixel = project(clip, view, at.eye);
    if (!pixel) continue;
    const std::uint32_t c = red_to_green(most > least ? (at.ratio() - least) / (most - least) : 1);
    const auto byte = [&](int shift) { return static_cast<std::uint8_t>(c >> shift & 255); };
    canvas.disc(pixel->x, pixel->y, 9, {30, 34, 40, 255});
    canvas.disc(pixel->x, pixel->y, 7, {byte(0), byte(8), byte(16), 255});
  }
  RayPicture told{"figure 13", "viewpoints.png",
                  fmt::format("Model 4 and the viewpoints around it: drawing everything takes from {:.2f} "
                              "(red) to {:.2f} (green) times as long as drawing the PVS alone.",
                              least, most),
                  ""};
  canvas.write_png(std::filesystem::path(options.pictures) / told.file);
  pictures.push_back(std::move(told));
}

}  // namespace sightline::reproduce
