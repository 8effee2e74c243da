// Memory that is soon needed, asked for.
#pragma once

#include <hwy/cache_control.h>

#include <cstddef>

namespace sightline::geometry {

#ifdef __wasm__
/// WebAssembly has no instruction for it: there the memory is read, which pays for many places in a row, as
/// the processor waits for several of them at once.
inline constexpr bool kAsksByReading = true;
inline void ask_ahead(const void* place) noexcept {
  (void)*static_cast<const volatile char*>(place);
}
#else
inline constexpr bool kAsksByReading = false;
inline void ask_ahead(const void* place) noexcept {
  hwy::Prefetch(static_cast<const char*>(place));
#ifdef __GNUC__
  __asm__ volatile("" : : "r"(place));  // or a loop that does nothing else is taken for one that does nothing
#endif
}
#endif

/// Asks for all lines of memory that an object fills, which begins on one; for none where asking is reading.
template <class T>
void prefetch_lines(const T& object) noexcept {
  constexpr std::size_t kLine = 64;
  if (kAsksByReading) return;
  for (std::size_t at = 0; at < sizeof(T); at += kLine)
    ask_ahead(reinterpret_cast<const char*>(&object) + at);
}

}  // namespace sightline::geometry
