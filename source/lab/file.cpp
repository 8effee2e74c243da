#include "lab/file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include <sightline/error.hpp>

namespace sightline::lab {
namespace {

std::string reason(int error) {
  return std::generic_category().message(error);
}

/// 0, or the errno of what failed.
int write_all(const std::filesystem::path& path, std::string_view content) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) return errno;
  int error = 0;
  if (std::fwrite(content.data(), 1, content.size(), file) != content.size()) error = errno;
  if (std::fflush(file) != 0 && error == 0) error = errno;
  if (std::fclose(file) != 0 && error == 0) error = errno;
  return error;
}

}  // namespace

void write_file(const std::filesystem::path& path, std::string_view content) {
  const auto refuse = [&](int error) {
    throw Error(path.string() + ": could not be written: " + reason(error));
  };
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  if (std::filesystem::is_directory(status))
    throw Error(path.string() + ": is a directory, expected a file name");
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    if (const int error = write_all(path, content)) refuse(error);
    return;
  }
  std::filesystem::path temporary = path;
  temporary += ".partial-" + std::to_string(getpid());
  if (const int error = write_all(temporary, content)) {
    std::filesystem::remove(temporary, ignored);
    refuse(error);
  }
  std::error_code failed;
  std::filesystem::rename(temporary, path, failed);
  if (failed) {
    std::filesystem::remove(temporary, ignored);
    throw Error(path.string() + ": could not be written: " + failed.message());
  }
}

std::string read_file(const std::filesystem::path& path, std::size_t limit) {
  std::error_code failed;
  if (std::filesystem::is_directory(path, failed)) {
    throw Error(path.string() + ": is a directory, expected a file");
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) throw Error(path.string() + ": could not be read: " + reason(errno));
  std::string content;
  char block[65536];
  while (const std::size_t count = std::fread(block, 1, sizeof block, file.get())) {
    content.append(block, count);
    if (content.size() > limit) {
      throw Error(path.string() + ": is larger than the " + std::to_string(limit) +
                  " bytes expected at most");
    }
  }
  if (std::ferror(file.get()) != 0) throw Error(path.string() + ": could not be read: " + reason(errno));
  return content;
}

}  // namespace sightline::lab
