#include "workbench/report/page_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <iterator>
#include <string_view>
#include <vector>

#include <sightline/workbench/error.hpp>

namespace sightline::report {

namespace fs = std::filesystem;

namespace {

constexpr const char* kPage = "index.html";

bool is_page(const fs::path& folder) {
  std::error_code failed;
  if (!fs::is_regular_file(folder / kPage, failed)) return false;  // opening a pipe waits for who writes it
  std::ifstream page(folder / kPage, std::ios::binary);
  std::string head(1024, '\0');
  page.read(head.data(), static_cast<std::streamsize>(head.size()));
  return head.find(kPageMark) != std::string::npos;
}

// The pictures of the page in a folder: those that it names. What else lies there is somebody else's.
std::vector<fs::path> pictures_of(const fs::path& folder) {
  std::ifstream page(folder / kPage, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(page), {});
  std::vector<fs::path> pictures;
  std::error_code failed;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed)) {
    const fs::path name = entry.path().filename(), kind = name.extension();
    if ((kind == ".png" || kind == ".svg") && entry.symlink_status(failed).type() == fs::file_type::regular &&
        text.find('"' + name.string() + '"') != std::string::npos)
      pictures.push_back(entry.path());
  }
  return pictures;
}

constexpr std::string_view kBegins = ".sightline-", kEnds = ".tmp";

// What another program has not finished, or was killed over: it is not ours to look at or take away.
bool is_unfinished(const fs::directory_entry& entry) {
  const std::string name = entry.path().filename().string();
  return name.starts_with(kBegins) && name.ends_with(kEnds);
}

bool is_free(const fs::path& folder) {
  std::error_code failed;
  return std::ranges::all_of(fs::directory_iterator(folder, failed), is_unfinished);
}

}  // namespace

PageFolder::PageFolder(const fs::path& target) {
  if (target.empty()) throw Error("a page has no folder, expected a name");
  target_ = fs::absolute(target).lexically_normal();
  if (!target_.has_filename()) target_ = target_.parent_path();  // "DIR/"
  std::error_code failed;
  const auto refuse = [&](const char* expected) {
    throw Error(fmt::format("{}: cannot be written, expected {}", target.string(), expected));
  };
  if (fs::exists(target_, failed)) {
    if (!fs::is_directory(target_, failed)) refuse("a folder");
    if (access(target_.c_str(), R_OK | W_OK | X_OK) != 0) refuse("a folder open to writing");
    if (!is_free(target_) && !is_page(target_))
      refuse("an empty folder, a new one, or an earlier page of ours to replace");
  } else {
    if (fs::create_directories(target_, failed)) made_target_.emplace(target_, target);
    if (failed) refuse("a folder or a place for one");
  }
  static std::atomic<unsigned> count = 0;
  // Within the target: what stands beside it may be another file system, or closed.
  partial_.emplace(target_ / fmt::format("{}{}-{}{}", kBegins, getpid(), count++, kEnds), target);
  fs::create_directory(path(), failed);
  if (failed) throw Error(fmt::format("{}: cannot be written: {}", target.string(), failed.message()));
}

void PageFolder::commit() {
  std::error_code failed;
  if (is_page(target_)) {
    for (const fs::path& picture : pictures_of(target_)) fs::remove(picture, failed);
    fs::remove(target_ / kPage, failed);
  }
  const auto move = [&](const fs::path& file) {
    if (!failed) fs::rename(file, target_ / file.filename(), failed);
  };
  // The page comes last: where it stands, its pictures do.
  for (const fs::directory_entry& file : fs::directory_iterator(path())) {
    if (file.path().filename() != kPage) move(file.path());
  }
  move(path() / kPage);
  if (failed)
    throw Error(fmt::format("{}: the page cannot be put there: {}", target_.string(), failed.message()));
  if (made_target_) made_target_->keep();
}

}  // namespace sightline::report
