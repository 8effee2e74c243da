// Vectors whose memory suits SIMD loads, and large ones that are walked in no order.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>
#include <vector>

#ifdef __linux__
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

/// An allocator of large pages where the system gives them, as each jump to another small page costs a
/// look-up of its own. Less than a large page is aligned to 64 bytes, for SIMD loads.
template <class T>
struct LargePages {
  using value_type = T;
  static constexpr std::size_t kPage = std::size_t{2} << 20;
  static constexpr std::size_t kLine = alignof(T) > 64 ? alignof(T) : 64;

  LargePages() = default;
  template <class U>
  LargePages(const LargePages<U>&) noexcept {}

  [[nodiscard]] T* allocate(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    const bool large = bytes >= kPage;
    void* memory = ::operator new (bytes, std::align_val_t{large ? kPage : kLine});
#ifdef __linux__
    if (large) madvise(memory, bytes, MADV_HUGEPAGE);  // before anybody touches it; a wish, no more
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) noexcept {
    ::operator delete (memory, std::align_val_t{count * sizeof(T) >= kPage ? kPage : kLine});
  }

  template <class U>
  bool operator==(const LargePages<U>&) const noexcept {
    return true;
  }
};

/// Memory for SIMD loads that is walked in no order.
template <class T>
using LargeVector = std::vector<T, LargePages<T>>;

}  // namespace sightline::geometry
