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

/// Reads a byte of each line of memory, so that these come. For what is then read in pieces that cross lines:
/// processors that see such pieces alone do not foresee which lines are next, and wait for twice as long.
/// Some kilobytes at a time are best.
inline void read_lines(const void* first, std::size_t bytes) noexcept {
  constexpr std::size_t kLine = 64;
  const auto* const at = static_cast<const volatile char*>(first);
  for (std::size_t i = 0; i < bytes; i += kLine) (void)at[i];
}

}  // namespace sightline::geometry
