// What stands behind JavaScript's World and Culler, for the module's two parts.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <unordered_set>
#include <vector>

#include <sightline/world.hpp>

namespace sightline::web {

/// A handle is one number in JavaScript: 31 bits of index below 22 of generation, which a double holds.
inline constexpr double kIndices = 2147483648.0;
inline constexpr std::uint32_t kLastGeneration = (1u << 22) - 1;

inline double number_of(const Handle& handle) noexcept {
  return handle.generation * kIndices + handle.index;
}

inline Handle handle_of(double number) noexcept {
  if (!(number >= 0 && number < 9007199254740992.0)) return {};
  const auto generation = static_cast<std::uint32_t>(number / kIndices);
  const Handle handle{static_cast<ObjectId>(number - generation * kIndices), generation};
  return number_of(handle) == number ? handle : Handle{};  // a fraction names nothing
}

/// A world, and the ids whose generations are spent: their objects stay in it, in no layer, so that no handle
/// of theirs is ever given out again.
struct WebWorld {
  World world;
  std::unordered_set<ObjectId> retired;
  std::vector<Handle> handles;  // of the call that is running

  const std::vector<Handle>& read(const double* numbers, std::size_t count) {
    handles.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const Handle handle = handle_of(numbers[i]);
      handles[i] = retired.contains(handle.index) ? Handle{} : handle;
    }
    return handles;
  }
};

struct WebCuller {
  Culler culler;
  std::vector<std::uint8_t> mask_of;  // by value, while sorting
};

/// Takes away what retired objects carry; of the whole module, for in `core` they carry nothing.
using TakeOccluders = void (*)(World&, std::span<const Handle>);
extern TakeOccluders take_occluders;

}  // namespace sightline::web
