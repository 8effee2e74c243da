// The pictures of the page of `reproduce vertex-chunk`.
#pragma once

#include "workbench/measure/bench.hpp"
#include "workbench/reproduce/vertex_chunk/vertex_chunk.hpp"

namespace sightline::reproduce {

/// The near view as `subject` draws it; then the world from the side and above, in a picture of the same
/// size: what the method keeps of the near view and what it culls, and which chunk each object lies in.
std::vector<VertexChunkWorld::Picture> take_vertex_chunk_pictures(measure::Bench& bench,
                                                                  const std::string& world, const View& near,
                                                                  measure::Subject& subject);

}  // namespace sightline::reproduce
