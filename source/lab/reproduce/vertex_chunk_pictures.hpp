// The pictures of the page of `reproduce vertex-chunk`.
#pragma once

#include "lab/device/workbench.hpp"
#include "lab/reproduce/vertex_chunk.hpp"

namespace sightline::lab {

/// The near view as `method` draws it; then the world from the side and above, in a picture of the same size:
/// what the method keeps of the near view and what it culls, and which chunk each object lies in.
std::vector<VertexChunkWorld::Picture> take_vertex_chunk_pictures(Workbench& bench, const std::string& world,
                                                                  const View& near,
                                                                  methods::DeviceMethod& method);

}  // namespace sightline::lab
