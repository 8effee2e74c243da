// Quake 3 archives: zip files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "workbench/io/byte_reader.hpp"

namespace sightline::io {

/// One entry of an archive, unpacked. Throws Error if the archive or the entry is broken, packed by other
/// means than deflate, larger than 256 MiB, or unpacks to more or less than it says (a zip bomb). A missing
/// entry's error names the nearest ones.
std::vector<std::byte> unpack_entry(const std::filesystem::path& archive, const std::string& entry);
std::vector<std::byte> unpack_entry(Bytes archive, const std::string& archive_name, const std::string& entry);

}  // namespace sightline::io
