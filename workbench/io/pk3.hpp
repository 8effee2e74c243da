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

/// A file out of an archive.
struct NamedText {
  std::string name;  ///< in lower case
  std::string text;
};

/// The shader scripts ("scripts/NAME.shader") of an archive, in its order; at most 64 MiB of them. Throws
/// Error as unpack_entry does.
std::vector<NamedText> unpack_scripts(const std::filesystem::path& archive);
std::vector<NamedText> unpack_scripts(Bytes archive, const std::string& archive_name);

/// The texts of all shader scripts that a game with this folder has, what counts first at the front: of the
/// archives
/// (.pk3) the last by name, then loose files in "scripts". Of scripts of one name only the first is there.
/// Archives that cannot be read are left out and named in `unread`.
std::vector<std::string> gather_scripts(const std::filesystem::path& folder,
                                        std::vector<std::string>& unread);

}  // namespace sightline::io
