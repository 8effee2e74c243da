// sightline reproduce object-frustum.
#pragma once

#include <CLI/CLI.hpp>

namespace sightline::app {

/// Adds the paper to the command `reproduce`; running it sets `exit`.
void add_object_frustum(CLI::App& reproduce, int& exit);

}  // namespace sightline::app
