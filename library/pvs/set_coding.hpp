// Sets of numbers as Roaring bitmaps in their portable form (github.com/RoaringBitmap/RoaringFormatSpec).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace sightline::pvs {

/// How members that lie close are stored.
enum class Runs {
  coded,  ///< as runs where that is shorter
  plain,  ///< as bits: longer, and better food for a compressor
};

/// A set, ascending.
std::vector<std::byte> pack_set(std::span<const std::uint32_t> members, Runs runs = Runs::coded);

/// Reads one, and checks everything: members ascending and below `limit`, nothing left over. Calls
/// visit(context, member) for each. Throws Error; `what` names the set.
void walk_set(std::span<const std::byte> bytes, std::uint32_t limit, const std::string& what,
              void (*visit)(void* context, std::uint32_t member), void* context);

template <class Visit>
void walk_set(std::span<const std::byte> bytes, std::uint32_t limit, const std::string& what, Visit&& visit) {
  walk_set(
      bytes, limit, what,
      [](void* context, std::uint32_t member) {
        (*static_cast<std::remove_reference_t<Visit>*>(context))(member);
      },
      &visit);
}

/// Appends the members to `members`. Throws Error, also where there are more than Sightline reads.
void unpack_set(std::span<const std::byte> bytes, std::uint32_t limit, const std::string& what,
                std::vector<std::uint32_t>& members);

/// A run is short in a file and long in memory.
inline constexpr std::size_t kMostMembers = std::size_t{1} << 27;

}  // namespace sightline::pvs
