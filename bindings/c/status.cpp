// The version, and the last refusal of each thread.
#include <sightline/sightline.h>

#include <sightline/version.hpp>

#include "bindings/c/calls.hpp"

#define SIGHTLINE_TEXT(x) #x
#define SIGHTLINE_DOTTED(a, b, c) SIGHTLINE_TEXT(a) "." SIGHTLINE_TEXT(b) "." SIGHTLINE_TEXT(c)

namespace sightline::c_api {

namespace {

static_assert(kVersion ==
              SIGHTLINE_DOTTED(SIGHTLINE_VERSION_MAJOR, SIGHTLINE_VERSION_MINOR, SIGHTLINE_VERSION_PATCH));

constexpr bool same(sightline_status status, StatusCode code) {
  return static_cast<int>(status) == static_cast<int>(code);
}
static_assert(same(SIGHTLINE_OK, StatusCode::ok) && same(SIGHTLINE_BAD_ARGUMENT, StatusCode::bad_argument) &&
              same(SIGHTLINE_BAD_BOX, StatusCode::bad_box) &&
              same(SIGHTLINE_STALE_HANDLE, StatusCode::stale_handle) &&
              same(SIGHTLINE_BAD_VIEW, StatusCode::bad_view) &&
              same(SIGHTLINE_BUFFER_TOO_SMALL, StatusCode::buffer_too_small) &&
              same(SIGHTLINE_STALE_BUFFER, StatusCode::stale_buffer) &&
              same(SIGHTLINE_BAD_MESH, StatusCode::bad_mesh) &&
              same(SIGHTLINE_TOO_MANY, StatusCode::too_many) &&
              same(SIGHTLINE_BAD_FILE, StatusCode::bad_file));
static_assert(SIGHTLINE_NO_INDEX == Status::kNoIndex);

#ifndef __wasm__  // WebAssembly has one thread
thread_local
#endif
    sightline_error last{SIGHTLINE_OK, SIGHTLINE_NO_INDEX, ""};

}  // namespace

sightline_status keep(const Status& status) noexcept {
  const auto code = static_cast<sightline_status>(status.code());
  if (!status) last = {code, status.index(), status.message()};
  return code;
}

}  // namespace sightline::c_api

using sightline::c_api::last;

extern "C" {

const char* sightline_version(void) {
  return sightline::kVersion.data();
}

void sightline_last_failure(sightline_error* failure) {
  if (failure) *failure = last;
}
const char* sightline_last_error(void) {
  return last.message;
}
size_t sightline_last_error_index(void) {
  return last.index;
}

}  // extern "C"
