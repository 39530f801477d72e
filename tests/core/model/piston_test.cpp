// Where pistons stand long after they began.
#include "model/vessels/piston.hpp"

#include <gtest/gtest.h>

#include "base/scalar_list.hpp"
#include "base/wide_trigonometry.hpp"

namespace edmill::model {
namespace {

/// In a scalar of 50 digits from the same numbers.
TEST(Pistons, RoundingIsBoundedLongAfterTheStart) {
  const double period = 0.0569;
  const Pistons<double> pistons({{0, -999999.995, 1, {}}}, period);
  const auto wide = pistons.cast<mpfr50>();
  const double extent = 0.0475, bound = pistons.errors(0, epsilon<double>() / 2, extent).value;
  EXPECT_LT(bound, 1e-8);
  double worst = 0;
  for (int k = 0; k < 1000; ++k) {
    const std::int64_t count = 17574692 + k / 100;
    const double offset = period * (k % 100) / 100;
    const mpfr50 exact = wide.at(0, Instant<mpfr50>{count, mpfr50(offset)}).value;
    worst = std::max(
        worst, std::abs(static_cast<double>(exact - mpfr50(pistons.at(0, {count, offset}).value))));
  }
  EXPECT_LE(worst, bound);
  EXPECT_GT(worst, 32 * extent * epsilon<double>());  // more than the vessel's size tells
}

}  // namespace
}  // namespace edmill::model
