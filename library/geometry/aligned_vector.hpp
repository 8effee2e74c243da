// Vectors whose memory suits SIMD loads, and large ones that are walked in no order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#include <sightline/cache_aligned.hpp>

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

/// Memory for SIMD loads.
template <class T>
using AlignedVector = std::vector<T, CacheAligned<T>>;

inline constexpr std::size_t kLargePage = std::size_t{2} << 20;
/// A multiple of what any processor calls a page.
inline constexpr std::size_t kSmallPage = std::size_t{64} << 10;

#ifdef SIGHTLINE_MAPS_LARGE_PAGES
inline std::size_t in_small_pages(std::size_t bytes) noexcept {
  return (bytes + kSmallPage - 1) / kSmallPage * kSmallPage;
}

/// Throws std::bad_alloc, in code that is compiled without exceptions, too: no heap has so much.
inline void* refuse_allocation() {
  const volatile std::size_t endless = PTRDIFF_MAX;
  return ::operator new(endless);
}

/// Memory that begins with a large page. It ends with small ones, so that no large one stands for the rest.
inline void* allocate_large(std::size_t bytes) {
  const std::size_t size = in_small_pages(bytes);
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
  munmap(memory, in_small_pages(bytes));
}
/// Gives such memory another place where more follows it; nothing is copied.
inline void* grow_large(void* memory, std::size_t bytes, std::size_t more) {
  void* const place = allocate_large(more);
  constexpr int kThere = MREMAP_MAYMOVE | MREMAP_FIXED;
  if (mremap(memory, in_small_pages(bytes), in_small_pages(more), kThere, place) != MAP_FAILED) return place;
  deallocate_large(place, more);  // what was there may be gone
  void* const copy = allocate_large(more);
  std::memcpy(copy, memory, bytes);
  deallocate_large(memory, bytes);
  return copy;
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
  /// Whether so many elements begin as zero bytes.
  [[nodiscard]] static constexpr bool begin_as_zeros([[maybe_unused]] std::size_t count) noexcept {
#ifdef SIGHTLINE_MAPS_LARGE_PAGES
    return count * sizeof(T) >= kLargePage;
#else
    return false;
#endif
  }
  /// The same elements, if any, with room for more. They must be such as memcpy() may move.
  [[nodiscard]] T* grow(T* memory, std::size_t count, std::size_t more) {
#ifdef SIGHTLINE_MAPS_LARGE_PAGES
    if (count * sizeof(T) >= kLargePage)
      return static_cast<T*>(grow_large(memory, count * sizeof(T), more * sizeof(T)));
#endif
    T* const out = allocate(more);
    if (!memory) return out;
    std::memcpy(out, memory, count * sizeof(T));
    deallocate(memory, count);
    return out;
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

/// Memory for SIMD loads that is walked in no order.
template <class T>
using LargeVector = std::vector<T, LargePages<T>>;

/// The same, whose elements begin as zero bytes, which on Linux nobody writes once it is large: what is not
/// used takes no memory, and it grows without a copy. What a heap leaves behind would not do: SIMD loads read
/// beyond the last element, and processors take a hundred times as long where a number is subnormal.
template <class T>
class UnwrittenVector {
public:
  static_assert(std::is_trivially_copyable_v<T>);
  UnwrittenVector() = default;
  explicit UnwrittenVector(std::size_t size) { resize(size); }
  UnwrittenVector(UnwrittenVector&& other) noexcept { swap(other); }
  UnwrittenVector& operator=(UnwrittenVector&& other) noexcept {
    UnwrittenVector(std::move(other)).swap(*this);
    return *this;
  }
  ~UnwrittenVector() {
    if (memory_) LargePages<T>().deallocate(memory_, capacity_);
  }

  void resize(std::size_t size) {
    if (size > capacity_) reserve(std::max(size, 2 * capacity_));
    size_ = size;
  }
  void reserve(std::size_t capacity) {
    if (capacity <= capacity_) return;
    memory_ = LargePages<T>().grow(memory_, capacity_, capacity);
    if (!LargePages<T>::begin_as_zeros(capacity))
      std::memset(static_cast<void*>(memory_ + capacity_), 0, (capacity - capacity_) * sizeof(T));
    capacity_ = capacity;
  }

  [[nodiscard]] T* data() noexcept { return memory_; }
  [[nodiscard]] const T* data() const noexcept { return memory_; }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] T* begin() noexcept { return memory_; }
  [[nodiscard]] const T* begin() const noexcept { return memory_; }
  [[nodiscard]] T* end() noexcept { return memory_ + size_; }
  [[nodiscard]] const T* end() const noexcept { return memory_ + size_; }
  T& operator[](std::size_t i) noexcept { return memory_[i]; }
  const T& operator[](std::size_t i) const noexcept { return memory_[i]; }

private:
  void swap(UnwrittenVector& other) noexcept {
    std::swap(memory_, other.memory_), std::swap(size_, other.size_), std::swap(capacity_, other.capacity_);
  }

  T* memory_ = nullptr;
  std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace sightline::geometry
