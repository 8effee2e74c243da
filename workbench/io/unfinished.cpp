#include "workbench/io/unfinished.hpp"

#include <algorithm>
#include <mutex>
#include <system_error>
#include <utility>
#include <vector>

namespace sightline::io {

namespace {

// Never destroyed: a program may be ended while it ends.
struct Register {
  std::mutex mutex;
  std::vector<const Unfinished*> all;
};
Register& known() {
  static Register& made = *new Register;
  return made;
}

void take_away(const std::filesystem::path& path) noexcept {
  std::error_code ignored;
  if (!path.empty()) std::filesystem::remove_all(path, ignored);
}

}  // namespace

Unfinished::Unfinished(std::filesystem::path path, std::filesystem::path asked_for)
    : path_(std::move(path)), asked_for_(std::move(asked_for)) {
  const std::lock_guard lock(known().mutex);
  known().all.push_back(this);
}

Unfinished::~Unfinished() {
  const std::lock_guard lock(known().mutex);
  take_away(path_);
  std::erase(known().all, this);
}

void Unfinished::keep() noexcept {
  const std::lock_guard lock(known().mutex);
  path_.clear();
}

std::filesystem::path name_asked_for(const std::filesystem::path& path) {
  const std::lock_guard lock(known().mutex);
  for (const Unfinished* one : known().all) {
    const std::filesystem::path& folder = one->path();
    if (!folder.empty() && path.parent_path() == folder) return one->asked_for() / path.filename();
  }
  return path;
}

void remove_unfinished() noexcept {
  known().mutex.lock();  // for good
  for (const Unfinished* one : known().all) take_away(one->path());
}

}  // namespace sightline::io
