// Digits and horizons of made-up sequences whose differences are known.
#include <gtest/gtest.h>

#include "app/certify.hpp"

namespace edmill::app {
namespace {

using run::Event;
using run::Number;

Event event(int ball, bool with_wall, int partner, const Number& time, const Number& speed) {
  return {.ball = ball,
      .with_wall = with_wall,
      .partner = partner,
      .time = time,
      .approach_speed = speed};
}

TEST(Agreement, DigitsAreOfTheLargestDifferenceOverTheLargestSize) {
  Agreement agreement;
  EXPECT_TRUE(agreement.take(event(0, true, 2, 1, 4), event(0, true, 2, 1, 4)));
  EXPECT_EQ(agreement.least_digits(), Agreement::most);
  EXPECT_TRUE(agreement.take(event(1, false, 3, Number(2), Number("1e-3")),
      event(1, false, 3, Number(2) + Number("2e-40"), Number("1.004e-3"))));
  EXPECT_NEAR(agreement.digits(model::time), 40, 1e-9);           // 2e-40 of 2 s
  EXPECT_NEAR(agreement.digits(model::approach_speed), 6, 1e-9);  // 4e-6 of 4 m/s
  EXPECT_NEAR(agreement.least_digits(), 6, 1e-9);
  EXPECT_EQ(agreement.digits(model::slip_speed), Agreement::most);
  EXPECT_EQ(agreement.bodies(), 3u);
}

TEST(Agreement, OtherBodiesEndTheCommonSequence) {
  Agreement agreement;
  const Event wall = event(1, true, 2, 1, 1);
  EXPECT_TRUE(agreement.take(wall, wall));
  EXPECT_FALSE(agreement.take(wall, event(1, true, 0, 1, 1)));
  EXPECT_FALSE(agreement.take(wall, event(0, true, 2, 1, 1)));
  EXPECT_FALSE(agreement.take(wall, event(1, false, 2, 1, 1)));
  EXPECT_EQ(agreement.events(), 1u);
}

TEST(Agreement, GrowthIsTheSlopeOfTheDigits) {
  Agreement agreement;
  Number difference("1e-30");
  for (int k = 0; k < 50; ++k, difference *= Number("1.7782794100389228"))  // 10^(1/4)
    agreement.take(event(0, true, 0, k + 1, 1), event(0, true, 0, Number(k + 1) + difference, 1));
  ASSERT_TRUE(agreement.digits_lost_per_event());
  EXPECT_NEAR(*agreement.digits_lost_per_event(), 0.25, 1e-9);
  EXPECT_FALSE(Agreement().digits_lost_per_event());
}

}  // namespace
}  // namespace edmill::app
