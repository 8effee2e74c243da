// Worlds in bytes, and worlds that are the same.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <vector>

#include <sightline/snapshot.hpp>

#include "library/world/world_state.hpp"
#include "support/cull.hpp"
#include "support/forged_checksums.hpp"

namespace sightline::test {

using FileBytes = std::vector<std::byte>;

inline SnapshotSink sink_into(FileBytes& out) {
  return {[](void* user, std::span<const std::byte> bytes) {
            auto& to = *static_cast<FileBytes*>(user);
            to.insert(to.end(), bytes.begin(), bytes.end());
            return true;
          },
          &out};
}

inline FileBytes saved(const World& world) {
  FileBytes out;
  const Status done = save(world, sink_into(out));
  EXPECT_TRUE(done) << done.message();
  return out;
}

/// What a cull wrote, in its order: id, mask and level of each.
using Seen = std::vector<std::tuple<ObjectId, std::uint8_t, std::uint8_t>>;

inline Seen seen(const World& world, std::span<const CullView> views) {
  Culler culler;
  std::vector<ObjectId> ids(cull_capacity(world));
  std::vector<std::uint8_t> masks(ids.size()), levels(ids.size());
  const auto result = culler.cull(world, views, {}, {ids, masks, levels});
  EXPECT_TRUE(result) << result.error().message();
  Seen out;
  for (std::size_t i = 0; result && i < result->count; ++i) out.emplace_back(ids[i], masks[i], levels[i]);
  return out;
}

inline Seen sorted(Seen seen) {
  std::sort(seen.begin(), seen.end());
  return seen;
}

/// Whether every invariant of every sector holds.
inline void expect_sound(const World& world) {
  for (const world::Sector& sector : WorldAccess::state(world).sectors) {
    if (!sector.map) continue;
    const Status sound = sector.map->check();
    ASSERT_TRUE(sound) << sound.message() << ' ' << sound.index();
  }
}

/// What the worlds say of each id.
inline void expect_same_objects(const World& a, const World& b) {
  ASSERT_EQ(a.size(), b.size());
  ASSERT_EQ(a.id_limit(), b.id_limit());
  for (std::size_t i = 0; i < a.id_limit(); ++i) {
    const Handle handle = a.handle(static_cast<ObjectId>(i));
    ASSERT_EQ(handle, b.handle(static_cast<ObjectId>(i)));
    ASSERT_EQ(a.box(handle), b.box(handle));
    ASSERT_EQ(a.layers(handle), b.layers(handle));
    ASSERT_EQ(a.value(handle), b.value(handle));
    ASSERT_EQ(a.distances(handle), b.distances(handle));
    ASSERT_EQ(a.levels(handle), b.levels(handle));
  }
}

}  // namespace sightline::test
