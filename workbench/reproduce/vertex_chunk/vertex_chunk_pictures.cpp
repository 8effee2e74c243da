#include "workbench/reproduce/vertex_chunk/vertex_chunk_pictures.hpp"

#include <algorithm>
#include <cmath>

#include <sightline/workbench/error.hpp>

#include "library/world/chunk_map.hpp"
#include "workbench/device/renderer.hpp"
#include "workbench/device/scene_buffers.hpp"
#include "workbench/reproduce/painted.hpp"

namespace sightline::reproduce {

namespace {

constexpr std::uint32_t kShared = 0xff302c28u;  // as ABGR

Camera aside_of(const Scene& scene) {
  const Box all = extent(scene);
  const Vec3 middle{0.5f * (all.min.x + all.max.x), 0, 0.5f * (all.min.z + all.max.z)};
  const float reach = std::max(all.max.x - all.min.x, all.max.z - all.min.z);
  Camera camera;
  camera.eye = {middle.x + 0.72f * reach, 0.68f * reach, middle.z};
  camera.forward = {middle.x + 0.06f * reach - camera.eye.x, -camera.eye.y, 0};
  camera.near_plane = 1e-3f * reach;
  camera.far_plane = 4 * reach;
  return camera;
}

/// Each object in its chunk's colour; those that cross a border between regions dark.
std::vector<std::uint32_t> chunk_colours(const Scene& scene) {
  std::vector<std::uint32_t> colours(scene.size());
  world::ChunkMap map({extent(scene), 3});
  map.insert_all(scene.bounds);
  for (std::uint32_t chunk = 0; chunk < map.chunk_limit(); ++chunk) {
    const auto objects = map.chunk(chunk);
    if (objects.count == 0) continue;
    const std::uint32_t colour =
        map.chunk_regions(chunk).shared() ? kShared : device::colour_of(chunk, Surface::opaque);
    for (std::uint32_t i = 0; i < objects.count; ++i) colours[objects.objects[i]] = colour;
  }
  return colours;
}

}  // namespace

std::vector<VertexChunkWorld::Picture> take_vertex_chunk_pictures(measure::Bench& bench,
                                                                  const std::string& world, const View& near,
                                                                  measure::Subject& subject) {
  const Scene& scene = bench.scene();
  for (int settle = 0; settle < 2; ++settle) bench.run(subject, near);
  std::vector<VertexChunkWorld::Picture> pictures;
  pictures.push_back(
      {world + "-near.png", "The near view, as vertex-chunk draws it.", bench.renderer()->picture()});
  subject.method->read_back(subject.frame);
  std::vector<std::uint32_t> colours(scene.size(), kCulledColour);
  for (const ObjectId object : subject.frame.visible) colours[object] = kKeptColour;
  const View aside = or_throw(make_view(aside_of(scene), near.width, near.height));
  measure::Subject everything{"none", create_method("none", MethodSite{scene, bench.renderer()})};
  bench.run(everything, aside);
  const device::Picture lit = bench.renderer()->picture();
  const oracle::ItemBuffer items = bench.oracle().look(aside);
  pictures.push_back({world + "-aside.png", "Seen from the side.", lit});
  pictures.push_back({world + "-kept.png",
                      "Seen from the side, before and after: orange is what vertex-chunk keeps of the near "
                      "view, whose eye is in the "
                      "middle and looks to the right; grey is what it culls.",
                      painted(lit, items, colours)});
  pictures.push_back(
      {world + "-chunks.png",
       "The chunks, each in a colour; dark is what crosses a border between regions, in shared "
       "chunks.",
       painted(lit, items, chunk_colours(scene))});
  return pictures;
}

}  // namespace sightline::reproduce
