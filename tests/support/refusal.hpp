// What something is refused with.
#pragma once

#include <string>

#include <sightline/workbench/error.hpp>

namespace sightline::test {

/// The sentence of the Error that `action` throws; empty where it throws none.
template <class Action>
std::string refusal(const Action& action) {
  try {
    static_cast<void>(action());
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace sightline::test
