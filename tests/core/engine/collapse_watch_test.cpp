// Collapse as seen in a ball's recent impacts, and its accumulation time.
#include <gtest/gtest.h>

#include "engine/watches.hpp"

namespace edmill::engine {
namespace {

constexpr double smallest_path = 1e-6, slow = 0.1;
const DriveClock<double> drive_clock(0.25);

/// Impacts of one ball, at given intervals [s] and approach speeds [m/s].
struct Ball {
  CollapseWatch<double> watch{smallest_path};
  RecentImpacts<double> recent;
  double time = 1;

  bool hits(int partner, double interval, double speed, double restitution = 0.5) {
    time += interval;
    return watch.note(recent, partner, drive_clock.at(time), speed, slow, restitution, drive_clock);
  }
  double accumulation_time() const {
    return CollapseWatch<double>::accumulation_time(recent, drive_clock);
  }
};

/// A ball that bounces on one partner: intervals and speeds halve, from 0.1 ms and 1 cm/s on.
double bounce(Ball& ball, int partner, int impacts) {
  double interval = 1e-4, speed = 1e-2;
  for (int k = 0; k < impacts; ++k, interval /= 2, speed /= 2)
    EXPECT_EQ(ball.hits(partner, interval, speed), k + 1 >= CollapseWatch<double>::enough) << k;
  return 2e-4;  // from before the first impact to the last of infinitely many
}

TEST(CollapseWatch, EightShortPathsInARowAreCollapse) {
  Ball ball;
  ball.hits(3, 1e-2, 1);
  const double begin = ball.time;
  const double whole = bounce(ball, 3, 20);
  EXPECT_NEAR(ball.accumulation_time(), begin + whole, 1e-15);
}

TEST(CollapseWatch, ALongPathEndsTheRow) {
  Ball ball;
  ball.hits(3, 1e-2, 1);
  for (int k = 0; k < 7; ++k) EXPECT_FALSE(ball.hits(3, 1e-4, 0.9e-2));
  EXPECT_FALSE(ball.hits(3, 1e-4, 1.1e-2));  // longer than the smallest path
  const double begin = ball.time;
  const double whole = bounce(ball, 3, 8);
  EXPECT_NEAR(ball.accumulation_time(), begin + whole, 1e-15) << "extrapolated from the row before";
}

TEST(CollapseWatch, TheTimeIsKnownOnlyWithOnePartner) {
  Ball alternating;
  for (int k = 0; k < 9; ++k) alternating.hits(k % 2, 1e-5, 1e-3);
  EXPECT_EQ(alternating.accumulation_time(), drive_clock.seconds(alternating.recent.last));

  Ball disturbed;  // another partner in the middle of the row
  disturbed.hits(3, 1e-2, 1);
  bounce(disturbed, 3, 5);
  EXPECT_GT(disturbed.accumulation_time(), disturbed.time);
  disturbed.hits(4, 1e-6, 1e-3);
  EXPECT_EQ(disturbed.accumulation_time(), drive_clock.seconds(disturbed.recent.last));
  for (int k = 0; k < 3; ++k) disturbed.hits(3, 1e-6, 1e-3);
  EXPECT_EQ(disturbed.accumulation_time(), drive_clock.seconds(disturbed.recent.last));

  Ball elastic;  // its intervals do not shrink, whatever the row before was
  elastic.hits(3, 1e-2, 1);
  bounce(elastic, 3, 5);
  elastic.hits(3, 1e-2, 1);
  for (int k = 0; k < 8; ++k) elastic.hits(3, 1e-5, 1e-3, 1);
  EXPECT_EQ(elastic.accumulation_time(), drive_clock.seconds(elastic.recent.last));
}

/// Bodies that touch have a sequence of impacts at one instant, which ends while they are fast.
TEST(CollapseWatch, FastImpactsWithoutTimeBetweenAreNone) {
  Ball ball;
  ball.hits(3, 1e-2, 1);
  for (int k = 0; k < 40000; ++k) ASSERT_FALSE(ball.hits(3 + k % 2, 0, 1.01 * slow)) << k;
  for (int k = 0; k < 40000; ++k)  // more than a count of two bytes holds
    ASSERT_EQ(ball.hits(3, 0, 0.99 * slow), k + 1 >= CollapseWatch<double>::enough) << k;
  EXPECT_FALSE(ball.hits(3, 1e-2, 1));
}

}  // namespace
}  // namespace edmill::engine
