// Archives made in memory, whole, broken and malicious.
#include <cstring>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sightline/workbench/io.hpp>

#include "sample_files.hpp"
#include "workbench/io/pk3.hpp"

namespace sightline {
namespace {

using namespace samples;
using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kEntry = "maps/sample.bsp";

std::string refusal_of_archive(const Blob& archive, const std::string& entry = kEntry) {
  return error_of([&] { read_pk3(archive, entry, "sample.pk3"); });
}

/// Overwrites a 32-bit field of the local header and of the central directory of the one entry.
void set_in_headers(Blob& archive, std::size_t local_offset, std::size_t central_offset,
                    std::uint32_t value) {
  for (std::size_t i = 0; i + 4 < archive.size(); ++i) {
    if (std::memcmp(&archive[i], "PK\x03\x04", 4) == 0) std::memcpy(&archive[i + local_offset], &value, 4);
    if (std::memcmp(&archive[i], "PK\x01\x02", 4) == 0) std::memcpy(&archive[i + central_offset], &value, 4);
  }
}

TEST(Pk3, UnpacksALevel) {
  const Blob level = to_bsp(two_rooms());
  const Blob archive = to_pk3(kEntry, level);
  EXPECT_EQ(io::unpack_entry(archive, "sample.pk3", kEntry), level);
  const Scene scene = read_pk3(archive, kEntry, "sample.pk3");
  EXPECT_EQ(scene.size(), 6u);
  EXPECT_EQ(scene.name, "sample.pk3:maps/sample.bsp");
}

TEST(Pk3, MissingEntryNamesTheNearest) {
  const Blob archive = to_pk3(kEntry, to_bsp(two_rooms()));
  EXPECT_THAT(refusal_of_archive(archive, "maps/simple.bsp"),
              AllOf(HasSubstr("sample.pk3:maps/simple.bsp"), HasSubstr("maps/sample.bsp")));
  EXPECT_THAT(refusal_of_archive(archive, "maps/sample.map"), HasSubstr("nothing that ends in '.map'"));
  EXPECT_NE(refusal_of_archive(archive, ""), "");
  EXPECT_NE(refusal_of_archive(archive, std::string(1 << 20, 'x')), "");
}

TEST(Pk3, WhatIsNoArchiveIsRefused) {
  EXPECT_THAT(refusal_of_archive({}), HasSubstr("not a readable zip archive"));
  EXPECT_THAT(refusal_of_archive(to_bytes(std::string("this is no archive"))),
              HasSubstr("not a readable zip archive"));
}

TEST(Pk3Hostile, BombsAreRefused) {
  // A megabyte of zeros deflates to a kilobyte; the archive then lies about what it unpacks to.
  const Blob zeros(1 << 20);
  Blob archive = to_pk3(kEntry, zeros);
  set_in_headers(archive, 22, 24, 0xfffffff0);
  EXPECT_THAT(refusal_of_archive(archive), HasSubstr("expected at most"));
  archive = to_pk3(kEntry, zeros);
  set_in_headers(archive, 22, 24, 200 << 20);
  EXPECT_THAT(refusal_of_archive(archive), HasSubstr("which deflate cannot do"));
  archive = to_pk3(kEntry, zeros);
  set_in_headers(archive, 22, 24, 100);
  EXPECT_NE(refusal_of_archive(archive), "");
  archive = to_pk3(kEntry, zeros);
  set_in_headers(archive, 22, 24, (1 << 20) + 1);
  EXPECT_NE(refusal_of_archive(archive), "");
}

/// An archive of so many entries that each say they unpack to `claimed` bytes, and end long before.
Blob claims(const std::string& start, const std::string& ending, std::size_t entries, std::uint32_t claimed) {
  std::mt19937 random(1);
  Blob noise(claimed / 1000);
  for (std::byte& byte : noise) byte = std::byte(random() & 0xff);
  std::vector<std::pair<std::string, Blob>> files;
  for (std::size_t i = 0; i < entries; ++i) files.emplace_back(start + std::to_string(i) + ending, noise);
  Blob archive = to_pk3(files);
  set_in_headers(archive, 22, 24, claimed);
  return archive;
}

// One packed stream may stand behind thousands of names.
TEST(Pk3Hostile, ScriptsAreUnpackedUpToALimitOfThemAll) {
  Blob archive = claims("scripts/", ".shader", 1, (64 << 20) + 1);
  io::GameFiles large(archive, "a.pk3");
  EXPECT_TRUE(large.scripts().empty());
  ASSERT_EQ(large.left_out().size(), 1u);
  EXPECT_EQ(large.left_out()[0],
            "a.pk3:scripts/0.shader: brings all shader scripts over 64 MiB; it is left out");
  archive = claims("scripts/", ".shader", 4, 20 << 20);
  io::GameFiles many(archive, "a.pk3");
  EXPECT_TRUE(many.scripts().empty());
  ASSERT_EQ(many.left_out().size(), 4u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_THAT(many.left_out()[i], HasSubstr("ends after")) << i;
  EXPECT_THAT(many.left_out()[3], HasSubstr("scripts/3.shader: brings all shader scripts over 64 MiB"));
}

TEST(Pk3Hostile, FilesOfTheGameAreUnpackedUpToALimitOfThemAll) {
  const Blob archive = claims("textures/", ".tga", 9, 60 << 20);
  io::GameFiles files(archive, "a.pk3");
  for (std::size_t i = 0; i < 9; ++i) {
    const std::string said = error_of([&] { (void)files.read("textures/" + std::to_string(i) + ".tga"); });
    EXPECT_THAT(said, HasSubstr(i < 8 ? "ends after" : "brings all files of the game over 512 MiB")) << i;
  }
}

TEST(Pk3Hostile, LargeLooseScriptsAreLeftOut) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "scripts");
  write(folder / "scripts/a.shader", {});
  std::filesystem::resize_file(folder / "scripts/a.shader", (64 << 20) + 1);
  io::GameFiles files(folder.path());
  EXPECT_TRUE(files.scripts().empty());
  ASSERT_EQ(files.left_out().size(), 1u);
  EXPECT_THAT(files.left_out()[0], HasSubstr("a.shader: is larger than the 67108864 bytes expected"));
}

TEST(Pk3Hostile, WrongChecksumIsRefused) {
  Blob archive = to_pk3(kEntry, to_bsp(two_rooms()));
  set_in_headers(archive, 14, 16, 0x12345678);
  EXPECT_THAT(refusal_of_archive(archive), HasSubstr("cannot be unpacked"));
}

TEST(Pk3Hostile, TruncatedOrChangedAnywhere) {
  const Blob whole = to_pk3(kEntry, to_bsp(two_rooms()));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    ASSERT_NE(refusal_of_archive({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}), "")
        << size;
  }
  std::mt19937 random(5);
  for (int round = 0; round < 5000; ++round) {
    Blob bytes = whole;
    bytes[random() % bytes.size()] = std::byte(random() & 0xff);
    const std::string said = refusal_of_archive(bytes);
    if (!said.empty()) {
      ASSERT_THAT(said, HasSubstr("sample.pk3"));
    }
  }
}

}  // namespace
}  // namespace sightline
