// What is written under a temporary name, so that whoever ends the program early can take it away.
#pragma once

#include <filesystem>

namespace sightline::io {

/// A file or folder that is not finished; taken away with this, unless it was renamed or kept.
/// Threads: any may have some at once.
class Unfinished {
public:
  /// Nothing needs to stand there yet. `asked_for` is what it will be, by the name that the user gave.
  Unfinished(std::filesystem::path path, std::filesystem::path asked_for);
  ~Unfinished();
  Unfinished(const Unfinished&) = delete;
  Unfinished& operator=(const Unfinished&) = delete;

  /// It is finished, and stays.
  void keep() noexcept;
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  [[nodiscard]] const std::filesystem::path& asked_for() const noexcept { return asked_for_; }

private:
  std::filesystem::path path_, asked_for_;
};

/// The name to tell the user of a path: of a file in an unfinished folder, the one that it will have.
std::filesystem::path name_asked_for(const std::filesystem::path& path);

/// Takes away all that there is, for a program that ends at once: nobody can begin anything afterwards.
void remove_unfinished() noexcept;

}  // namespace sightline::io
