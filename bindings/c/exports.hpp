// Included before each source of the library, which is compiled with hidden visibility: what the public
// headers declare is seen from outside the shared library, all else is not.
#pragma once

#pragma GCC visibility push(default)
#include <sightline/sightline.h>
#include <sightline/sightline.hpp>
#pragma GCC visibility pop
