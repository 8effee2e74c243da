// Bullet's dynamic bounding volume tree over boxes.
#pragma once

#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#include <sightline/boxes.hpp>

namespace sightline::benchmarks {

inline void fill(btDbvt& tree, const Boxes& boxes) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Box b = boxes[i];
    tree.insert(btDbvtVolume::FromMM({b.min.x, b.min.y, b.min.z}, {b.max.x, b.max.y, b.max.z}), nullptr)
        ->dataAsInt = static_cast<int>(i);
  }
}

}  // namespace sightline::benchmarks
