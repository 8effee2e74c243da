#include "workbench/io/pk3.hpp"

#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <zip.h>

#include <sightline/workbench/io.hpp>

namespace sightline {

namespace io {

namespace {

constexpr std::uint64_t kMaxEntrySize = std::uint64_t{256} << 20;
// Deflate cannot do better than 1032 : 1.
constexpr std::uint64_t kMaxRatio = 1032;

struct Discard {
  void operator()(zip_t* archive) const { zip_discard(archive); }
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};
using Archive = std::unique_ptr<zip_t, Discard>;

std::string zip_reason(int code) {
  zip_error_t error;
  zip_error_init_with_code(&error, code);
  std::string text = zip_error_strerror(&error);
  zip_error_fini(&error);
  return text;
}

/// Levenshtein's distance.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t above = row[j + 1];
      row[j + 1] = std::min({diagonal + (a[i] != b[j] ? 1u : 0u), above + 1, row[j] + 1});
      diagonal = above;
    }
  }
  return row[b.size()];
}

/// The names nearest to `entry`, among those that end alike.
std::string nearest(zip_t* archive, const std::string& entry) {
  constexpr zip_int64_t kMaxLooked = 65536;
  constexpr std::size_t kMaxName = 128, kShown = 3;
  const std::string ending = std::filesystem::path(entry).extension().string();
  std::vector<std::pair<std::size_t, std::string>> names;
  for (zip_int64_t i = 0; i < std::min(zip_get_num_entries(archive, 0), kMaxLooked); ++i) {
    const char* name = zip_get_name(archive, static_cast<zip_uint64_t>(i), ZIP_FL_ENC_RAW);
    if (name == nullptr || !std::string_view(name).ends_with(ending)) continue;
    if (std::string_view(name).size() > kMaxName || entry.size() > kMaxName) continue;
    names.emplace_back(distance(name, entry), name);
  }
  if (names.empty()) return fmt::format("it holds nothing that ends in '{}'", ending);
  std::sort(names.begin(), names.end());
  names.resize(std::min(names.size(), kShown));
  std::string list;
  for (const auto& [far, name] : names) list += (list.empty() ? "" : ", ") + name;
  return "the nearest are " + list;
}

std::vector<std::byte> unpack(zip_t* archive, const std::string& archive_name, const std::string& entry) {
  const std::string name = archive_name + ":" + entry;
  zip_stat_t stat;
  zip_stat_init(&stat);
  if (zip_stat(archive, entry.c_str(), 0, &stat) != 0) {
    throw Error(fmt::format("{}: the archive has no such entry; {}", name, nearest(archive, entry)));
  }
  constexpr zip_uint64_t kNeeded = ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE | ZIP_STAT_COMP_METHOD | ZIP_STAT_INDEX;
  if ((stat.valid & kNeeded) != kNeeded) throw Error(name + ": the archive does not say how large it is");
  if (stat.comp_method != ZIP_CM_STORE && stat.comp_method != ZIP_CM_DEFLATE) {
    throw Error(fmt::format("{}: packed by method {}, expected stored or deflated", name, stat.comp_method));
  }
  if (stat.size > kMaxEntrySize) {
    throw Error(
        fmt::format("{}: {} bytes when unpacked, expected at most {}", name, stat.size, kMaxEntrySize));
  }
  if (stat.size > (stat.comp_size + 1) * kMaxRatio) {
    throw Error(fmt::format("{}: says that {} bytes unpack to {}, which deflate cannot do", name,
                            stat.comp_size, stat.size));
  }
  const std::unique_ptr<zip_file_t, Discard> file(zip_fopen_index(archive, stat.index, 0));
  if (!file) throw Error(fmt::format("{}: cannot be unpacked: {}", name, zip_strerror(archive)));
  std::vector<std::byte> bytes(stat.size);
  std::size_t got = 0;
  while (got < bytes.size()) {
    const zip_int64_t n = zip_fread(file.get(), bytes.data() + got, bytes.size() - got);
    if (n < 0) throw Error(fmt::format("{}: cannot be unpacked: {}", name, zip_file_strerror(file.get())));
    if (n == 0) throw Error(fmt::format("{}: ends after {} bytes, expected {}", name, got, bytes.size()));
    got += static_cast<std::size_t>(n);
  }
  // Reading on finds both a longer stream and a wrong checksum.
  std::byte more;
  const zip_int64_t n = zip_fread(file.get(), &more, 1);
  if (n < 0) throw Error(fmt::format("{}: cannot be unpacked: {}", name, zip_file_strerror(file.get())));
  if (n > 0) throw Error(fmt::format("{}: unpacks to more than the {} bytes it says", name, bytes.size()));
  return bytes;
}

}  // namespace

std::vector<std::byte> unpack_entry(const std::filesystem::path& path, const std::string& entry) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) throw Error(path.string() + ": no such file");
  if (!std::filesystem::is_regular_file(path, ignored))
    throw Error(path.string() + ": not a regular file, expected a zip archive");
  int code = 0;
  const Archive archive(zip_open(path.c_str(), ZIP_RDONLY, &code));
  if (!archive) throw Error(path.string() + ": not a readable zip archive: " + zip_reason(code));
  return unpack(archive.get(), path.string(), entry);
}

std::vector<std::byte> unpack_entry(Bytes bytes, const std::string& archive_name, const std::string& entry) {
  // libzip takes no bytes at all for an archive without entries.
  if (bytes.empty()) throw Error(archive_name + ": not a readable zip archive: it is empty");
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
  Archive archive(source != nullptr ? zip_open_from_source(source, ZIP_RDONLY, &error) : nullptr);
  if (!archive) {
    const std::string text = zip_error_strerror(&error);
    if (source != nullptr) zip_source_free(source);
    zip_error_fini(&error);
    throw Error(archive_name + ": not a readable zip archive: " + text);
  }
  return unpack(archive.get(), archive_name, entry);
}

}  // namespace io

Scene read_pk3(std::span<const std::byte> archive, std::string_view entry, std::string name,
               const LoadOptions& options) {
  const std::string path(entry);
  return read_bsp(io::unpack_entry(archive, name, path), name + ":" + path, options);
}

}  // namespace sightline
