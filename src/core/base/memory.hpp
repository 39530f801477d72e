// Prefetching, and allocation of large arrays in large pages.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <vector>

namespace edmill {

/// Prefetches the cache line at `address`, which need not be valid.
inline void fetch(const void* address) {
  __builtin_prefetch(address);
  // Without this, compilers drop calls of a function that only prefetches.
  asm volatile("");
}

inline constexpr std::size_t large_page = std::size_t{1} << 21;  ///< [bytes]

/// @return at least `size` bytes, aligned to a large page, for std::free. @throws std::bad_alloc
void* allocate_pages(std::size_t size);

/// Puts large arrays into large pages, where the system has them: an event among many balls
/// accesses dozens of small pages, each of which needs an address translation.
template <class T> struct LargePages {
  using value_type = T;

  LargePages() = default;
  template <class Other> LargePages(const LargePages<Other>&) {}

  T* allocate(std::size_t count) {
    if (!is_large(count)) return std::allocator<T>().allocate(count);
    return static_cast<T*>(allocate_pages(count * sizeof(T)));
  }
  void deallocate(T* array, std::size_t count) {
    if (!is_large(count)) return std::allocator<T>().deallocate(array, count);
    std::free(array);
  }
  friend bool operator==(const LargePages&, const LargePages&) { return true; }
 private:
  static bool is_large(std::size_t count) { return count >= large_page / sizeof(T); }
};

template <class T> using LargeVector = std::vector<T, LargePages<T>>;

}  // namespace edmill
