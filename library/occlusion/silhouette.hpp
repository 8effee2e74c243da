// How much of the image a few triangles cover, looked at from all around.
#pragma once

#include <span>

#include "library/occlusion/flat_parts.hpp"

namespace sightline::occlusion {

/// The mean over directions of the pixels that they cover, seen without perspective, within a box. Shares of
/// the image: good for comparing.
double mean_silhouette(std::span<const Candidate> triangles, const glm::dvec3& low, const glm::dvec3& high);

}  // namespace sightline::occlusion
