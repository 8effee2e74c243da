// Where a glTF file keeps its buffers: inside itself as base64, or in files beside it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace sightline::io::gltf {

/// The bytes of "data:…;base64,…"; nothing for any other URI. Throws Error for broken base64.
std::optional<std::vector<std::byte>> decode_data_uri(std::string_view uri);

/// The file that a relative path to `folder` or below names, the same however it is spelt. Throws Error for
/// other schemes, and paths that lead out of the folder, by '..' or by a symbolic link.
std::filesystem::path find_uri(std::string_view uri, const std::filesystem::path& folder);

}  // namespace sightline::io::gltf
