#include "bake/pvs_file.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <fstream>

#include <sightline/worlds.hpp>

#include "scene/random.hpp"
#include "support/temporary_folder.hpp"

namespace sightline::bake {
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
  try {
    (void)unpack_cells(bytes, "a.pvs");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(PvsFile, GivesBackWhatWasWritten) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const CellPvs cells = random_cells(seed), back = unpack_cells(pack_cells(cells), "a.pvs");
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
  EXPECT_THAT(refusal(older), HasSubstr("version 0, expected 1"));
  EXPECT_THAT(refusal({std::byte{'P'}, std::byte{'K'}}), HasSubstr("no file of baked visibility"));
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
    try {
      unpack_set(bad, 3000, "set", ids);
      ASSERT_TRUE(std::is_sorted(ids.begin(), ids.end()));
      ASSERT_TRUE(ids.empty() || ids.back() < 3000);
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000u);
}

TEST(PvsFile, OfAnotherSceneIsRefused) {
  const Scene a = *generate_world("soup?triangles=200&seed=1"),
              b = *generate_world("soup?triangles=200&seed=2");
  CellPvs cells;
  cells.objects = static_cast<std::uint32_t>(a.size());
  cells.scene = fingerprint(a);
  EXPECT_NO_THROW(check_belongs(cells, "a.pvs", a));
  EXPECT_THROW(check_belongs(cells, "a.pvs", b), Error);
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
}  // namespace sightline::bake
