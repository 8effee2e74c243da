// What a random world should hold: every object with all that it was given, in the plainest form.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <utility>
#include <vector>

#include <sightline/world.hpp>

#include "workbench/scene/random.hpp"

namespace sightline::lives {

using scene::Random;

inline bool one_in(Random& random, std::uint32_t count) {
  return random.below(count) == 0;
}
template <class T>
T any_of(Random& random, std::initializer_list<T> values) {
  return values.begin()[random.below(static_cast<std::uint32_t>(values.size()))];
}
/// For places of any distance from 0.
inline double within(Random& random, double metres) {
  return double{random.between(-1, 1)} * metres;
}
/// A number below a size, which may be 0.
inline std::size_t below(Random& random, std::size_t count) {
  return random.below(static_cast<std::uint32_t>(count));
}

struct Object {
  Handle handle;  // of nobody where the id is free
  WorldBox given, stored;
  std::uint32_t layers = kAllLayers, value = 0;
  DistanceRange distances;
  LevelTableId table = kNoLevels;
  bool in = true;        // while its sector is not out of the world
  bool changed = false;  // since a stream began, so its sector stays in
};

class Model {
public:
  [[nodiscard]] bool has(ObjectId id) const {
    return id < objects.size() && objects[id].handle.index != kNoObject && objects[id].in;
  }
  /// The ids of all that are in.
  [[nodiscard]] std::vector<ObjectId> all() const {
    std::vector<ObjectId> out;
    for (const ObjectId id : standing)
      if (objects[id].in) out.push_back(id);
    return out;
  }
  /// Different ones, in any order.
  [[nodiscard]] std::vector<ObjectId> some(Random& random, std::size_t most) const {
    std::vector<ObjectId> out = all();
    const std::size_t count = std::min(most, out.size());
    for (std::size_t i = 0; i < count; ++i) std::swap(out[i], out[i + below(random, out.size() - i)]);
    out.resize(count);
    return out;
  }
  [[nodiscard]] std::vector<Handle> handles(const std::vector<ObjectId>& ids) const {
    std::vector<Handle> out;
    for (const ObjectId id : ids) out.push_back(objects[id].handle);
    return out;
  }

  void put(const Object& object) {
    const ObjectId id = object.handle.index;
    if (id >= objects.size()) objects.resize(id + 1);
    objects[id] = object;
    standing.push_back(id);
    note_size(object.given);
  }
  void take_out(const std::vector<ObjectId>& ids) {
    constexpr std::size_t kMostGone = 500;
    for (const ObjectId id : ids) {
      const Handle handle = objects[id].handle;
      if (gone.size() < kMostGone) gone.emplace_back();
      gone[gone.size() < kMostGone ? gone.size() - 1 : id % kMostGone] = handle;
      objects[id] = {};
      objects[id].handle.generation = handle.generation + 1;  // the least that may follow
    }
    std::erase_if(standing, [&](ObjectId id) { return objects[id].handle.index == kNoObject; });
  }
  void note_size(const WorldBox& box) {
    largest = std::max({largest, box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z});
  }

  std::vector<Object> objects;                 // by id
  std::vector<ObjectId> standing;              // in the world, or out with their sector
  std::vector<Handle> gone;                    // handles of objects that were removed
  std::vector<std::vector<float>> tables{{}};  // of levels, by their ids
  double largest = 1;                          // side of any box that ever stood here
};

}  // namespace sightline::lives
