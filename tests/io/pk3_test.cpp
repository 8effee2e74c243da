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
