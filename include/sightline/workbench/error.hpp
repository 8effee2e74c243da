// What the workbench throws: a sentence a user can act on.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include <sightline/status.hpp>

namespace sightline {

/// Names may hold anything: what would cut a line short or steer a terminal becomes '?'.
inline std::string printable(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return (c >= 0 && c < ' ') || c == 127; }, '?');
  return text;
}

/// Bad input or a machine that lacks something; what() is one sentence: what, where, what was expected.
class Error : public std::runtime_error {
public:
  explicit Error(std::string sentence) : std::runtime_error(printable(std::move(sentence))) {}
};

/// What the library refused and why, with the element's number, or a file's byte, where one is to blame.
inline std::string to_string(const Status& status) {
  std::string sentence = status.message();
  if (status.index() == Status::kNoIndex) return sentence;
  return sentence + (status.code() == StatusCode::bad_file ? " (at byte " : " (number ") +
         std::to_string(status.index()) + (status.code() == StatusCode::bad_file ? ")" : ", counted from 0)");
}

/// What the library refused, thrown as an Error.
inline void or_throw(const Status& status) {
  if (!status) throw Error(to_string(status));
}

/// The value of a result, or what the library refused, thrown as an Error.
template <class T>
T or_throw(Result<T> result) {
  or_throw(result.error());
  return *std::move(result);
}

}  // namespace sightline
