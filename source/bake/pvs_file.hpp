// The file of baked potentially visible sets: a header, and all cells' sets as Roaring bitmaps in one zstd
// frame. Little-endian:
//
//   8  "SightPVS"     4  version (1)      4  objects          8  fingerprint of the scene
//   12 cells x, y, z  24 bounds           8  bytes unpacked   8  bytes packed    8  checksum (FNV-1a) of all
//   else
//
// then the packed bytes; unpacked: for each cell 4 bytes of length, 0 for a closed cell, and a Roaring bitmap
// in its portable form.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <sightline/cell_pvs.hpp>
#include <sightline/error.hpp>

namespace sightline::bake {

/// A set of ids, ascending, as a Roaring bitmap in its portable form, run-length coded where that is shorter.
std::vector<std::byte> pack_set(std::span<const std::uint32_t> ids);
/// Reads one, and checks everything: ids ascending and below `objects`, nothing left over. Throws Error;
/// `what` names the set.
void unpack_set(std::span<const std::byte> bytes, std::uint32_t objects, const std::string& what,
                std::vector<std::uint32_t>& ids);

std::uint64_t checksum(std::span<const std::byte> bytes, std::uint64_t seed = 0xcbf29ce484222325u) noexcept;

/// The same bytes for the same sets.
std::vector<std::byte> pack_cells(const CellPvs& cells);
/// Throws Error, one sentence, for what is damaged, truncated, of another version, or no such file at all.
/// `name` is the file's. Allocates no more than cells and objects of a sound header allow.
CellPvs unpack_cells(std::span<const std::byte> bytes, const std::string& name);

/// All or nothing.
void write_pvs(const CellPvs& cells, const std::filesystem::path& file);
CellPvs read_pvs(const std::filesystem::path& file);

/// Throws Error unless the sets were baked for this very scene.
void check_belongs(const CellPvs& cells, const std::string& file, const Scene& scene);

}  // namespace sightline::bake
