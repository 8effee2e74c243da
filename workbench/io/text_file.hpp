// Text files, over the readers' and writers' own functions.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace sightline::io {

/// Replaces the file's content, all or nothing (io::write_file). Throws Error where it cannot be written.
void write_file(const std::filesystem::path& path, std::string_view content);

/// The file's content. Throws Error where it cannot be read or holds more than `limit` bytes.
std::string read_file(const std::filesystem::path& path, std::size_t limit);

}  // namespace sightline::io
