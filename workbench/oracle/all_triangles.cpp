#include "workbench/oracle/all_triangles.hpp"

#include <algorithm>
#include <ranges>
#include <utility>

namespace sightline::oracle {

namespace {

constexpr std::uint32_t kNowhere = 0xffffffff;

/// The same triangles, each in a draw of its own, the last first.
std::vector<DrawCommand> turned_round(std::span<const DrawCommand> draws) {
  std::vector<DrawCommand> out;
  for (const DrawCommand& draw : std::views::reverse(draws)) {
    for (std::uint32_t t = draw.index_count / 3; t-- > 0;)
      out.push_back({3, 1, draw.first_index + 3 * t, draw.vertex_offset, draw.first_instance + t});
  }
  return out;
}

}  // namespace

AllTriangles::AllTriangles(device::Renderer& renderer, const TriangleGeometry& geometry)
    : renderer_(renderer), triangles_(renderer, geometry), draw_list_(renderer.scene()) {
  const Scene& scene = renderer_.scene();
  std::vector<std::uint32_t> at(triangle_count(scene), kNowhere);  // of each triangle the first copy
  for (std::uint32_t t = static_cast<std::uint32_t>(geometry.sources.size()); t-- > 0;)
    at[geometry.sources[t]] = t;
  ranges_.assign(scene.size(), {});
  std::uint32_t source = 0;
  for (ObjectId object = 0; object < scene.size(); ++object) {
    std::vector<DrawCommand>& ranges = ranges_[object];
    for (std::size_t i = 0; i < scene.triangles(object); ++i, ++source) {
      const std::uint32_t t = at[source];
      if (t == kNowhere) continue;
      if (!ranges.empty() && ranges.back().first_instance + ranges.back().index_count / 3 == t) {
        ranges.back().index_count += 3;
      } else {
        ranges.push_back({3, 1, 3 * t, 0, t});
      }
    }
  }
}

ItemBuffer AllTriangles::look(const View& view) {
  const Scene& scene = renderer_.scene();
  std::vector<DrawCommand> opaque, see_through;
  for (ObjectId object = 0; object < scene.size(); ++object) {
    auto& draws = scene.surface[object] == Surface::opaque ? opaque : see_through;
    draws.insert(draws.end(), ranges_[object].begin(), ranges_[object].end());
  }
  device::TriangleDraws::Items items = triangles_.items(view, opaque, Submission::calls, see_through);
  ItemBuffer out;
  out.width = view.width, out.height = view.height;
  out.ids = std::move(items.ids);
  out.pixels = std::move(items.seen);
  for (const ObjectId id : out.ids) {
    if (id != kNoObject) ++out.pixels[id];
  }
  return out;
}

device::Picture AllTriangles::picture(const View& view, Order order) {
  renderer_.frame(view, [&](device::Recorder& frame) {
    triangles_.draw(frame, everything(view, order), Submission::calls);
  });
  return renderer_.picture();
}

std::vector<DrawCommand> AllTriangles::everything(const View& view, Order order) {
  const Scene& scene = renderer_.scene();
  const auto blended = [&](ObjectId object) { return scene.surface[object] == Surface::transparent; };
  Frame all;
  for (ObjectId object = 0; object < scene.size(); ++object) {
    if (blended(object)) all.visible.push_back(object);
  }
  draw_list_.build(scene, view, all);
  std::vector<DrawCommand> draws;
  const auto draw = [&](ObjectId object) {
    draws.insert(draws.end(), ranges_[object].begin(), ranges_[object].end());
  };
  for (ObjectId object = 0; object < scene.size(); ++object) {
    if (!blended(object)) draw(object);
  }
  if (order == Order::falling) draws = turned_round(draws);
  std::ranges::for_each(all.visible, draw);
  return draws;
}

}  // namespace sightline::oracle
