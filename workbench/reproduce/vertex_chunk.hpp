// Lee & Shin 2023, section 4: tables 1 to 5 and figure 7, for both worlds.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "workbench/device/frame_times.hpp"
#include "workbench/measure/compare.hpp"
#include "workbench/report/summary.hpp"

namespace sightline::reproduce {

/// One world's figures.
struct VertexChunkWorld {
  std::string name;                   ///< "regular" or "irregular"
  measure::Comparison near, far;      ///< one view each
  measure::Comparison rising;         ///< figure 7: the camera climbs from the near view to the far one
  std::vector<report::Table> tables;  ///< 1 to 5: ours beside the published, as ratios to vertex-chunk
  report::Table rising_fps;           ///< figure 7 as figures
  struct Picture {
    std::string file, caption;
    device::Picture pixels;
  };
  std::vector<Picture> pictures;
};

struct VertexChunkOptions {
  bool quick = false;
  bool pictures = false;
};

/// The world as the paper has it: 9,024 spheres. The paper does not say how many triangles a sphere has.
Scene vertex_chunk_scene(const std::string& world, bool quick);

/// Near the ground in the middle of the world, where nothing stands within half a metre: a quarter of the
/// world is in view, as the paper's figures imply.
Camera vertex_chunk_near(const Scene& scene);
Camera vertex_chunk_far(const Scene& scene);

/// Measures one world. Throws Error as Bench and compare() do.
VertexChunkWorld reproduce_vertex_chunk(device::Device& device, const std::string& world,
                                        const VertexChunkOptions& options, const Progress& progress = {});

/// Writes index.html, with figure 7 as charts, and the pictures.
void write_vertex_chunk_report(const std::string& folder, std::span<const VertexChunkWorld> worlds);

}  // namespace sightline::reproduce
