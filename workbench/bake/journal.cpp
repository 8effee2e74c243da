#include "workbench/bake/journal.hpp"

#include <array>
#include <cstring>
#include <fstream>

#include <sightline/workbench/error.hpp>

#include "library/pvs/checksum.hpp"
#include "workbench/io/byte_reader.hpp"
#include "workbench/io/files.hpp"

namespace sightline::bake {

namespace {

// cell, length, checksum of both and the set
constexpr std::size_t kRecord = 16, kKey = 8;

std::uint64_t record_checksum(std::uint32_t cell, std::span<const std::byte> set) {
  const std::uint32_t head[] = {cell, static_cast<std::uint32_t>(set.size())};
  return pvs::checksum(set, pvs::checksum(std::as_bytes(std::span(head))));
}

}  // namespace

bool is_journal(const std::filesystem::path& file, std::uint64_t key) {
  std::error_code failed;
  if (std::filesystem::symlink_status(file, failed).type() != std::filesystem::file_type::regular)
    return false;
  // A kill may have cut it off within the key.
  std::array<char, kKey> head{};
  std::ifstream in(file, std::ios::binary);
  in.read(head.data(), head.size());
  return std::memcmp(head.data(), &key, static_cast<std::size_t>(in.gcount())) == 0;
}

std::uint64_t read_journal(const std::filesystem::path& file, std::uint64_t key, std::size_t cell_count,
                           PackedCells& done) {
  if (!is_journal(file, key)) return 0;
  const std::vector<std::byte> bytes = io::read_file(file);
  if (bytes.size() < kKey) return 0;
  std::size_t at = kKey;
  while (io::fits(at, kRecord, bytes.size())) {
    const auto cell = io::read_at<std::uint32_t>(bytes, at),
               length = io::read_at<std::uint32_t>(bytes, at + 4);
    const auto sum = io::read_at<std::uint64_t>(bytes, at + 8);
    if (cell >= cell_count || !io::fits(at + kRecord, length, bytes.size())) break;
    const auto set = std::span(bytes).subspan(at + kRecord, length);
    if (record_checksum(cell, set) != sum) break;
    done[cell].assign(set.begin(), set.end());
    at += kRecord + length;
  }
  return at;
}

Journal::Journal(const std::filesystem::path& file, std::uint64_t key, std::uint64_t whole) : path_(file) {
  std::error_code failed;
  if (std::filesystem::symlink_status(file, failed).type() != std::filesystem::file_type::not_found &&
      !is_journal(file, key))
    throw Error(
        file.string() +
        ": is not this bake's, expected a bake of the same scene with the same options to go on with, "
        "or none: remove it, or choose another name for the result");
  if (whole > 0) std::filesystem::resize_file(file, whole, failed);
  file_.reset(std::fopen(file.c_str(), whole > 0 && !failed ? "ab" : "wb"));
  if (!file_) throw Error(file.string() + ": cannot be written");
  if (whole == 0 || failed) std::fwrite(&key, 1, sizeof key, file_.get());
}

void Journal::add(std::uint32_t cell, const std::vector<std::byte>& set) {
  const std::uint32_t head[] = {cell, static_cast<std::uint32_t>(set.size())};
  const std::uint64_t sum = record_checksum(cell, set);
  std::FILE* out = file_.get();
  const bool written =
      std::fwrite(head, sizeof head, 1, out) == 1 && std::fwrite(&sum, sizeof sum, 1, out) == 1 &&
      (set.empty() || std::fwrite(set.data(), set.size(), 1, out) == 1) && std::fflush(out) == 0;
  if (!written) throw Error(path_.string() + ": cannot be written, is the disk full?");
}

}  // namespace sightline::bake
