// The file of baked potentially visible sets: a header, and all cells' sets (cell_coding.hpp) in one zstd
// frame. Little-endian:
//
//   8  "SightPVS"     4  version (2)      4  objects          8  fingerprint of the scene
//   12 cells x, y, z  24 bounds           8  bytes unpacked   8  bytes packed    8  checksum (FNV-1a) of all
//   else
//
// then the packed bytes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <sightline/pvs.hpp>
#include <sightline/workbench/error.hpp>
#include <sightline/workbench/scene.hpp>

namespace sightline::pvs {

std::uint64_t checksum(std::span<const std::byte> bytes, std::uint64_t seed = 0xcbf29ce484222325u) noexcept;

/// The same bytes for the same sets, in whichever layout is shortest. Throws Error where they are larger
/// than unpack_cells would read.
std::vector<std::byte> pack_cells(const CellPvs& cells);
/// Throws Error, one sentence, for what is damaged, truncated, of another version, or no such file at all.
/// `name` is the file's. Allocates no more than cells and objects of a sound header allow.
CellPvs unpack_cells(std::span<const std::byte> bytes, const std::string& name);

/// All or nothing.
void write_pvs(const CellPvs& cells, const std::filesystem::path& file);
CellPvs read_pvs(const std::filesystem::path& file);

/// Throws Error unless the sets were baked for this very scene.
void check_belongs(const CellPvs& cells, const std::string& file, const Scene& scene);

}  // namespace sightline::pvs
