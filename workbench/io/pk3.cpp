#include "workbench/io/pk3.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <numeric>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <zip.h>

#include <sightline/workbench/io.hpp>

#include "workbench/io/files.hpp"
#include "workbench/io/text_file.hpp"

namespace sightline {

namespace io {

struct DiscardZip {
  void operator()(zip_t* archive) const { zip_discard(archive); }
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};
using Archive = std::unique_ptr<zip_t, DiscardZip>;

namespace {

constexpr std::uint64_t kMaxEntrySize = std::uint64_t{256} << 20;
// Deflate cannot do better than 1032 : 1.
constexpr std::uint64_t kMaxRatio = 1032;

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

/// What the archive says of an entry that can be unpacked.
zip_stat_t expect_entry(zip_t* archive, const std::string& name, const std::string& entry) {
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
  return stat;
}

std::vector<std::byte> unpack(zip_t* archive, const std::string& name, const zip_stat_t& stat) {
  const std::unique_ptr<zip_file_t, DiscardZip> file(zip_fopen_index(archive, stat.index, 0));
  if (!file) throw Error(fmt::format("{}: cannot be unpacked: {}", name, zip_strerror(archive)));
  // What an archive says may be a lie: memory is touched as bytes come.
  constexpr std::size_t kStep = std::size_t{1} << 20;
  std::vector<std::byte> bytes;
  bytes.reserve(stat.size);
  std::size_t got = 0;
  while (got < stat.size) {
    bytes.resize(std::min<std::size_t>(stat.size, got + kStep));
    const zip_int64_t n = zip_fread(file.get(), bytes.data() + got, bytes.size() - got);
    if (n < 0) throw Error(fmt::format("{}: cannot be unpacked: {}", name, zip_file_strerror(file.get())));
    if (n == 0) throw Error(fmt::format("{}: ends after {} bytes, expected {}", name, got, stat.size));
    got += static_cast<std::size_t>(n);
  }
  // Reading on finds both a longer stream and a wrong checksum.
  std::byte more;
  const zip_int64_t n = zip_fread(file.get(), &more, 1);
  if (n < 0) throw Error(fmt::format("{}: cannot be unpacked: {}", name, zip_file_strerror(file.get())));
  if (n > 0) throw Error(fmt::format("{}: unpacks to more than the {} bytes it says", name, bytes.size()));
  return bytes;
}

std::vector<std::byte> unpack(zip_t* archive, const std::string& archive_name, const std::string& entry) {
  const std::string name = archive_name + ":" + entry;
  return unpack(archive, name, expect_entry(archive, name, entry));
}

}  // namespace

namespace {

Archive open_archive(const std::filesystem::path& path) {
  expect_file(path, "a zip archive");
  int code = 0;
  Archive archive(zip_open(path.c_str(), ZIP_RDONLY, &code));
  if (!archive) throw Error(path.string() + ": not a readable zip archive: " + zip_reason(code));
  return archive;
}

Archive open_archive(Bytes bytes, const std::string& archive_name) {
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
  return archive;
}

std::string lowered(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

/// "scripts/NAME.shader", in lower case; not in a folder below.
bool is_script(std::string_view name) noexcept {
  constexpr std::string_view kFolder = "scripts/";
  return name.starts_with(kFolder) && name.ends_with(".shader") &&
         name.find('/', kFolder.size()) == std::string_view::npos;
}

/// Files of the folder that end so, the first by name first; none where there is no such folder.
std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder, std::string_view ending) {
  std::vector<std::filesystem::path> out;
  std::error_code error;
  for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    if (lowered(at->path().extension().string()) == ending) out.push_back(at->path());
  }
  std::ranges::sort(out, {},
                    [](const std::filesystem::path& path) { return lowered(path.filename().string()); });
  return out;
}

}  // namespace

std::vector<std::byte> unpack_entry(const std::filesystem::path& path, const std::string& entry) {
  return unpack(open_archive(path).get(), path.string(), entry);
}

std::vector<std::byte> unpack_entry(Bytes bytes, const std::string& archive_name, const std::string& entry) {
  return unpack(open_archive(bytes, archive_name).get(), archive_name, entry);
}

struct GameFiles::Source {
  Source(Archive opened, std::string called) : archive(std::move(opened)), name(std::move(called)) {
    constexpr zip_int64_t kMostEntries = zip_int64_t{1} << 20;
    for (zip_int64_t i = 0; i < std::min(zip_get_num_entries(archive.get(), 0), kMostEntries); ++i) {
      const char* entry = zip_get_name(archive.get(), static_cast<zip_uint64_t>(i), ZIP_FL_ENC_RAW);
      if (entry == nullptr || !entries.try_emplace(lowered(entry), entry).second) continue;
      if (is_script(lowered(entry))) scripts.push_back(lowered(entry));
    }
  }

  Archive archive;
  std::string name;
  std::map<std::string, std::string, std::less<>> entries;  ///< by their names in lower case
  std::vector<std::string> scripts;                         ///< in the archive's order
};

GameFiles::GameFiles(const std::filesystem::path& folder)
    : loose_scripts_(files_in(folder / "scripts", ".shader")) {
  std::vector<std::filesystem::path> archives = files_in(folder, ".pk3");
  std::ranges::reverse(archives);
  for (const std::filesystem::path& path : archives) {
    try {
      sources_.push_back(std::make_unique<Source>(open_archive(path), path.string()));
    } catch (const Error& error) {
      left_out_.push_back(std::string(error.what()) + "; it is left out");
    }
  }
}

GameFiles::GameFiles(Bytes archive, const std::string& archive_name) {
  sources_.push_back(std::make_unique<Source>(open_archive(archive, archive_name), archive_name));
}

GameFiles::~GameFiles() = default;

std::vector<std::byte> GameFiles::unpack(const std::string& name, Share& share) {
  for (const std::unique_ptr<Source>& source : sources_) {
    const auto found = source->entries.find(name);
    if (found == source->entries.end()) continue;
    const std::string called = source->name + ":" + found->second;
    const zip_stat_t stat = expect_entry(source->archive.get(), called, found->second);
    // Many entries may share a few packed bytes, and what turns out broken was work too.
    if (stat.size > share.left) throw Error(fmt::format("{}: brings all {}", called, share.over));
    share.left -= stat.size;
    return io::unpack(source->archive.get(), called, stat);
  }
  return {};
}

std::vector<std::byte> GameFiles::read(std::string_view name) {
  return unpack(lowered(std::string(name)), files_);
}

std::vector<std::string> GameFiles::scripts() {
  Share share{std::uint64_t{64} << 20, "shader scripts over 64 MiB"};
  std::vector<std::string> texts;
  std::set<std::string> known;
  const auto take = [&](const std::string& name, const auto& load) {
    if (!known.insert(name).second) return;
    try {
      texts.push_back(load());
    } catch (const Error& error) {
      left_out_.push_back(std::string(error.what()) + "; it is left out");
    }
  };
  for (const std::unique_ptr<Source>& source : sources_) {
    for (const std::string& script : source->scripts) {
      take(script, [&] {
        const std::vector<std::byte> bytes = unpack(script, share);
        return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
      });
    }
  }
  for (const std::filesystem::path& path : loose_scripts_) {
    take("scripts/" + lowered(path.filename().string()), [&] {
      std::string text = read_file(path, share.left);
      share.left -= text.size();
      return text;
    });
  }
  return texts;
}

/// A level with what else of the game it needs.
Scene read_level(Bytes level, const std::string& name, GameFiles& files, const LoadOptions& options) {
  LoadOptions of_game = options;
  for (std::string& script : files.scripts()) of_game.shader_scripts.push_back(std::move(script));
  if (!of_game.game_file) of_game.game_file = [&](const std::string& file) { return files.read(file); };
  Scene scene = read_bsp(level, name, of_game);
  scene.ignored.insert(scene.ignored.end(), files.left_out().begin(), files.left_out().end());
  return scene;
}

}  // namespace io

Scene read_pk3(std::span<const std::byte> archive, std::string_view entry, std::string name,
               const LoadOptions& options) {
  const std::string path(entry);
  io::GameFiles files(archive, name);
  return io::read_level(io::unpack_entry(archive, name, path), name + ":" + path, files, options);
}

}  // namespace sightline
