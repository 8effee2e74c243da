#include "workbench/io/files.hpp"

#include <atomic>
#include <cerrno>
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

void write_pieces(const std::filesystem::path& to, const std::filesystem::path& named, const char* mode,
                  std::span<const std::span<const std::byte>> pieces) {
  const auto fail = [&] { throw Error(named.string() + ": cannot be written: " + reason(errno)); };
  File file(std::fopen(to.c_str(), mode));
  if (!file) fail();
  for (const std::span<const std::byte> piece : pieces) {
    if (!piece.empty() && std::fwrite(piece.data(), 1, piece.size(), file.get()) != piece.size()) fail();
  }
  // A full disk may only be noticed when the last buffer goes out.
  if (std::fflush(file.get()) != 0) fail();
  if (std::fclose(file.release()) != 0) fail();
}

}  // namespace

std::vector<std::byte> read_file(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw Error(path.string() + ": no such file");
  if (!std::filesystem::is_regular_file(status))
    throw Error(path.string() + ": not a regular file, expected one");
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
  const bool device =
      std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored);
  if (device) return write_pieces(path, path, "wb", pieces);
  // A short name: with some letters more, one as long as a name may be could not be made.
  static std::atomic<unsigned> count = 0;
  const Unfinished temporary(path.parent_path() / fmt::format("sightline-{}-{}.tmp", ::getpid(), count++));
  write_pieces(temporary.path(), path, "wbx", pieces);
  std::error_code failed;
  std::filesystem::rename(temporary.path(), path, failed);
  if (failed) throw Error(path.string() + ": cannot be written: " + failed.message());
}

}  // namespace sightline::io
