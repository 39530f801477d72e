// An archive loads what it has saved, in every scalar, to the last bit.
#include "base/archive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core.hpp"

namespace edmill {
namespace {

template <class T> T again(T value) {
  Archive saved;
  saved(value);
  Archive loading(saved.bytes());
  T loaded{};
  loading(loaded);
  loading.finish();
  return loaded;
}

template <class Real> class ArchiveOf : public ::testing::Test {};
using Scalars = ::testing::Types<double, float128, mpfr>;
TYPED_TEST_SUITE(ArchiveOf, Scalars);

TYPED_TEST(ArchiveOf, KeepsEveryBitOfAScalar) {
  using Real = TypeParam;
  using std::isinf, std::isnan, std::signbit;
  // The last digit of each is rounded.
  for (const Real& value : {Real(Real(1) / 3), Real(-Real(2) / 7), from_text<Real>("1.1e-200"),
           Real(from_text<Real>("1e300") / 3), Real(0), Real(1 + epsilon<Real>())})
    EXPECT_TRUE(again(value) == value) << value;
  EXPECT_TRUE(signbit(again(Real(-Real(0)))));
  EXPECT_TRUE(isinf(again(Real(std::numeric_limits<Real>::infinity()))));
  EXPECT_TRUE(isnan(again(Real(std::numeric_limits<Real>::quiet_NaN()))));
}

TEST(Archive, KeepsContainers) {
  const std::vector<std::pair<int, std::string>> list{
      {1, "a"}, {2, ""}, {3, std::string("\0x", 2)}};
  EXPECT_EQ(again(list), list);
  EXPECT_EQ(again(std::optional<double>(2.5)), std::optional<double>(2.5));
  EXPECT_EQ(again(std::optional<double>()), std::nullopt);
  const std::array<bool, 3> flags{true, false, true};
  EXPECT_EQ(again(flags), flags);
}

TEST(Archive, RefusesBytesThatAreTooFewOrTooMany) {
  Archive saved;
  std::vector<double> numbers{1, 2, 3};
  saved(numbers);
  for (std::size_t size = 0; size < saved.bytes().size(); ++size) {
    const std::string part = saved.bytes().substr(0, size);
    Archive loading(part);
    EXPECT_THROW(loading(numbers), InputError) << size;
  }
  const std::string more = saved.bytes() + "x";
  Archive loading(more);
  loading(numbers);
  EXPECT_THROW(loading.finish(), InputError);
}

}  // namespace
}  // namespace edmill
