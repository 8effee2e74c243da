// What a bake has finished so far, cell by cell, appended to as it goes: a killed bake reads it and goes on.
// A tail that the kill cut off is dropped.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include <sightline/pvs.hpp>

namespace sightline::bake {

/// A finished cell: its packed set (pack_set), or nothing for a closed cell.
using PackedCells = std::map<std::uint32_t, std::vector<std::byte>>;

/// Whether the file is a journal of the bake that has this key, no link to one: or the beginning of one.
bool is_journal(const std::filesystem::path& file, std::uint64_t key);

/// Reads whole records into `done` (cells below `cell_count` only); a missing file, or one of another bake
/// (`key`), has none. Returns the length of what is whole.
std::uint64_t read_journal(const std::filesystem::path& file, std::uint64_t key, std::size_t cell_count,
                           PackedCells& done);

class Journal {
public:
  /// Opens for appending after the whole records; starts anew where there are none. Throws Error where it
  /// cannot, or where something else stands there.
  Journal(const std::filesystem::path& file, std::uint64_t key, std::uint64_t whole);
  /// Appends and hands the bytes to the system. Throws Error where the disk is full.
  void add(std::uint32_t cell, const std::vector<std::byte>& set);

private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace sightline::bake
