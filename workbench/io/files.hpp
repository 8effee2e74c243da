// Whole files: in, bounded; out, all or nothing.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace sightline::io {

/// Throws Error for a file that is missing, out of reach or not a regular one, which is `kind`.
void expect_file(const std::filesystem::path& path, const char* kind = "one");

/// The bytes of a regular file. Throws Error for a missing or unreadable one, a folder, or anything over 4
/// GiB.
std::vector<std::byte> read_file(const std::filesystem::path& path);

/// Writes the pieces one after the other under a temporary name beside `path`, then renames; where that fails
/// the temporary file is removed, `path` is as it was, and Error says why. A device is written to directly.
void write_file(const std::filesystem::path& path, std::span<const std::span<const std::byte>> pieces);

}  // namespace sightline::io
