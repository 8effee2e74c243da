// Sets of numbers as Roaring bitmaps in their portable form (github.com/RoaringBitmap/RoaringFormatSpec).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
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

/// What is wrong, a sentence; null where nothing is.
using Complaint = const char*;

/// Reads one, and checks everything: members ascending and below `limit`, nothing left over. Calls
/// visit(context, member) for each until it complains.
Complaint walk_set(std::span<const std::byte> bytes, std::uint32_t limit,
                   Complaint (*visit)(void* context, std::uint32_t member), void* context);

template <class Visit>
Complaint walk_set(std::span<const std::byte> bytes, std::uint32_t limit, Visit&& visit) {
  return walk_set(
      bytes, limit,
      [](void* context, std::uint32_t member) -> Complaint {
        return (*static_cast<std::remove_reference_t<Visit>*>(context))(member);
      },
      &visit);
}

/// Appends the members to `members`, and complains also where there are more than Sightline reads.
Complaint unpack_set(std::span<const std::byte> bytes, std::uint32_t limit,
                     std::vector<std::uint32_t>& members);

/// A run is short in a file and long in memory.
inline constexpr std::size_t kMostMembers = std::size_t{1} << 27;
inline constexpr Complaint kTooManyMembers = "pvs: a set holds more than Sightline reads";

}  // namespace sightline::pvs
