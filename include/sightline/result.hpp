// Errors by value: the core is built without exceptions and refuses bad input with one of these.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace sightline {

/// Why something was refused: one sentence that says what, where, and what was expected.
struct Failure {
  std::string message;
};

/// A value, or the reason why there is none.
template <class T>
class [[nodiscard]] Result {
public:
  Result(T value) : held_(std::in_place_index<0>, std::move(value)) {}
  Result(Failure failure) : held_(std::in_place_index<1>, std::move(failure)) {}

  explicit operator bool() const noexcept { return held_.index() == 0; }
  /// The value; only where the result is true.
  T& operator*() & noexcept { return *std::get_if<0>(&held_); }
  T&& operator*() && noexcept { return std::move(*std::get_if<0>(&held_)); }
  const T& operator*() const& noexcept { return *std::get_if<0>(&held_); }
  T* operator->() noexcept { return std::get_if<0>(&held_); }
  const T* operator->() const noexcept { return std::get_if<0>(&held_); }
  /// The reason; only where the result is false.
  const Failure& failure() const noexcept { return *std::get_if<1>(&held_); }

private:
  std::variant<T, Failure> held_;
};

/// Nothing, or the reason why something is wrong.
using Check = std::optional<Failure>;

}  // namespace sightline
