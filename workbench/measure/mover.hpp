// Objects that move while methods are examined.
#pragma once

#include <span>
#include <vector>

#include <sightline/workbench/scene.hpp>

namespace sightline::measure {

/// Moves a share of the objects a little every time, each about where it first stood, so that a scene keeps
/// its shape however long it is watched. Same seed, same moves.
class Mover {
public:
  Mover(Scene& scene, double share, std::uint64_t seed);
  /// The objects that have moved; none where the share is 0.
  std::span<const ObjectId> move();

private:
  Scene& scene_;
  std::size_t count_;
  std::uint64_t seed_;
  std::vector<Affine> home_;
  std::vector<ObjectId> order_;
};

}  // namespace sightline::measure
