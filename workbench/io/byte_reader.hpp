// Reading numbers out of bytes that nobody vouches for, as the library does.
#pragma once

#include "library/pvs/byte_reader.hpp"

namespace sightline::io {

using pvs::Bytes;
using pvs::fits;
using pvs::read_at;

}  // namespace sightline::io
