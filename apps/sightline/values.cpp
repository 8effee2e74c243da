// What options may say, and how a wrong one is refused.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>

#include <sightline/workbench/error.hpp>

#include "command.hpp"
#include "workbench/report/page_folder.hpp"

namespace sightline::app {

namespace fs = std::filesystem;

CLI::Validator whole(std::uint64_t low, std::uint64_t high) {
  // CLI11 takes 010 for eight, 0x10 for sixteen and -1 for the largest of all numbers.
  const auto read = [low, high](std::string& text) -> std::string {
    std::uint64_t value = 0;
    const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool good = end.ec == std::errc{} && end.ptr == text.data() + text.size();
    if (!good || value < low || value > high)
      return fmt::format("'{}': expected a whole number from {} to {}", text, low, high);
    text = std::to_string(value);
    return "";
  };
  return {read, high == kAnySeed ? "" : fmt::format("{} to {}", low, high)};
}

CLI::Validator number(double low, double high) {
  const auto refuse = [low, high](const std::string& text) -> std::string {
    double value = 0;
    const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool good = end.ec == std::errc{} && end.ptr == text.data() + text.size();
    // Which is no number at all is within no bounds.
    return good && value >= low && value <= high
               ? ""
               : fmt::format("'{}': expected a number from {} to {}", text, low, high);
  };
  return {refuse, fmt::format("{} to {}", low, high)};
}

CLI::Validator page_folder() {
  const auto refuse = [](const std::string& folder) -> std::string {
    try {
      const report::PageFolder trial(folder);
      return "";
    } catch (const Error& error) {
      return error.what();
    }
  };
  return {refuse, ""};
}

CLI::Validator output_folder() {
  const auto refuse = [](const std::string& folder) -> std::string {
    std::error_code ignored;
    if (fs::is_directory(folder, ignored) && access(folder.c_str(), W_OK | X_OK) == 0) return "";
    return "'" + folder + "' cannot be written to, expected a folder that is there and open to writing";
  };
  return {refuse, ""};
}

CLI::Validator output_file(const std::string& ending) {
  const auto refuse = [ending](const std::string& file) -> std::string {
    const std::string own = CLI::detail::to_lower(fs::path(file).extension().string());
    if (!ending.empty() && !own.empty() && own != ending)
      return "'" + file + "': expected a name that ends in " + ending;
    const fs::path folder = fs::path(file).parent_path();
    const bool open = access(folder.empty() ? "." : folder.c_str(), W_OK | X_OK) == 0;
    std::error_code error;
    const bool taken = fs::is_directory(file, error);
    if (!file.empty() && open && !taken && error != std::errc::filename_too_long) return "";
    return "'" + file + "' cannot be written, expected a file in a folder that is there and open to writing";
  };
  return {refuse, ""};
}

CLI::Validator not_empty() {
  const auto refuse = [](const std::string& text) -> std::string {
    return text.empty() ? "it is empty, expected a name" : "";
  };
  return {refuse, ""};
}

namespace {

// Where a file or folder is, or will be; of a level in an archive, the archive.
fs::path place_of(const std::string& name) {
  if (name.empty()) return {};
  std::error_code ignored;
  const std::size_t in_archive = name.find(".pk3:");
  const fs::path path = in_archive == std::string::npos ? name : name.substr(0, in_archive + 4);
  return fs::weakly_canonical(fs::absolute(path, ignored), ignored).lexically_normal();
}

bool holds(const fs::path& folder, const fs::path& path) {
  const auto [end, ignored] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return end == folder.end();
}

}  // namespace

void expect_apart(const std::vector<NamedPath>& read, const std::vector<NamedPath>& written) {
  std::vector<NamedPath> taken;
  // A world and a path along it have names, and no place.
  for (const NamedPath& one : read)
    if (std::error_code ignored; fs::exists(place_of(one.path), ignored)) taken.push_back(one);
  for (const NamedPath& one : written) {
    if (one.path.empty()) continue;
    const fs::path place = place_of(one.path);
    for (const auto& [option, path] : taken) {
      const fs::path other = place_of(path);
      if (holds(place, other) || holds(other, place))
        throw Error(fmt::format("{} '{}' and {} '{}' are one place, expected two", option, path, one.option,
                                one.path));
    }
    taken.push_back(one);
  }
}

void add_faces(CLI::App& command, RasterState& state) {
  static const std::map<std::string, RasterState> kStates{{"materials", RasterState::materials},
                                                          {"both", RasterState::both_sides},
                                                          {"front", RasterState::front_faces}};
  command
      .add_option_function<std::string>(
          "--faces", [&state](const std::string& name) { state = kStates.at(name); },
          "sides of triangles that are drawn: as the materials say, both, or front alone; what is exact is "
          "so "
          "in that state")
      ->check(CLI::IsMember(kStates).description(""))
      ->type_name("materials|both|front");
}

std::pair<std::uint32_t, std::uint32_t> parse_size(const std::string& text) {
  std::uint32_t width = 0, height = 0;
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, width);
  if (first.ec == std::errc{} && first.ptr != end && *first.ptr == 'x') {
    const auto second = std::from_chars(first.ptr + 1, end, height);
    if (second.ec == std::errc{} && second.ptr == end && width > 0 && height > 0 && width <= 4096 &&
        height <= 4096) {
      return {width, height};
    }
  }
  throw Error("--size '" + text + "': expected WIDTHxHEIGHT in pixels, 1 to 4096 each, such as 1280x720");
}

std::vector<std::string> split(const std::string& option, const std::string& list) {
  std::vector<std::string> out;
  for (std::size_t start = 0; start <= list.size();) {
    const std::size_t comma = std::min(list.find(',', start), list.size());
    if (comma == start)
      throw Error(option + " '" + list + "': an entry is empty, expected values with single commas between");
    out.push_back(list.substr(start, comma - start));
    start = comma + 1;
  }
  return out;
}

std::string range_of(const ParameterInfo& parameter) {
  return parameter.choices.empty() ? fmt::format("{} to {}", parameter.min, parameter.max)
                                   : std::string(parameter.choices);
}

}  // namespace sightline::app
