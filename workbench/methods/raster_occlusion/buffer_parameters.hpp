// How an OcclusionBuffer answers, as parameters of a method.
#pragma once

#include <string_view>

#include <sightline/occlusion.hpp>

#include "workbench/methods/methods.hpp"

namespace sightline::methods {

inline constexpr ParameterInfo kCoverageParameter{
    "coverage",
    "what is answered for: pixel centres, or any place on the image, for multisampling and jitter",
    "centres",
    0,
    0,
    false,
    "centres|area"};
inline constexpr ParameterInfo kResolutionParameter{
    "resolution",       "of the depth buffer; coarser has fewer tiles and hides less", "full", 0, 0, false,
    "full|half|quarter"};

inline OcclusionOptions buffer_from(const Parameters& parameters) {
  const std::string_view resolution = parameters.word("resolution");
  return {parameters.word("coverage") == "area" ? Coverage::area : Coverage::centres,
          resolution == "full"   ? 1u
          : resolution == "half" ? 2u
                                 : 4u};
}

}  // namespace sightline::methods
