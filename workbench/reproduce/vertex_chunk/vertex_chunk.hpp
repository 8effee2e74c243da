// Lee & Shin 2023, section 4: tables 1 to 5 and figure 7, for both worlds.
#pragma once

#include <string>
#include <vector>

#include "workbench/device/frame_times.hpp"
#include "workbench/measure/compare.hpp"
#include "workbench/reproduce/reproduction.hpp"

namespace sightline::reproduce {

/// How a world's objects fill its chunks (section 3.3).
struct ChunkCounts {
  std::size_t chunks = 0, shared_chunks = 0;    ///< that hold an object; of these, across regions' borders
  std::size_t objects = 0, shared_objects = 0;  ///< all; those in shared chunks
  std::size_t fullest = 0;                      ///< objects in the fullest
};

/// One world's figures. Empty comparisons have not been measured.
struct VertexChunkWorld {
  std::string name;                           ///< "regular" or "irregular"
  measure::Comparison near;                   ///< tables 1 to 4: one view near the ground
  measure::Comparison counted;                ///< the same view by hroc, its rays counted
  measure::Comparison near_views, far_views;  ///< table 5: by headings, and from several sides
  measure::Comparison rising;                 ///< figure 7: the camera climbs straight up from the near view
  ChunkCounts chunks;
  std::vector<device::PassTime> passes;  ///< figure 2: a frame of vertex-chunk, in its order
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

/// Measures one world. Throws Error as Bench and compare() do.
VertexChunkWorld measure_vertex_chunk(device::Device& device, const std::string& world,
                                      const VertexChunkOptions& options, const Progress& progress = {});

/// The paper's tables, figure 7, and what its own figures contradict. Of what was not measured the paper's
/// numbers alone.
Reproduction vertex_chunk_reproduction(const std::vector<VertexChunkWorld>& worlds);

}  // namespace sightline::reproduce
