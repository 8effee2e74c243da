/** @file
 * What a call has done, and why not: see <sightline/sightline.h>. */
#ifndef SIGHTLINE_C_STATUS_H
#define SIGHTLINE_C_STATUS_H

#include <stddef.h>
#include <stdint.h>

/* Windows: define SIGHTLINE_STATIC where the static library is linked; SIGHTLINE_BUILD is for the library. */
#if defined(_WIN32) && defined(SIGHTLINE_STATIC)
#define SIGHTLINE_API
#elif defined(_WIN32) && defined(SIGHTLINE_BUILD)
#define SIGHTLINE_API __declspec(dllexport)
#elif defined(_WIN32)
#define SIGHTLINE_API __declspec(dllimport)
#elif defined(__GNUC__)
#define SIGHTLINE_API __attribute__((visibility("default")))
#else
#define SIGHTLINE_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** The version of these headers; sightline_version() is the library's. */
#define SIGHTLINE_VERSION_MAJOR 0
#define SIGHTLINE_VERSION_MINOR 1
#define SIGHTLINE_VERSION_PATCH 0

/** What kind of thing was refused. New ones are added at the end. */
typedef enum sightline_status {
  SIGHTLINE_OK = 0,               /**< nothing was */
  SIGHTLINE_BAD_ARGUMENT = 1,     /**< NULL, a stride, a count or an option out of range */
  SIGHTLINE_BAD_BOX = 2,          /**< a box or a sphere not finite, turned inside out, or out of reach */
  SIGHTLINE_STALE_HANDLE = 3,     /**< a handle that names no object of this world */
  SIGHTLINE_BAD_VIEW = 4,         /**< not finite, not invertible, or a size out of range */
  SIGHTLINE_BUFFER_TOO_SMALL = 5, /**< an output that is shorter than the function says */
  SIGHTLINE_STALE_BUFFER = 6,     /**< an occlusion not begun, or begun with another view */
  SIGHTLINE_BAD_MESH = 7,         /**< positions that are not finite, or indices out of range */
  SIGHTLINE_TOO_MANY = 8,         /**< more than the library, or this machine's memory, holds */
  SIGHTLINE_BAD_FILE = 9          /**< bytes that are damaged, of another version, or of something else */
} sightline_status;

/** The index of a refusal where no one element is to blame. */
#define SIGHTLINE_NO_INDEX ((size_t)-1)

/** Why a call was refused. */
typedef struct sightline_error {
  sightline_status status; /**< what kind of thing was refused */
  size_t index;            /**< which element of the argument that the message names; of a file, which byte */
  const char* message;     /**< one sentence, which lives as long as the program; never NULL */
} sightline_error;

/** The library's version: "0.1.0". */
SIGHTLINE_API const char* sightline_version(void);

/** The last refusal on this thread, whole; successes leave it as it is. Before the first: SIGHTLINE_OK,
 * SIGHTLINE_NO_INDEX, "". NULL: nothing is written. */
SIGHTLINE_API void sightline_last_failure(sightline_error* failure);
/** Its message: what, where, and what was expected. */
SIGHTLINE_API const char* sightline_last_error(void);
/** Its index, or SIGHTLINE_NO_INDEX. */
SIGHTLINE_API size_t sightline_last_error_index(void);

#ifdef __cplusplus
}
#endif

#endif
