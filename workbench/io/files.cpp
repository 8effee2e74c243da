#include "workbench/io/files.hpp"

#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <system_error>

#include <unistd.h>

#include <fmt/format.h>

#include <sightline/workbench/error.hpp>

#include "workbench/io/unfinished.hpp"

namespace sightline::io {

namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

std::string reason(int error) {
  return std::generic_category().message(error);
}

void write_pieces(File file, const std::filesystem::path& named,
                  std::span<const std::span<const std::byte>> pieces) {
  const auto fail = [&] {
    const std::string why = reason(errno);
    throw Error(name_asked_for(named).string() + ": cannot be written: " + why);
  };
  if (!file) fail();
  for (const std::span<const std::byte> piece : pieces) {
    if (!piece.empty() && std::fwrite(piece.data(), 1, piece.size(), file.get()) != piece.size()) fail();
  }
  // A full disk may only be noticed when the last buffer goes out.
  if (std::fflush(file.get()) != 0) fail();
  if (std::fclose(file.release()) != 0) fail();
}

// What a path stands for once links are followed: a file that took a link's place would part it from what it
// names. Of an open file of this process, as /dev/stdout and /dev/fd/1 name one, its number.
struct Target {
  std::filesystem::path path;
  int open = -1;
};

Target target_of(const std::filesystem::path& named) {
  constexpr int kMostLinks = 40;
  const std::filesystem::path opened = fmt::format("/proc/{}/fd", ::getpid());
  std::filesystem::path path = named;
  std::error_code none;
  for (int links = 0; links < kMostLinks && std::filesystem::is_symlink(path, none); ++links) {
    const std::filesystem::path folder = std::filesystem::weakly_canonical(path.parent_path(), none);
    const std::string name = path.filename().string();
    if (int number = 0;
        folder == opened &&
        std::from_chars(name.data(), name.data() + name.size(), number).ptr == name.data() + name.size())
      return {path, number};
    path = path.parent_path() / std::filesystem::read_symlink(path, none);  // an absolute one as it is
  }
  if (std::filesystem::is_symlink(path, none))
    throw Error(named.string() + ": cannot be written: " + reason(ELOOP));
  return {path};
}

}  // namespace

void expect_file(const std::filesystem::path& path, const char* kind) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::none || error == std::errc::too_many_symbolic_link_levels)
    throw Error(path.string() + ": cannot be read: " + error.message());
  if (!std::filesystem::exists(status)) throw Error(path.string() + ": no such file");
  if (!std::filesystem::is_regular_file(status))
    throw Error(path.string() + ": not a regular file, expected " + kind);
}

std::vector<std::byte> read_file(const std::filesystem::path& path) {
  expect_file(path);
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw Error(path.string() + ": cannot be read: " + error.message());
  if (size > std::uintmax_t{1} << 32)
    throw Error(path.string() + ": larger than 4 GiB, expected a smaller file");
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) throw Error(path.string() + ": cannot be read: " + reason(errno));
  std::vector<std::byte> bytes(size);
  if (size != 0 && std::fread(bytes.data(), 1, size, file.get()) != size) {
    throw Error(path.string() +
                ": cannot be read to its end: " + reason(std::ferror(file.get()) != 0 ? errno : EIO));
  }
  return bytes;
}

void write_file(const std::filesystem::path& path, std::span<const std::span<const std::byte>> pieces) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    throw Error(path.string() + ": is a folder, expected a file to write");
  const Target to = target_of(path);
  if (to.open >= 0) {
    std::fflush(stdout);  // which goes first, if it is that
    const int same = ::dup(to.open);
    return write_pieces(File(same < 0 ? nullptr : ::fdopen(same, "wb")), path, pieces);
  }
  const bool device =
      std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored);
  if (device) return write_pieces(File(std::fopen(path.c_str(), "wb")), path, pieces);
  // A short name: with some letters more, one as long as a name may be could not be made.
  static std::atomic<unsigned> count = 0;
  const Unfinished temporary(to.path.parent_path() / fmt::format("sightline-{}-{}.tmp", ::getpid(), count++),
                             path);
  write_pieces(File(std::fopen(temporary.path().c_str(), "wbx")), path, pieces);
  std::error_code failed;
  std::filesystem::rename(temporary.path(), to.path, failed);
  if (failed) throw Error(name_asked_for(path).string() + ": cannot be written: " + failed.message());
}

}  // namespace sightline::io
