#include "workbench/io/text_file.hpp"

#include <array>
#include <span>
#include <system_error>

#include <sightline/workbench/error.hpp>

#include "workbench/io/files.hpp"

namespace sightline::io {

void write_file(const std::filesystem::path& path, std::string_view content) {
  const std::array pieces{std::as_bytes(std::span(content))};
  io::write_file(path, pieces);
}

std::string read_file(const std::filesystem::path& path, std::size_t limit) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error && size > limit) {
    throw Error(path.string() + ": is larger than the " + std::to_string(limit) + " bytes expected at most");
  }
  const std::vector<std::byte> bytes = io::read_file(path);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace sightline::io
