// How the library refuses: by value, without exceptions and without allocating.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <variant>

namespace sightline {

/// What kind of thing was refused. The same numbers as sightline_status in C; new ones are added at the end.
enum class StatusCode : std::uint8_t {
  ok = 0,                ///< nothing was
  bad_argument = 1,      ///< a null pointer, a stride, a count or an option out of range
  bad_box = 2,           ///< a box or a sphere that is not finite, turned inside out, or out of reach
  stale_handle = 3,      ///< a handle that names no object of this world
  bad_view = 4,          ///< a view that is not finite or not invertible, or whose size is out of range
  buffer_too_small = 5,  ///< an output span that is shorter than the function says
  stale_buffer = 6,      ///< an occlusion buffer that was not begun, or was begun with another view
  bad_mesh = 7,          ///< a mesh with positions that are not finite, or indices out of range
  too_many = 8,          ///< more than the library, or this machine's memory, holds
  bad_file = 9,          ///< bytes that are damaged, truncated, of another version, or of something else
};

/// Whether a call did what it says and, if not, what was wrong: true where it did. A refused call changes
/// nothing.
///
/// Unless a function of it says otherwise: Errors: none. Cost: constant. Threads: any. Allocates: nothing.
class [[nodiscard]] Status {
public:
  /// index() where no one element is to blame.
  static constexpr std::size_t kNoIndex = static_cast<std::size_t>(-1);

  /// Done.
  constexpr Status() noexcept = default;
  /// Refused. `message` is one sentence that lives as long as the program; `index` is the offending
  /// element's, counted in the argument that the message names.
  constexpr Status(StatusCode code, const char* message, std::size_t index = kNoIndex) noexcept
      : message_(message), index_(index), code_(code) {}

  /// True where the call did what it says.
  constexpr explicit operator bool() const noexcept { return code_ == StatusCode::ok; }
  /// What kind of thing was refused; ok where nothing was.
  [[nodiscard]] constexpr StatusCode code() const noexcept { return code_; }
  /// One sentence: what, where, and what was expected. Lives as long as the program; never null.
  [[nodiscard]] constexpr const char* message() const noexcept { return message_; }
  /// Which element was refused (of a file: which byte), or kNoIndex.
  [[nodiscard]] constexpr std::size_t index() const noexcept { return index_; }

private:
  const char* message_ = "done";
  std::size_t index_ = kNoIndex;
  StatusCode code_ = StatusCode::ok;
};

/// A value, or why there is none: true where there is one.
///
/// Unless a function of it says otherwise: Errors: none. Cost: constant. Threads: any. Allocates: nothing.
template <class T>
class [[nodiscard]] Result {
public:
  /// Done: holds the value.
  Result(T value) : held_(std::in_place_index<0>, std::move(value)) {}
  /// Refused: `error` says why there is no value.
  Result(Status error) : held_(std::in_place_index<1>, error) {}

  /// True where there is a value.
  explicit operator bool() const noexcept { return held_.index() == 0; }
  /// The value; only where the result is true.
  T& operator*() & noexcept { return *std::get_if<0>(&held_); }
  /// The same, to be moved from.
  T&& operator*() && noexcept { return std::move(*std::get_if<0>(&held_)); }
  /// The same, for reading.
  const T& operator*() const& noexcept { return *std::get_if<0>(&held_); }
  /// A member of the value; only where the result is true.
  T* operator->() noexcept { return std::get_if<0>(&held_); }
  /// The same, for reading.
  const T* operator->() const noexcept { return std::get_if<0>(&held_); }
  /// Why there is no value; done where there is one.
  [[nodiscard]] Status error() const noexcept {
    return held_.index() == 1 ? *std::get_if<1>(&held_) : Status();
  }

private:
  std::variant<T, Status> held_;
};

}  // namespace sightline
