// Contribution culling: dropping what covers less than a pixel, by area as published or exactly.
#pragma once

#include <span>

#include <sightline/projection.hpp>
#include <sightline/workbench/parameters.hpp>
#include <sightline/workbench/scene.hpp>

namespace sightline::submission {

struct Contribution {
  enum class Test : std::uint8_t {
    off,
    exact,  ///< drops an object whose image holds no pixel centre
    area,   ///< Lee & Shin 2023, section 3.1: drops a bounding sphere of less than `threshold` px²;
            ///< approximate
  };
  Test test = Test::off;
  float threshold = 1;  ///< px²

  /// Removes from ids[0, count) what contributes nothing; keeps the order; returns how many are left.
  std::size_t filter(const Scene& scene, const Projector& projector, std::span<ObjectId> ids) const noexcept;
};

/// The parameters `contribution` and `threshold`, for the tables of methods that have them.
inline constexpr ParameterInfo kContributionParameter{
    "contribution",
    "drops what covers no sample (exact) or less than a threshold (area)",
    "off",
    0,
    0,
    false,
    "off|exact|area"};
inline constexpr ParameterInfo kThresholdParameter{"threshold", "px², for contribution=area", "1", 0, 1e6};
Contribution contribution_from(const Parameters& parameters) noexcept;

}  // namespace sightline::submission
