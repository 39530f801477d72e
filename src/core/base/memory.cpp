#include "base/memory.hpp"

#include <cstdlib>
#include <new>
#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace edmill {

void* allocate_pages(std::size_t size) {
  const std::size_t whole = (size + large_page - 1) / large_page * large_page;
  void* start = std::aligned_alloc(large_page, whole);
  if (start == nullptr) throw std::bad_alloc();
#if defined(__linux__)
  madvise(start, whole, MADV_HUGEPAGE);  // only a hint: without it small pages are used
#endif
  return start;
}

}  // namespace edmill
