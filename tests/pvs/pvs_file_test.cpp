#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

#include <sightline/pvs.hpp>

#include "library/pvs/cell_coding.hpp"
#include "library/pvs/set_coding.hpp"
#include "workbench/scene/random.hpp"

namespace sightline::pvs {
namespace {

using testing::HasSubstr;

CellPvs random_cells(std::uint64_t seed, std::uint32_t objects = 70000) {
  scene::Random random(seed);
  CellPvs cells;
  cells.bounds = {{-10, 0, -10}, {10, 5, 10}};
  cells.counts = {4, 2, 3};
  cells.objects = objects;
  cells.scene = 77;
  cells.first.push_back(0);
  for (int c = 0; c < 24; ++c) {
    cells.open.push_back(c % 5 != 0);
    if (cells.open.back()) {
      const std::uint32_t kind = random.below(4);
      for (std::uint32_t o = 0; o < objects; ++o) {
        const bool in = kind == 0   ? random.below(1000) == 0  // few
                        : kind == 1 ? random.below(2) == 0     // half
                        : kind == 2 ? o / 5000 % 2 == 0        // runs
                                    : false;                   // none
        if (in) cells.visible.push_back(o);
      }
    }
    cells.first.push_back(cells.visible.size());
  }
  return cells;
}

std::string refusal(const std::vector<std::byte>& bytes) {
  const Result<CellPvs> read = read_pvs(bytes);
  return read ? "" : read.error().message();
}

std::vector<std::byte> pack_cells(const CellPvs& cells) {
  return *write_pvs(cells);
}
CellPvs unpack_cells(const std::vector<std::byte>& bytes) {
  return *read_pvs(bytes);
}

TEST(PvsFile, GivesBackWhatWasWritten) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const CellPvs cells = random_cells(seed), back = unpack_cells(pack_cells(cells));
    EXPECT_EQ(back.visible, cells.visible);
    EXPECT_EQ(back.first, cells.first);
    EXPECT_EQ(back.open, cells.open);
    EXPECT_EQ(back.counts, cells.counts);
    EXPECT_EQ(back.bounds, cells.bounds);
    EXPECT_EQ(back.objects, cells.objects);
    EXPECT_EQ(back.scene, cells.scene);
    EXPECT_EQ(pack_cells(cells), pack_cells(back));
  }
}

TEST(PvsFile, IsRefusedWhereverItIsCutOff) {
  const std::vector<std::byte> whole = pack_cells(random_cells(4, 500));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    ASSERT_FALSE(refusal({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}).empty()) << size;
  }
  std::vector<std::byte> longer = whole;
  longer.push_back({});
  EXPECT_THAT(refusal(longer), HasSubstr("goes on after its end"));
}

TEST(PvsFile, IsRefusedWithAnyBitTurned) {
  const std::vector<std::byte> whole = pack_cells(random_cells(5, 300));
  for (std::size_t bit = 0; bit < whole.size() * 8; ++bit) {
    std::vector<std::byte> damaged = whole;
    damaged[bit / 8] ^= std::byte{1} << (bit % 8);
    ASSERT_FALSE(refusal(damaged).empty()) << bit;
  }
}

TEST(PvsFile, SaysWhatIsWrong) {
  std::vector<std::byte> bytes = pack_cells(random_cells(6));
  EXPECT_THAT(refusal({bytes.begin(), bytes.end() - 1}), HasSubstr("truncated"));
  std::vector<std::byte> damaged = bytes;
  damaged.back() ^= std::byte{1};
  EXPECT_THAT(refusal(damaged), HasSubstr("damaged"));
  std::vector<std::byte> older = bytes;
  older[8] = std::byte{0};
  EXPECT_THAT(refusal(older), HasSubstr("another version than 2"));
  EXPECT_THAT(refusal({std::byte{'P'}, std::byte{'K'}}), HasSubstr("no file of baked visibility"));
  CellPvs many = random_cells(6);
  many.objects = 1u << 31;
  EXPECT_THAT(write_pvs(many).error().message(), HasSubstr("at most 1073741824"));
}

// Damage that whoever made it hid by a right checksum.
TEST(PvsFile, IsRefusedWithHostileSetsToo) {
  scene::Random random(7);
  const CellPvs cells = random_cells(8, 3000);
  const std::vector<std::byte> set = pack_set(cells.seen_from(1));
  std::size_t refused = 0;
  for (int i = 0; i < 20000; ++i) {
    std::vector<std::byte> bad = set;
    for (std::uint32_t n = 1 + random.below(3); n > 0; --n) {
      bad[random.below(static_cast<std::uint32_t>(bad.size()))] = static_cast<std::byte>(random.below(256));
    }
    if (random.below(3) == 0) bad.resize(random.below(static_cast<std::uint32_t>(bad.size())));
    std::vector<std::uint32_t> ids;
    if (unpack_set(bad, 3000, ids)) {
      ++refused;
      continue;
    }
    ASSERT_TRUE(std::is_sorted(ids.begin(), ids.end()));
    ASSERT_TRUE(ids.empty() || ids.back() < 3000);
  }
  EXPECT_GT(refused, 1000u);
}

void expect_same_sets(const CellPvs& found, const CellPvs& expected) {
  EXPECT_EQ(found.visible, expected.visible);
  EXPECT_EQ(found.first, expected.first);
  EXPECT_EQ(found.open, expected.open);
}

CellPvs without_sets(const CellPvs& cells) {
  CellPvs bare;
  bare.bounds = cells.bounds, bare.counts = cells.counts, bare.objects = cells.objects;
  return bare;
}

TEST(CellCoding, GivesBackTheSetsInEveryLayout) {
  for (const std::uint32_t objects : {1u, 7u, 300u, 3000u}) {
    const CellPvs cells = random_cells(20 + objects, objects);
    const std::vector<std::uint32_t> order = object_order(cells);
    ASSERT_EQ(order.size(), objects);
    for (const Layout layout : kLayouts) {
      for (const bool ordered : {true, false}) {
        if (!ordered && layout == Layout::by_object) continue;
        CellPvs back = without_sets(cells);
        const auto some = ordered ? std::span(order) : std::span(order).first(0);
        ASSERT_TRUE(decode_cells(code_cells(cells, layout, some), back));
        expect_same_sets(back, cells);
      }
    }
  }
  CellPvs closed = random_cells(1, 40);
  std::ranges::fill(closed.open, std::uint8_t{0}), std::ranges::fill(closed.first, 0u);
  closed.visible.clear();
  expect_same_sets(unpack_cells(pack_cells(closed)), closed);
}

// More rows than one bitmap holds.
TEST(CellCoding, GivesBackManyCells) {
  scene::Random random(40);
  CellPvs cells;
  cells.bounds = {{0, 0, 0}, {1, 1, 1}};
  cells.counts = {300, 1, 300}, cells.objects = 400;
  cells.first.push_back(0);
  for (std::uint32_t cell = 0; cell < 90000; ++cell) {
    cells.open.push_back(random.below(10) != 0);
    for (std::uint32_t o = random.below(200); cells.open.back() && o < 400; o += 1 + random.below(200)) {
      cells.visible.push_back(o);
    }
    cells.first.push_back(cells.visible.size());
  }
  expect_same_sets(unpack_cells(pack_cells(cells)), cells);
}

TEST(CellCoding, HoldsOnlySoundSetsWhateverTheBytes) {
  scene::Random random(41);
  const CellPvs cells = random_cells(42, 300);
  const std::vector<std::uint32_t> order = object_order(cells);
  std::size_t refused = 0, read = 0;
  for (const Layout layout : kLayouts) {
    const std::vector<std::byte> whole = code_cells(cells, layout, order);
    for (int i = 0; i < 5000; ++i) {
      std::vector<std::byte> bad = whole;
      for (std::uint32_t n = 1 + random.below(3); n > 0; --n) {
        bad[random.below(static_cast<std::uint32_t>(bad.size()))] = static_cast<std::byte>(random.below(256));
      }
      if (random.below(4) == 0) bad.resize(random.below(static_cast<std::uint32_t>(bad.size())));
      CellPvs back = without_sets(cells);
      if (!decode_cells(bad, back)) {
        ++refused;
        continue;
      }
      ++read;
      for (std::uint32_t cell = 0; cell < back.size(); ++cell) {
        const auto seen = back.seen_from(cell);
        ASSERT_TRUE(std::ranges::adjacent_find(seen, std::greater_equal<>()) == seen.end());
        ASSERT_TRUE(seen.empty() || seen.back() < 300);
      }
    }
  }
  EXPECT_GT(refused, 1000u);
  EXPECT_GT(read, 20u);
}

// What is seen changes little from cell to cell, and objects that stand together are seen together.
TEST(PvsFile, IsSmallWhereCellsAreAlike) {
  scene::Random random(43);
  CellPvs cells;
  cells.bounds = {{0, 0, 0}, {1, 1, 1}};
  cells.counts = {16, 2, 16}, cells.objects = 1000;
  cells.first.push_back(0);
  std::vector<Vec3> at;
  for (std::uint32_t o = 0; o < cells.objects; ++o) at.push_back(random.inside({{0, 0, 0}, {16, 0, 16}}));
  for (std::uint32_t cell = 0; cell < 512; ++cell) {
    cells.open.push_back(1);
    const auto x = static_cast<float>(cell % 16), z = static_cast<float>(cell / 32);
    for (std::uint32_t o = 0; o < cells.objects; ++o) {
      if (std::hypot(at[o].x - x, at[o].z - z) < 4) cells.visible.push_back(o);
    }
    cells.first.push_back(cells.visible.size());
  }
  EXPECT_LT(pack_cells(cells).size(), 512u * 1000 / 8 / 4);
}

TEST(PvsFile, IsNotWrittenOfCellsThatAreNotSound) {
  const CellPvs whole = random_cells(11, 300);
  const std::function<void(CellPvs&)> harms[] = {[](CellPvs& c) { c.counts[0] = 0; },
                                                 [](CellPvs& c) { c.open.pop_back(); },
                                                 [](CellPvs& c) { c.first.back() += 1; },
                                                 [](CellPvs& c) { c.visible.back() = c.objects; },
                                                 [](CellPvs& c) { c.visible.push_back(1); },
                                                 [](CellPvs& c) { std::ranges::reverse(c.visible); },
                                                 [](CellPvs& c) { c.objects = 0; },
                                                 [](CellPvs& c) { std::ranges::fill(c.open, std::uint8_t{0}); },
                                                 [](CellPvs& c) { c.first.clear(); }};
  for (const auto& harm : harms) {
    CellPvs cells = whole;
    harm(cells);
    EXPECT_FALSE(write_pvs(cells)) << &harm - harms;
  }
}

TEST(CellPvs, FindsTheCellOfAPoint) {
  const CellPvs cells = random_cells(9);
  scene::Random random(10);
  std::size_t open = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = random.inside({{-11, -1, -11}, {11, 6, 11}});
    const std::uint32_t cell = cells.cell_at(p);
    if (cell == kNoCell) continue;
    ++open;
    const Box box = cells.cell_bounds(cell);
    constexpr float kSlack = 1e-5f;
    EXPECT_TRUE(p.x >= box.min.x - kSlack && p.x <= box.max.x + kSlack && p.y >= box.min.y - kSlack &&
                p.y <= box.max.y + kSlack && p.z >= box.min.z - kSlack && p.z <= box.max.z + kSlack);
    EXPECT_TRUE(cells.open[cell]);
  }
  EXPECT_GT(open, 500u);
  EXPECT_EQ(cells.cell_at({11, 0, 0}), kNoCell);
}

}  // namespace
}  // namespace sightline::pvs
