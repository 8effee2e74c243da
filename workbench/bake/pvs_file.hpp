// Files of baked potentially visible sets, whose bytes the library reads and writes (<sightline/pvs.hpp>).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <sightline/pvs.hpp>
#include <sightline/workbench/error.hpp>
#include <sightline/workbench/scene.hpp>

namespace sightline::bake {

/// All or nothing. Throws Error.
void write_pvs_file(const CellPvs& cells, const std::filesystem::path& file);
/// Throws Error, one sentence, for what read_pvs refuses.
CellPvs read_pvs_file(const std::filesystem::path& file);

/// What the library says of visible sets, about a file or a cell by name.
std::string sentence_about(const std::string& what, std::string_view sentence);

/// Throws Error unless the sets were baked for this very scene.
void check_belongs(const CellPvs& cells, const std::string& file, const Scene& scene);

}  // namespace sightline::bake
