#include "library/pvs/set_coding.hpp"

#include <roaring/roaring.h>

#include <memory>
#include <new>

#include <sightline/workbench/error.hpp>

#include "workbench/io/byte_reader.hpp"

namespace sightline::pvs {

using io::Bytes;
using io::fits;
using io::read_at;

std::vector<std::byte> pack_set(std::span<const std::uint32_t> members, Runs runs) {
  const std::unique_ptr<roaring_bitmap_t, decltype(&roaring_bitmap_free)> bitmap(
      roaring_bitmap_of_ptr(members.size(), members.data()), roaring_bitmap_free);
  if (!bitmap) throw std::bad_alloc();
  if (runs == Runs::coded) roaring_bitmap_run_optimize(bitmap.get());
  std::vector<std::byte> bytes(roaring_bitmap_portable_size_in_bytes(bitmap.get()));
  roaring_bitmap_portable_serialize(bitmap.get(), reinterpret_cast<char*>(bytes.data()));
  return bytes;
}

// Read here and not by the library: its reader does not check what lies within the containers.
void walk_set(Bytes b, std::uint32_t limit, const std::string& what,
              void (*visit)(void* context, std::uint32_t member), void* context) {
  const auto fail = [&](const char* why) { throw Error(what + ": " + why); };
  constexpr std::uint32_t kNoRuns = 12346, kRuns = 12347;
  constexpr std::uint32_t kArrayMost = 4096, kFewWithRuns = 4;
  if (b.size() < 4) fail("ends within its header");
  const auto cookie = read_at<std::uint32_t>(b, 0);
  std::size_t at = 4, count = 0;
  const bool has_runs = (cookie & 0xffff) == kRuns;
  std::size_t run_flags = 0;
  if (has_runs) {
    count = (cookie >> 16) + 1;
    run_flags = at;
    at += (count + 7) / 8;
  } else if (cookie == kNoRuns) {
    if (b.size() < 8) fail("ends within its header");
    count = read_at<std::uint32_t>(b, 4);
    at = 8;
  } else {
    fail("is no bitmap");
  }
  if (count > 65536 || !fits(at, count * 4, b.size())) fail("names more containers than it holds");
  const std::size_t keys = at;
  at += count * 4;
  if (!has_runs || count >= kFewWithRuns) at += count * 4;  // offsets, which follow from the sizes
  std::int64_t last = -1;
  const auto add = [&](std::uint32_t member) {
    if (static_cast<std::int64_t>(member) <= last || member >= limit) {
      fail("holds numbers out of order or out of range");
    }
    last = member;
    visit(context, member);
  };
  for (std::size_t c = 0; c < count; ++c) {
    const std::uint32_t high = std::uint32_t{read_at<std::uint16_t>(b, keys + c * 4)} << 16;
    const std::uint32_t members = std::uint32_t{read_at<std::uint16_t>(b, keys + c * 4 + 2)} + 1;
    const bool is_run = has_runs && (static_cast<unsigned>(b[run_flags + c / 8]) >> (c % 8) & 1u) != 0;
    if (is_run) {
      if (!fits(at, 2, b.size())) fail("ends within a container");
      const std::uint32_t runs = read_at<std::uint16_t>(b, at);
      at += 2;
      if (!fits(at, std::uint64_t{runs} * 4, b.size())) fail("ends within a container");
      for (std::uint32_t r = 0; r < runs; ++r, at += 4) {
        const std::uint32_t start = read_at<std::uint16_t>(b, at), length = read_at<std::uint16_t>(b, at + 2);
        if (start + length > 0xffff) fail("has a run beyond its container");
        for (std::uint32_t i = 0; i <= length; ++i) add(high | (start + i));
      }
    } else if (members <= kArrayMost) {
      if (!fits(at, std::uint64_t{members} * 2, b.size())) fail("ends within a container");
      for (std::uint32_t i = 0; i < members; ++i, at += 2) add(high | read_at<std::uint16_t>(b, at));
    } else {
      if (!fits(at, 8192, b.size())) fail("ends within a container");
      for (std::uint32_t i = 0; i < 65536; ++i) {
        if ((static_cast<unsigned>(b[at + i / 8]) >> (i % 8) & 1u) != 0) add(high | i);
      }
      at += 8192;
    }
  }
  if (at != b.size()) fail("is longer than its containers");
}

void unpack_set(Bytes bytes, std::uint32_t limit, const std::string& what,
                std::vector<std::uint32_t>& members) {
  walk_set(bytes, limit, what, [&](std::uint32_t member) {
    if (members.size() >= kMostMembers) throw Error(what + ": holds more than Sightline reads");
    members.push_back(member);
  });
}

}  // namespace sightline::pvs
