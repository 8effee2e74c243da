// What the workbench throws: a sentence a user can act on.
#pragma once

#include <stdexcept>
#include <string>

#include <sightline/result.hpp>

namespace sightline {

/// Bad input or a machine that lacks something; what() is one sentence: what, where, what was expected.
class Error : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// The value of a result, or its failure thrown as an Error.
template <class T>
T or_throw(Result<T> result) {
  if (!result) throw Error(result.failure().message);
  return std::move(*result);
}

inline void or_throw(const Check& check) {
  if (check) throw Error(check->message);
}

}  // namespace sightline
