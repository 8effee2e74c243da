#include "library/pvs/set_coding.hpp"

#include <roaring/roaring.h>

#include <cstdlib>
#include <memory>

#include "library/pvs/byte_reader.hpp"

namespace sightline::pvs {

namespace {

constexpr std::uint32_t kNoRuns = 12346, kRuns = 12347;
constexpr std::uint32_t kArrayMost = 4096, kFewWithRuns = 4;
constexpr std::size_t kBits = 8192;  // bytes of a container of bits

// Read here and not by the library: its reader does not check what lies within the containers.
class SetReader {
public:
  SetReader(Bytes bytes, std::uint32_t limit, Complaint (*visit)(void*, std::uint32_t), void* context)
      : bytes_(bytes), limit_(limit), visit_(visit), context_(context) {}

  Complaint read() {
    if (const Complaint bad = read_head()) return bad;
    for (std::size_t c = 0; c < count_; ++c) {
      const std::uint32_t high = std::uint32_t{read_at<std::uint16_t>(bytes_, keys_ + c * 4)} << 16;
      const std::uint32_t members = std::uint32_t{read_at<std::uint16_t>(bytes_, keys_ + c * 4 + 2)} + 1;
      const bool is_run = run_flags_ > 0 && bit(run_flags_, c);
      const Complaint bad = is_run                  ? read_runs(high)
                            : members <= kArrayMost ? read_array(high, members)
                                                    : read_bits(high);
      if (bad) return bad;
    }
    return at_ == bytes_.size() ? nullptr : "pvs: a bitmap is longer than its containers";
  }

private:
  static constexpr Complaint kCutOff = "pvs: a bitmap ends within a container";

  Complaint read_head() {
    if (bytes_.size() < 4) return "pvs: it ends within its header";
    const auto cookie = read_at<std::uint32_t>(bytes_, 0);
    at_ = 4;
    if ((cookie & 0xffff) == kRuns) {
      count_ = (cookie >> 16) + 1;
      run_flags_ = at_;
      at_ += (count_ + 7) / 8;
    } else if (cookie == kNoRuns) {
      if (bytes_.size() < 8) return "pvs: it ends within its header";
      count_ = read_at<std::uint32_t>(bytes_, 4);
      at_ = 8;
    } else {
      return "pvs: a set is no bitmap";
    }
    if (count_ > 65536 || !fits(at_, count_ * 4, bytes_.size()))
      return "pvs: a bitmap names more containers than it holds";
    keys_ = at_;
    at_ += count_ * 4;
    // Offsets, which follow from the sizes.
    if (run_flags_ == 0 || count_ >= kFewWithRuns) at_ += count_ * 4;
    return nullptr;
  }

  Complaint read_runs(std::uint32_t high) {
    if (!fits(at_, 2, bytes_.size())) return kCutOff;
    const std::uint32_t runs = read_at<std::uint16_t>(bytes_, at_);
    at_ += 2;
    if (!fits(at_, std::uint64_t{runs} * 4, bytes_.size())) return kCutOff;
    for (std::uint32_t r = 0; r < runs; ++r, at_ += 4) {
      const std::uint32_t start = read_at<std::uint16_t>(bytes_, at_),
                          length = read_at<std::uint16_t>(bytes_, at_ + 2);
      if (start + length > 0xffff) return "pvs: a bitmap has a run beyond its container";
      for (std::uint32_t i = 0; i <= length; ++i) {
        if (const Complaint bad = add(high | (start + i))) return bad;
      }
    }
    return nullptr;
  }

  Complaint read_array(std::uint32_t high, std::uint32_t members) {
    if (!fits(at_, std::uint64_t{members} * 2, bytes_.size())) return kCutOff;
    for (std::uint32_t i = 0; i < members; ++i, at_ += 2) {
      if (const Complaint bad = add(high | read_at<std::uint16_t>(bytes_, at_))) return bad;
    }
    return nullptr;
  }

  Complaint read_bits(std::uint32_t high) {
    if (!fits(at_, kBits, bytes_.size())) return kCutOff;
    for (std::uint32_t i = 0; i < 8 * kBits; ++i) {
      if (!bit(at_, i)) continue;
      if (const Complaint bad = add(high | i)) return bad;
    }
    at_ += kBits;
    return nullptr;
  }

  [[nodiscard]] bool bit(std::size_t at, std::size_t i) const {
    return (static_cast<unsigned>(bytes_[at + i / 8]) >> (i % 8) & 1u) != 0;
  }

  Complaint add(std::uint32_t member) {
    if (static_cast<std::int64_t>(member) <= last_ || member >= limit_) {
      return "pvs: a set holds numbers out of order or out of range";
    }
    last_ = member;
    return visit_(context_, member);
  }

  Bytes bytes_;
  std::uint32_t limit_;
  Complaint (*visit_)(void*, std::uint32_t);
  void* context_;
  std::size_t at_ = 0, count_ = 0, keys_ = 0;
  std::size_t run_flags_ = 0;  // where they begin, 0 where there are none
  std::int64_t last_ = -1;
};

}  // namespace

std::vector<std::byte> pack_set(std::span<const std::uint32_t> members, Runs runs) {
  const std::unique_ptr<roaring_bitmap_t, decltype(&roaring_bitmap_free)> bitmap(
      roaring_bitmap_of_ptr(members.size(), members.data()), roaring_bitmap_free);
  if (!bitmap) std::abort();  // out of memory
  if (runs == Runs::coded) roaring_bitmap_run_optimize(bitmap.get());
  std::vector<std::byte> bytes(roaring_bitmap_portable_size_in_bytes(bitmap.get()));
  roaring_bitmap_portable_serialize(bitmap.get(), reinterpret_cast<char*>(bytes.data()));
  return bytes;
}

Complaint walk_set(Bytes bytes, std::uint32_t limit, Complaint (*visit)(void*, std::uint32_t),
                   void* context) {
  return SetReader(bytes, limit, visit, context).read();
}

Complaint unpack_set(Bytes bytes, std::uint32_t limit, std::vector<std::uint32_t>& members) {
  return walk_set(bytes, limit, [&](std::uint32_t member) -> Complaint {
    if (members.size() >= kMostMembers) return kTooManyMembers;
    members.push_back(member);
    return nullptr;
  });
}

}  // namespace sightline::pvs
