// Whole files, written under a temporary name and renamed, so that no reader ever meets half of one.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace sightline::lab {

/// Replaces the file's content. A target that is no regular file (a pipe, a device) is written to directly.
/// Throws Error, and leaves no file and the old content, where it cannot be written to the end.
void write_file(const std::filesystem::path& path, std::string_view content);

/// The file's content. Throws Error where it cannot be read or holds more than `limit` bytes.
std::string read_file(const std::filesystem::path& path, std::size_t limit);

}  // namespace sightline::lab
