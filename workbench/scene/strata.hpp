// What `world:strata` holds, counted without making it: the paper's largest model has 263 million triangles.
#pragma once

#include <cstdint>
#include <string_view>

namespace sightline::scene {

struct StrataCount {
  std::uint64_t meshes = 0, vertices = 0, triangles = 0;
};

/// Of the world that generate_world makes of the same specification, "strata?model=4&full=yes": counted from
/// the plan that it is made by. Throws Error for parameters that are not the world's own or out of range.
StrataCount count_strata(std::string_view specification);

}  // namespace sightline::scene
