// Where a glTF file keeps its buffers: inside itself as base64, or in files beside it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

namespace sightline::io::gltf {

/// The bytes behind a URI: "data:…;base64,…", or a relative path to a file in `folder` or below. Throws Error
/// for other schemes, broken base64, and paths that lead out of the folder, by '..' or by a symbolic link.
std::vector<std::byte> load_uri(std::string_view uri, const std::filesystem::path& folder);

}  // namespace sightline::io::gltf
