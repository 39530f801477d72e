// Large vectors keep their content, and use large pages once they fill one.
#include "base/memory.hpp"

#include <gtest/gtest.h>

#include <cstdint>

namespace edmill {
namespace {

struct alignas(64) Line {
  std::uint64_t value;
};

std::uintptr_t place_in(std::size_t unit, const void* address) {
  return reinterpret_cast<std::uintptr_t>(address) % unit;
}

TEST(LargeVector, KeepsItsValuesAcrossTheSizeOfAPage) {
  LargeVector<Line> lines;
  const std::uint64_t in_a_page = large_page / sizeof(Line);
  for (std::uint64_t k = 0; k < 3 * in_a_page; ++k) {
    lines.push_back({k * k});
    ASSERT_EQ(place_in(alignof(Line), &lines.back()), 0u);
  }
  for (std::uint64_t k = 0; k < lines.size(); ++k) ASSERT_EQ(lines[k].value, k * k);
  lines.resize(10);
  lines.shrink_to_fit();
  for (std::uint64_t k = 0; k < 10; ++k) EXPECT_EQ(lines[k].value, k * k);
}

TEST(LargeVector, BeginsWithAPageWhenItFillsOne) {
  const LargeVector<double> whole(large_page / sizeof(double)),
      more(large_page / sizeof(double) + 1);
  EXPECT_EQ(place_in(large_page, whole.data()), 0u);
  EXPECT_EQ(place_in(large_page, more.data()), 0u);
}

TEST(LargePages, MoreThanThereIsIsRefused) {
  EXPECT_THROW(LargeVector<char>(std::size_t{1} << 62), std::bad_alloc);
}

}  // namespace
}  // namespace edmill
