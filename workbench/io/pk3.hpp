// Quake 3 archives: zip files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <sightline/workbench/io.hpp>

#include "workbench/io/byte_reader.hpp"

namespace sightline::io {

/// One entry of an archive, unpacked. Throws Error if the archive or the entry is broken, packed by other
/// means than deflate, larger than 256 MiB, or unpacks to more or less than it says (a zip bomb). A missing
/// entry's error names the nearest ones.
std::vector<std::byte> unpack_entry(const std::filesystem::path& archive, const std::string& entry);
std::vector<std::byte> unpack_entry(Bytes archive, const std::string& archive_name, const std::string& entry);

/// The files of a game as id Tech 3 finds them: of files of one name in several archives that of the last
/// archive by name, upper and lower case being one.
class GameFiles {
public:
  /// All archives (.pk3) of a folder, and its loose shader scripts, which come last. Archives that cannot be
  /// read are left out.
  explicit GameFiles(const std::filesystem::path& folder);
  /// One archive, which outlives this. Throws Error where it cannot be read.
  GameFiles(Bytes archive, const std::string& archive_name);
  ~GameFiles();
  GameFiles(const GameFiles&) = delete;
  GameFiles& operator=(const GameFiles&) = delete;

  /// The texts of all shader scripts, "scripts/NAME.shader", what counts first at the front; at most 64 MiB.
  std::vector<std::string> scripts();
  /// A file out of the archives; empty where there is none of the name. Throws Error for a broken one, and
  /// for one that brings all that were read over 512 MiB.
  std::vector<std::byte> read(std::string_view name);
  /// What was left out, a sentence each.
  [[nodiscard]] const std::vector<std::string>& left_out() const noexcept { return left_out_; }

private:
  struct Source;
  /// Bytes that may still be unpacked, and what one file more would bring all over.
  struct Share {
    std::uint64_t left;
    const char* over;
  };
  std::vector<std::byte> unpack(const std::string& name, Share& share);

  std::vector<std::unique_ptr<Source>> sources_;  ///< what counts first at the front
  std::vector<std::filesystem::path> loose_scripts_;
  std::vector<std::string> left_out_;
  Share files_{std::uint64_t{512} << 20, "files of the game over 512 MiB"};
};

/// A level with its shader scripts and images out of the game's files.
Scene read_level(Bytes level, const std::string& name, GameFiles& files, const LoadOptions& options);

}  // namespace sightline::io
