#include "workbench/reproduce/published.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>

#include <sightline/workbench/error.hpp>

#include "workbench/reproduce/published_files.hpp"

namespace sightline::reproduce {

namespace {

std::vector<std::string> split(std::string_view text, char at) {
  std::vector<std::string> parts;
  for (std::size_t from = 0;;) {
    const std::size_t end = text.find(at, from);
    parts.emplace_back(text.substr(from, end - from));
    if (end == std::string_view::npos) return parts;
    from = end + 1;
  }
}

}  // namespace

Published::Published(std::string_view csv) {
  for (std::string& line : split(csv, '\n')) {
    if (line.empty()) continue;
    std::vector<std::string> cells = split(line, ',');
    if (header_.empty()) {
      header_ = std::move(cells);
      continue;
    }
    if (cells.size() != header_.size())
      throw Error(
          fmt::format("published: \"{}\" has {} cells, expected {}", line, cells.size(), header_.size()));
    for (std::string& cell : cells) {
      if (cell == "-") cell.clear();
    }
    rows_.push_back(std::move(cells));
  }
}

std::size_t Published::column(std::string_view name) const {
  const auto found = std::ranges::find(header_, name);
  if (found == header_.end()) throw Error(fmt::format("published: there is no column \"{}\"", name));
  return static_cast<std::size_t>(found - header_.begin());
}

const std::string& Published::text(const std::vector<Key>& keys, std::string_view wanted) const {
  const std::vector<std::string>* only = nullptr;
  for (const std::vector<std::string>& row : rows_) {
    const bool fits =
        std::ranges::all_of(keys, [&](const Key& key) { return row[column(key.first)] == key.second; });
    if (fits && only)
      throw Error(fmt::format("published: two rows with {} \"{}\"", keys.front().first, keys.front().second));
    if (fits) only = &row;
  }
  if (!only)
    throw Error(fmt::format("published: no row with {} \"{}\"", keys.front().first, keys.front().second));
  return (*only)[column(wanted)];
}

const Published& published(std::string_view name) {
  static const std::map<std::string, Published, std::less<>> files = [] {
    std::map<std::string, Published, std::less<>> made;
    for (const PublishedFile& file : kPublishedFiles) made.emplace(file.name, Published(file.csv));
    return made;
  }();
  const auto found = files.find(name);
  if (found == files.end()) throw Error(fmt::format("published: there is no file \"{}\"", name));
  return found->second;
}

std::optional<double> number_of(std::string_view cell) noexcept {
  double value = 0;
  const auto [end, failed] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (failed != std::errc() || end != cell.data() + cell.size()) return std::nullopt;
  return value;
}

}  // namespace sightline::reproduce
