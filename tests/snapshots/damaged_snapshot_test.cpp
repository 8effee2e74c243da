// Bytes that nobody vouches for: refused, or without their damaged sectors, and never more harm than that.
#include <sightline/snapshot.hpp>

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>

#include "support/random_views.hpp"
#include "support/snapshots.hpp"

namespace sightline {
namespace {

using scene::Random;
using test::FileBytes;

constexpr Box kGround{{-6000, -60, -6000}, {6000, 60, 6000}};

// All columns, ids that are free, and chains of chunks in one point.
World make_world() {
  Random random(3);
  World world;
  std::vector<Box> boxes;
  for (int i = 0; i < 4000; ++i) {
    boxes.push_back(test::random_box(random, kGround));
    if (i % 20 == 0) boxes.back() = {{300, 1, 300}, {300, 1, 300}};
  }
  std::vector<Handle> handles(boxes.size());
  EXPECT_TRUE(world.insert(BoxView(boxes), handles));
  std::vector<std::uint32_t> numbers(boxes.size(), 5);
  EXPECT_TRUE(world.set_layers(handles, numbers));
  EXPECT_TRUE(world.set_values(handles, numbers));
  EXPECT_TRUE(world.set_distances(handles, std::vector<DistanceRange>(boxes.size())));
  const LevelTableId table = *world.add_levels(std::vector<float>{100, 10});
  EXPECT_TRUE(world.set_levels(handles, std::vector<LevelTableId>(boxes.size(), table)));
  EXPECT_TRUE(world.remove(std::span<const Handle>(handles).first(100)));
  return world;
}

// Sees everything.
CullView overview() {
  Camera camera{.eye = {0, 20'000, 0}, .forward = {0, -1, 0}, .up = {0, 0, 1}};
  camera.orthographic_height = 20'000, camera.near_plane = 0.1f, camera.far_plane = 40'000;
  return {.view = {*make_view(camera, 500, 500), {}}};
}

// Returns where it begins.
std::size_t damage(FileBytes& bytes, Random& random, std::uint32_t kind) {
  const auto at = random.below(static_cast<std::uint32_t>(bytes.size()));
  const std::size_t some = std::min<std::size_t>(bytes.size() - at, 1 + random.below(64));
  if (kind == 0) {
    bytes[at] ^= static_cast<std::byte>(1u << random.below(8));
  } else if (kind == 1) {
    bytes.resize(at);
  } else if (kind == 2) {
    for (std::size_t i = 0; i < some; ++i) bytes[at + i] = static_cast<std::byte>(random.next());
  } else if (kind == 3) {
    std::fill_n(bytes.begin() + at, some, std::byte{random.below(2) ? std::uint8_t{0} : std::uint8_t{255}});
  } else {
    bytes.erase(bytes.begin() + at, bytes.begin() + at + static_cast<std::ptrdiff_t>(some));
  }
  return at;
}

// Brings in what comes, and does with it what anybody might.
void use(WorldStream& stream, World& world, Random& random) {
  const CullView view = overview();
  const auto report = stream.bring_in({&view, 1});
  ASSERT_TRUE(report) << report.error().message();
  EXPECT_EQ(report->in + report->damaged, stream.size());
  std::vector<Handle> handles;
  for (std::size_t i = 0; i < world.id_limit(); ++i)
    if (const Handle h = world.handle(static_cast<ObjectId>(i)); world.contains(h)) handles.push_back(h);
  EXPECT_EQ(handles.size(), world.size());
  EXPECT_LE(test::seen(world, {&view, 1}).size(), world.size());
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < handles.size(); ++i) boxes.push_back(test::random_box(random, kGround));
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(world.move(handles, BoxView(boxes)));
  ASSERT_TRUE(world.remove(std::span<const Handle>(handles).first(handles.size() / 2)));
  (void)test::seen(world, {&view, 1});
}

TEST(DamagedSnapshot, IsRefusedOrLeavesItsDamagedSectorsOut) {
  const World world = make_world();
  const FileBytes sound = test::saved(world);
  const CullView view = overview();
  Random random(11);
  int refused = 0, parted = 0;
  for (std::uint32_t i = 0; i < 300; ++i) {
    SCOPED_TRACE(i);
    FileBytes bytes = sound;
    const std::size_t at = damage(bytes, random, i % 5);
    if (bytes == sound) continue;
    EXPECT_EQ(load(bytes).error().code(), StatusCode::bad_file);
    World streamed;
    auto stream = WorldStream::open(bytes, streamed);
    if (!stream) {
      ++refused;
      EXPECT_EQ(stream.error().code(), StatusCode::bad_file);
      EXPECT_GT(std::string(stream.error().message()).size(), 20u);
      EXPECT_LE(stream.error().index(), bytes.size());
      continue;
    }
    ++parted;
    const auto report = stream->bring_in({&view, 1});
    ASSERT_TRUE(report);
    EXPECT_GE(report->damaged, 1u);
    EXPECT_EQ(report->missing, 0u);
    bool named = false;
    std::size_t objects = 0;
    for (std::size_t s = 0; s < stream->size(); ++s) {
      const StreamSector sector = stream->sector(s);
      EXPECT_EQ(sector.state == SectorState::damaged, !sector.error);
      if (sector.state == SectorState::in) objects += sector.objects;
      if (sector.error) continue;
      EXPECT_EQ(sector.error.code(), StatusCode::bad_file);
      EXPECT_EQ(sector.error.index(), sector.first_byte);
      named = named ||
              (sector.first_byte <= at && (s + 1 == stream->size() || at < stream->sector(s + 1).first_byte));
    }
    EXPECT_TRUE(named) << "the sector that was hit is not among those named";
    EXPECT_EQ(streamed.size(), objects);
    test::expect_sound(streamed);
    for (const auto& [id, mask, level] : test::seen(streamed, {&view, 1}))
      EXPECT_EQ(streamed.box(streamed.handle(id)), world.box(world.handle(id)));
  }
  EXPECT_GT(refused, 60);
  EXPECT_GT(parted, 60);
}

TEST(DamagedSnapshot, WithRightChecksumsDoesNoHarmEither) {
  const FileBytes sound = test::saved(make_world());
  Random random(12);
  int opened = 0;
  for (std::uint32_t i = 0; i < 300; ++i) {
    SCOPED_TRACE(i);
    FileBytes bytes = sound;
    for (std::uint32_t k = 1 + random.below(3); k > 0 && !bytes.empty(); --k) damage(bytes, random, i % 5);
    test::forge_checksums(bytes);
    World world;
    auto stream = WorldStream::open(bytes, world);
    if (!stream) continue;
    ++opened;
    use(*stream, world, random);
  }
  EXPECT_GT(opened, 100);
}

// Every word of the directory, with all numbers that are likely to do harm.
TEST(DamagedSnapshot, NoCountOfTheDirectoryIsBelieved) {
  const FileBytes sound = test::saved(make_world());
  const std::size_t first = test::tail_of(sound).directory;
  Random random(13);
  for (std::size_t at = first; at + 4 <= sound.size(); at += at < first + 400 ? 4 : 124) {
    for (const std::uint32_t value : {0u, 1u, 0x7fffffffu, 0x80000000u, 0xffffffffu}) {
      FileBytes bytes = sound;
      std::memcpy(bytes.data() + at, &value, sizeof value);
      test::forge_checksums(bytes);
      World world;
      if (auto stream = WorldStream::open(bytes, world)) use(*stream, world, random);
      if (HasFatalFailure()) return;
    }
  }
}

// Two objects, each in a sector of its own.
struct TwoSectors {
  TwoSectors() {
    const std::vector<WorldBox> boxes{{{0, 0, 0}, {1, 1, 1}}, {{9000, 0, 0}, {9001, 1, 1}}};
    World world;
    EXPECT_TRUE(world.insert(boxes, handles));
    bytes = test::saved(world);
  }
  std::array<Handle, 2> handles;
  FileBytes bytes;
};

// Neither could leave again, for each would count as changed by the other.
TEST(DamagedSnapshot, TwoSectorsAtOnePlaceAreRefused) {
  FileBytes bytes = TwoSectors().bytes;
  const std::size_t first = test::tail_of(bytes).directory, second = first + sizeof(world::SectorEntry);
  std::memcpy(bytes.data() + second, bytes.data() + first, sizeof world::SectorEntry::cell);
  test::forge_checksums(bytes);
  const auto loaded = load(bytes);
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().code(), StatusCode::bad_file);
  EXPECT_EQ(loaded.error().index(), second);
}

TEST(DamagedSnapshot, AnIdThatStandsTwiceLeavesTheSecondSectorOut) {
  auto [handles, bytes] = TwoSectors();
  // A group, a chunk, the end of its chain, a box; then the id.
  const std::size_t id = sizeof(world::SnapshotHead) + 4 * (3 + 6), length = 4 * (3 + 8);
  std::memcpy(bytes.data() + id + length, bytes.data() + id, 4);
  test::forge_checksums(bytes);
  World streamed;
  auto stream = WorldStream::open(bytes, streamed);
  ASSERT_TRUE(stream) << stream.error().message();
  const CullView view = overview();
  const auto report = stream->bring_in({&view, 1}, {.ahead = 0});
  ASSERT_TRUE(report);
  EXPECT_EQ(report->damaged, 1u);
  EXPECT_EQ(streamed.size(), 1u);
  EXPECT_TRUE(streamed.contains(handles[0]));
  EXPECT_FALSE(streamed.contains(handles[1]));
}

}  // namespace
}  // namespace sightline
