// Vectors whose memory suits SIMD loads, and large ones that are walked in no order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

#if defined(__SANITIZE_ADDRESS__)
#define SIGHTLINE_SEES_NO_MAPS
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SIGHTLINE_SEES_NO_MAPS
#endif
#endif
#if defined(__linux__) && !defined(SIGHTLINE_SEES_NO_MAPS)
#define SIGHTLINE_MAPS_LARGE_PAGES
#include <sys/mman.h>
#endif

namespace sightline::geometry {

/// An allocator of whole cache lines.
template <class T>
struct CacheAligned {
  using value_type = T;
  CacheAligned() = default;
  template <class U>
  CacheAligned(const CacheAligned<U>&) noexcept {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new (n * sizeof(T), std::align_val_t{64})); }
  void deallocate(T* p, std::size_t) noexcept { ::operator delete (p, std::align_val_t{64}); }
  bool operator==(const CacheAligned&) const = default;
};
/// Memory for SIMD loads.
template <class T>
using AlignedVector = std::vector<T, CacheAligned<T>>;

inline constexpr std::size_t kLargePage = std::size_t{2} << 20;
/// A multiple of what any processor calls a page.
inline constexpr std::size_t kSmallPage = std::size_t{64} << 10;

#ifdef SIGHTLINE_MAPS_LARGE_PAGES
/// Throws std::bad_alloc, in code that is compiled without exceptions, too: no heap has so much.
inline void* refuse_allocation() {
  const volatile std::size_t endless = PTRDIFF_MAX;
  return ::operator new(endless);
}

/// Memory that begins with a large page. It ends with small ones, so that no large one stands for the rest.
inline void* allocate_large(std::size_t bytes) {
  const std::size_t size = (bytes + kSmallPage - 1) / kSmallPage * kSmallPage;
  void* const mapped =
      mmap(nullptr, size + kLargePage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (mapped == MAP_FAILED) return refuse_allocation();
  auto* const first = static_cast<std::byte*>(mapped);
  const std::size_t before = (kLargePage - reinterpret_cast<std::uintptr_t>(first) % kLargePage) % kLargePage;
  std::byte* const memory = first + before;
  if (before > 0) munmap(first, before);
  munmap(memory + size, kLargePage - before);
  madvise(memory, size, MADV_HUGEPAGE);  // before anybody touches it; a wish, no more
  return memory;
}
inline void deallocate_large(void* memory, std::size_t bytes) noexcept {
  munmap(memory, (bytes + kSmallPage - 1) / kSmallPage * kSmallPage);
}
#else
inline void* allocate_large(std::size_t bytes) {
  return ::operator new (bytes, std::align_val_t{kLargePage});
}
inline void deallocate_large(void* memory, std::size_t) noexcept {
  ::operator delete (memory, std::align_val_t{kLargePage});
}
#endif

/// An allocator of large pages where the system gives them, as each jump to another small page costs a
/// look-up of its own. Less than a large page is aligned to 64 bytes, for SIMD loads. On Linux what is large
/// is mapped by itself, so that it goes back to the system at once and no heap is left with holes; but for
/// AddressSanitizer, which would not see it.
template <class T>
struct LargePages {
  using value_type = T;
  static constexpr std::size_t kLine = alignof(T) > 64 ? alignof(T) : 64;

  LargePages() = default;
  template <class U>
  LargePages(const LargePages<U>&) noexcept {}

  [[nodiscard]] T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    void* const memory =
        bytes >= kLargePage ? allocate_large(bytes) : ::operator new (bytes, std::align_val_t{kLine});
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) noexcept {
    const std::size_t bytes = count * sizeof(T);
    bytes >= kLargePage ? deallocate_large(memory, bytes)
                        : ::operator delete (memory, std::align_val_t{kLine});
  }

  template <class U>
  bool operator==(const LargePages<U>&) const noexcept {
    return true;
  }
};

/// The same, whose elements begin as what the memory happened to hold: what nobody writes takes no memory.
template <class T>
struct UnwrittenPages : LargePages<T> {
  UnwrittenPages() = default;
  template <class U>
  UnwrittenPages(const UnwrittenPages<U>&) noexcept {}
  template <class U>
  void construct(U* place) noexcept {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U>
  struct rebind {
    using other = UnwrittenPages<U>;
  };
};

/// Memory for SIMD loads that is walked in no order.
template <class T>
using LargeVector = std::vector<T, LargePages<T>>;
template <class T>
using UnwrittenVector = std::vector<T, UnwrittenPages<T>>;

}  // namespace sightline::geometry
