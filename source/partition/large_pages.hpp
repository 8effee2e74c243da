// Memory of large arrays that are walked in no order: in large pages where the system gives them, as each
// jump to another small page costs a look-up of its own.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace sightline::partition {

/// An allocator. Less than a large page is aligned to 64 bytes, for SIMD loads.
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

}  // namespace sightline::partition
