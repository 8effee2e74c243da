#include "library/pvs/cell_coding.hpp"

#include <algorithm>
#include <bit>
#include <functional>
#include <iterator>
#include <limits>
#include <numeric>

#include "library/pvs/byte_reader.hpp"
#include "library/pvs/set_coding.hpp"

namespace sightline::pvs {

namespace {

constexpr std::uint64_t kBlock = std::uint64_t{1} << 24;  // bits to a bitmap
constexpr std::uint8_t kClosed = 0, kOpen = 1;

using Numbers = std::vector<std::uint32_t>;

// The cell before this one along x (1), y (2) or z (3).
std::uint32_t neighbour(const CellPvs& cells, std::uint32_t cell, std::uint8_t axis) {
  const std::uint32_t x = cells.counts[0], y = cells.counts[1];
  if (axis == 1) return cell % x > 0 ? cell - 1 : kNoCell;
  if (axis == 2) return cell / x % y > 0 ? cell - x : kNoCell;
  return cell >= x * y ? cell - x * y : kNoCell;
}

void put(std::vector<std::byte>& out, std::uint32_t value) {
  const auto bytes = std::as_bytes(std::span(&value, 1));
  out.insert(out.end(), bytes.begin(), bytes.end());
}

std::uint64_t stride_of(std::uint64_t columns) {
  return (columns + 7) / 8 * 8;
}
std::uint64_t rows_a_block(std::uint64_t stride) {
  return std::max<std::uint64_t>(1, kBlock / std::max<std::uint64_t>(1, stride));
}

// Rows after one another: `members_of` gives a row's columns, ascending, good until it is called again.
void put_rows(std::vector<std::byte>& out, std::size_t rows, std::size_t columns,
              const std::function<std::span<const std::uint32_t>(std::size_t)>& members_of) {
  const std::uint64_t stride = stride_of(columns), a_block = rows_a_block(stride);
  Numbers bits;
  for (std::size_t first = 0; first < rows; first += a_block) {
    bits.clear();
    for (std::size_t row = first; row < std::min<std::size_t>(rows, first + a_block); ++row) {
      const auto start = static_cast<std::uint32_t>((row - first) * stride);
      for (const std::uint32_t column : members_of(row)) bits.push_back(start + column);
    }
    const std::vector<std::byte> set = pack_set(bits, Runs::plain);
    put(out, static_cast<std::uint32_t>(set.size()));
    out.insert(out.end(), set.begin(), set.end());
  }
}

// Row r's columns are members[first[r]] … members[first[r + 1]).
struct Rows {
  std::vector<std::uint64_t> first{0};
  Numbers members;

  [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t row) const {
    return std::span(members).subspan(first[row], first[row + 1] - first[row]);
  }
};

// Reads what put_rows wrote, to the end of the bytes.
Complaint read_rows(Bytes bytes, std::size_t at, std::size_t rows, std::size_t columns, Rows& out) {
  const std::uint64_t stride = stride_of(columns), a_block = rows_a_block(stride);
  for (std::uint64_t first = 0; first < rows; first += a_block) {
    if (!fits(at, 4, bytes.size())) return "pvs: it ends before its last cell";
    const std::size_t length = read_at<std::uint32_t>(bytes, at);
    at += 4;
    if (!fits(at, length, bytes.size())) return "pvs: a bitmap ends beyond the file";
    const std::uint64_t here = std::min<std::uint64_t>(a_block, rows - first);
    auto take = [&](std::uint32_t bit) -> Complaint {
      const std::uint64_t row = first + bit / stride, column = bit % stride;
      if (column >= columns) return "pvs: a set holds numbers out of range";
      if (out.members.size() >= kMostMembers) return kTooManyMembers;
      while (out.first.size() <= row) out.first.push_back(out.members.size());
      out.members.push_back(static_cast<std::uint32_t>(column));
      return nullptr;
    };
    const Bytes bitmap = bytes.subspan(at, length);
    if (const Complaint bad = walk_set(bitmap, static_cast<std::uint32_t>(here * stride), take)) return bad;
    at += length;
  }
  if (at != bytes.size()) return "pvs: it goes on after its last cell";
  out.first.resize(rows + 1, out.members.size());
  return nullptr;
}

Numbers open_cells(const CellPvs& cells) {
  Numbers open;
  for (std::uint32_t cell = 0; cell < cells.size(); ++cell) {
    if (cells.open[cell]) open.push_back(cell);
  }
  return open;
}

// For each object the open cells, counted, that it is seen from.
Rows seen_from_where(const CellPvs& cells, const Numbers& open) {
  Rows rows;
  rows.first.assign(std::size_t{cells.objects} + 1, 0);
  for (const std::uint32_t object : cells.visible) ++rows.first[object + 1];
  std::partial_sum(rows.first.begin(), rows.first.end(), rows.first.begin());
  rows.members.resize(cells.visible.size());
  std::vector<std::uint64_t> next(rows.first.begin(), rows.first.end() - 1);
  for (std::uint32_t i = 0; i < open.size(); ++i) {
    for (const std::uint32_t object : cells.seen_from(open[i])) rows.members[next[object]++] = i;
  }
  return rows;
}

Numbers inverse(std::span<const std::uint32_t> order) {
  Numbers place(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) place[order[i]] = i;
  return place;
}

// All but the rows.
struct Head {
  Layout layout{};
  bool ordered = false;
  Bytes cells;             // a byte each
  Numbers order;           // which object stands at each place, where they are ordered
  std::size_t length = 0;  // of the head itself
};

// Which object stands at each place.
Complaint read_order(Bytes planes, std::size_t objects, Numbers& order) {
  order.assign(objects, 0);
  for (std::size_t i = 0; i < 4 * objects; ++i) {
    order[i % objects] |= static_cast<std::uint32_t>(planes[i]) << (8 * (i / objects));
  }
  std::vector<std::uint8_t> stands(objects, 0);
  for (const std::uint32_t object : order) {
    if (object >= objects || stands[object]) return "pvs: its objects stand in no order";
    stands[object] = 1;
  }
  return nullptr;
}

Complaint read_head(Bytes bytes, std::size_t count, std::size_t objects, Head& head) {
  if (!fits(2, count, bytes.size())) return "pvs: it ends before its last cell";
  head.layout = static_cast<Layout>(bytes[0]);
  head.ordered = bytes[1] == std::byte{1};
  if (head.layout > Layout::by_object || (!head.ordered && bytes[1] != std::byte{0})) {
    return "pvs: its layout is unknown";
  }
  head.cells = bytes.subspan(2, count);
  head.length = 2 + count;
  for (const std::byte cell : head.cells) {
    const bool plain = cell <= std::byte{kOpen};
    if (cell > std::byte{kOpen + 3} || (!plain && head.layout != Layout::by_difference)) {
      return "pvs: a cell is neither open nor closed";
    }
  }
  if (!head.ordered) return nullptr;
  if (!fits(head.length, std::uint64_t{4} * objects, bytes.size())) {
    return "pvs: it ends within the order of its objects";
  }
  const Bytes planes = bytes.subspan(head.length, 4 * objects);
  head.length += 4 * objects;
  return read_order(planes, objects, head.order);
}

Complaint decode_by_object(Bytes bytes, const Head& head, const Numbers& open, CellPvs& cells) {
  // An order takes four bytes an object, so that there are as many objects as bytes account for.
  if (!head.ordered) return "pvs: its objects stand in no order";
  Rows seen;
  if (const Complaint bad = read_rows(bytes, head.length, cells.objects, open.size(), seen)) return bad;
  for (const std::uint32_t i : seen.members) ++cells.first[open[i] + 1];
  std::partial_sum(cells.first.begin(), cells.first.end(), cells.first.begin());
  cells.visible.resize(seen.members.size());
  std::vector<std::uint64_t> next(cells.first.begin(), cells.first.end() - 1);
  const Numbers place = inverse(head.order);
  for (std::uint32_t object = 0; object < cells.objects; ++object) {
    for (const std::uint32_t i : seen[place[object]]) cells.visible[next[open[i]]++] = object;
  }
  return nullptr;
}

// Appends what a cell sees, given how it differs from the cell that it is like. False where there is none.
bool append_cell(CellPvs& cells, std::uint32_t cell, std::uint8_t like, const Numbers& difference) {
  if (like == 0) {
    cells.visible.insert(cells.visible.end(), difference.begin(), difference.end());
    return true;
  }
  const std::uint32_t other = neighbour(cells, cell, like);
  if (other == kNoCell || !cells.open[other]) return false;
  const auto known = cells.seen_from(other);
  const Numbers seen(known.begin(), known.end());
  std::ranges::set_symmetric_difference(seen, difference, std::back_inserter(cells.visible));
  return true;
}

Status damaged(Complaint why) {
  return {StatusCode::bad_file, why};
}

Status decode_by_cell(Bytes bytes, const Head& head, const Numbers& open, CellPvs& cells) {
  Rows rows;
  if (const Complaint bad = read_rows(bytes, head.length, open.size(), cells.objects, rows))
    return damaged(bad);
  Numbers difference;
  std::size_t row = 0;
  for (std::uint32_t cell = 0; cell < cells.size(); ++cell) {
    if (cells.open[cell]) {
      const auto columns = rows[row++];
      difference.assign(columns.begin(), columns.end());
      if (head.ordered) {
        for (std::uint32_t& object : difference) object = head.order[object];
        std::ranges::sort(difference);
      }
      const auto like = static_cast<std::uint8_t>(static_cast<std::uint8_t>(head.cells[cell]) - kOpen);
      if (!append_cell(cells, cell, like, difference)) {
        return {StatusCode::bad_file, "pvs: a cell is like one that is not there", cell};
      }
      if (cells.visible.size() > kMostMembers) return damaged(kTooManyMembers);
    }
    cells.first[cell + 1] = cells.visible.size();
  }
  return {};
}

}  // namespace

std::vector<std::uint32_t> object_order(const CellPvs& cells) {
  const Numbers open = open_cells(cells);
  const std::size_t count = cells.objects, words = (open.size() + 63) / 64;
  constexpr double kMostWork = 2e9;  // words compared
  if (0.5 * static_cast<double>(count) * static_cast<double>(count) * static_cast<double>(words) >
      kMostWork) {
    return {};
  }
  const Rows seen = seen_from_where(cells, open);
  std::vector<std::uint64_t> bits(count * words);
  for (std::size_t object = 0; object < count; ++object) {
    for (const std::uint32_t cell : seen[object]) {
      bits[object * words + cell / 64] |= std::uint64_t{1} << (cell % 64);
    }
  }
  // From each object to the one most like it of those that are left.
  Numbers left(count), order;
  std::iota(left.begin(), left.end(), 0u);
  for (std::size_t best = 0; !left.empty();) {
    order.push_back(left[best]);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
    const std::uint64_t* here = bits.data() + order.back() * words;
    std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
    for (std::size_t i = 0; i < left.size(); ++i) {
      const std::uint64_t* there = bits.data() + left[i] * words;
      std::uint64_t differ = 0;
      for (std::size_t w = 0; w < words; ++w) {
        differ += static_cast<std::uint64_t>(std::popcount(here[w] ^ there[w]));
      }
      if (differ < least) least = differ, best = i;
    }
  }
  return order;
}

std::vector<std::byte> code_cells(const CellPvs& cells, Layout layout, std::span<const std::uint32_t> order) {
  std::vector<std::byte> out{static_cast<std::byte>(layout), static_cast<std::byte>(!order.empty())};
  const Numbers open = open_cells(cells);
  const std::size_t heads = out.size();
  for (const std::uint8_t is_open : cells.open) out.push_back(std::byte{is_open ? kOpen : kClosed});
  for (int plane = 0; plane < 4 && !order.empty(); ++plane) {
    for (const std::uint32_t object : order) out.push_back(static_cast<std::byte>(object >> (8 * plane)));
  }
  if (layout == Layout::by_object) {
    const Rows seen = seen_from_where(cells, open);
    put_rows(out, cells.objects, open.size(), [&](std::size_t place) { return seen[order[place]]; });
    return out;
  }
  const Numbers place = inverse(order);
  Numbers least, difference;
  std::vector<std::uint8_t> like(open.size(), 0);
  put_rows(out, open.size(), cells.objects, [&](std::size_t row) -> std::span<const std::uint32_t> {
    const auto seen = cells.seen_from(open[row]);
    least.assign(seen.begin(), seen.end());
    for (std::uint8_t axis = 1; axis <= 3 && layout == Layout::by_difference; ++axis) {
      const std::uint32_t other = neighbour(cells, open[row], axis);
      if (other == kNoCell || !cells.open[other]) continue;
      difference.clear();
      std::ranges::set_symmetric_difference(seen, cells.seen_from(other), std::back_inserter(difference));
      if (difference.size() < least.size()) least.swap(difference), like[row] = axis;
    }
    if (!order.empty()) {
      for (std::uint32_t& object : least) object = place[object];
      std::ranges::sort(least);
    }
    return least;
  });
  for (std::size_t row = 0; row < open.size(); ++row) {
    out[heads + open[row]] = static_cast<std::byte>(kOpen + like[row]);
  }
  return out;
}

Status decode_cells(Bytes bytes, CellPvs& cells) {
  const std::size_t count = std::size_t{cells.counts[0]} * cells.counts[1] * cells.counts[2];
  Head head;
  if (const Complaint bad = read_head(bytes, count, cells.objects, head)) return damaged(bad);
  for (const std::byte cell : head.cells) cells.open.push_back(cell != std::byte{kClosed});
  const Numbers open = open_cells(cells);
  cells.first.assign(count + 1, 0);
  if (head.layout != Layout::by_object) return decode_by_cell(bytes, head, open, cells);
  if (const Complaint bad = decode_by_object(bytes, head, open, cells)) return damaged(bad);
  return {};
}

}  // namespace sightline::pvs
