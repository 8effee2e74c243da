// How far a level's own potentially visible sets agree with what rays see, and why they differ where they do.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include <sightline/workbench/scene.hpp>

#include "workbench/oracle/embree_judge.hpp"

namespace sightline::measure {

/// Why rays see an object that the level's visibility denies. The first reason that holds counts.
enum class PvsException : std::uint8_t {
  through_solid,  ///< every line of sight to it runs through solid leaves whose faces are not drawn (caulk)
  moving_part,    ///< of a door or lift, which leaves do not list by where it may be seen
  beyond_far_plane,  ///< every line of sight to it is longer than LevelPvs::far_plane
  unlisted,          ///< the leaf it is seen in may be seen, but does not list the face
  unconfirmed,       ///< seen in single precision alone, on a silhouette
  unexplained,
};
inline constexpr std::size_t kPvsExceptions = 6;

/// A sentence on what the reason means.
std::string_view explanation(PvsException exception) noexcept;

struct LevelEvidence {
  std::size_t eyes = 0;
  std::uint64_t objects_seen = 0;    ///< summed over the eyes
  std::uint64_t objects_denied = 0;  ///< of them, not in the leaf's potentially visible set
  std::array<std::uint64_t, kPvsExceptions> objects{};  ///< of the denied, by reason
  struct Example {
    Vec3 eye, seen;
    ObjectId object = kNoObject;
  };
  std::vector<Example> unexplained;  ///< the first ten
};

/// From `eyes` random places in open leaves, looks in six directions with `side`² pixels each, and holds
/// every object seen against the leaf's potentially visible set. Throws Error where the scene has no level.
LevelEvidence gather_level_evidence(const Scene& scene, const oracle::EmbreeJudge& judge, std::size_t eyes,
                                    std::uint32_t side, std::uint64_t seed);

}  // namespace sightline::measure
