// A folder with a page and its pictures, written whole or not at all.
#pragma once

#include <filesystem>
#include <optional>

#include "workbench/io/unfinished.hpp"

namespace sightline::report {

/// What index.html holds in its first kilobyte, so that a later report knows what it may replace.
inline constexpr const char* kPageMark = "<meta name=\"generator\" content=\"Sightline\">";

/// Files are written to path(), a folder under a temporary name in the target; commit() puts them in the
/// place of an earlier page and the pictures that it names. Without it nothing is left behind, and what stood
/// in the target stays, as what is no page's always does.
class PageFolder {
public:
  /// Throws Error where the folder cannot be made, or the target holds anything but an earlier page.
  explicit PageFolder(const std::filesystem::path& target);
  PageFolder(const PageFolder&) = delete;
  PageFolder& operator=(const PageFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return partial_->path(); }
  /// Throws Error where the files cannot be moved.
  void commit();

private:
  std::filesystem::path target_;
  // Also the target itself, as long as it is a new and empty folder.
  std::optional<io::Unfinished> made_target_, partial_;
};

}  // namespace sightline::report
