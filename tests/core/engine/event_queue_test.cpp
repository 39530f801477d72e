// The queue gives the earliest entry, ties to the lower ball, whatever was set before.
#include "engine/event_queue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "casefile/random.hpp"

namespace edmill::engine {
namespace {

TEST(EventQueue, TopIsTheEarliestAndKnowsWhetherAnotherIsDue) {
  casefile::Random random(11);
  for (const int balls : {1, 2, 3, 7, 28, 100}) {
    EventQueue<double> queue(balls, 1.0);
    std::vector<Instant<double>> times(balls, Instant<double>::never());
    for (int step = 0; step < 5000; ++step) {
      const int ball = static_cast<int>(random.uniform<double>() * balls);
      // Few distinct times, so that ties are common.
      times[ball] = {static_cast<std::int64_t>(random.uniform<double>() * 3),
          0.25 * static_cast<int>(random.uniform<double>() * 4)};
      queue.set(ball, times[ball]);
      std::vector<int> order(balls);
      for (int k = 0; k < balls; ++k) order[k] = k;
      std::stable_sort(
          order.begin(), order.end(), [&](int a, int b) { return times[a] < times[b]; });
      const Instant<double> limit{static_cast<std::int64_t>(random.uniform<double>() * 3), 0.5};
      ASSERT_EQ(queue.top(), order[0]);
      ASSERT_EQ(queue.has_more_until(limit), balls > 1 && times[order[1]] <= limit);
    }
  }
}

/// No event for many years of the calendar, with short days and with long days.
TEST(EventQueue, LongGapsAreCrossed) {
  constexpr int balls = 7;
  EventQueue<double> queue(balls, 1.0);
  std::int64_t period = 0;
  for (const std::int64_t gap : {100000, 1, 3000000, 1, 1}) {
    for (int step = 0; step < 1000; ++step) {
      // One event after the other, in the order of the balls.
      if (step % balls == 0) period += gap;
      for (int ball = 0; ball < balls; ++ball)
        queue.set(ball, {period, 0.1 * ((ball + step) % balls)});
      ASSERT_EQ(queue.top(), (balls - step % balls) % balls);
      ASSERT_EQ(queue.time(queue.top()), (Instant<double>{period, 0.0}));
      period += 1;
    }
  }
}

/// Many balls, with some events beyond the horizon, some beyond all weeks, and some that never
/// come.
TEST(EventQueue, WhatIsPutOffComesInItsOrder) {
  casefile::Random random(13);
  for (const int balls : {40, 3000, 40000}) {
    EventQueue<double> queue(balls, 1.0);
    std::vector<Instant<double>> times(balls, Instant<double>::never());
    std::set<std::pair<Instant<double>, int>> order;
    for (int ball = 0; ball < balls; ++ball) order.emplace(times[ball], ball);
    const auto set = [&](int ball, const Instant<double>& now) {
      const double draw = random.uniform<double>();
      double later = -std::log(1 - random.uniform<double>());
      if (draw < 0.05) later *= 100;
      if (draw < 0.01) later *= 10000;
      const double whole = std::floor(now.offset + later);
      order.erase({times[ball], ball});
      times[ball] = draw > 0.99 ? Instant<double>::never()
                                : Instant<double>{now.period + static_cast<std::int64_t>(whole),
                                      now.offset + later - whole};
      order.emplace(times[ball], ball);
      queue.set(ball, times[ball]);
    };
    for (int ball = 0; ball < balls; ++ball) set(ball, {0, 0.0});
    for (int step = 0; step < 200000; ++step) {
      const int top = queue.top();
      ASSERT_EQ(top, order.begin()->second) << balls << " balls, step " << step;
      const auto now = times[top];
      if (!(now < Instant<double>::never())) break;
      set(top, now);
      set(static_cast<int>(random.uniform<double>() * balls), now);
    }
    // Only slow balls are left: the intervals between their events are long.
    while (order.begin()->first < Instant<double>::never()) {
      const int top = queue.top();
      ASSERT_EQ(top, order.begin()->second) << balls << " balls, emptied";
      order.erase(order.begin());
      order.emplace(times[top] = Instant<double>::never(), top);
      queue.set(top, times[top]);
    }
  }
}

TEST(EventQueue, WhatIsSaidToBeUpcomingMostlyIs) {
  constexpr int balls = 2000, steps = 5000;
  casefile::Random random(12);
  EventQueue<double> queue(balls, 1.0);
  const auto later = [&](double now) {
    const double time = now + random.uniform<double>();
    return Instant<double>{static_cast<std::int64_t>(time), time - std::floor(time)};
  };
  for (int ball = 0; ball < balls; ++ball) queue.set(ball, later(0));
  std::array<std::array<int, 3>, steps> said;
  std::array<int, steps> top;
  for (int step = 0; step < steps; ++step) {
    top[step] = queue.top();
    said[step] = queue.upcoming();
    const auto time = queue.time(top[step]);
    queue.set(top[step], later(static_cast<double>(time.period) + time.offset));
  }
  int next = 0, second = 0, third = 0;
  for (int step = steps / 2; step + 3 < steps; ++step) {
    next += said[step][0] == top[step + 1];
    second += said[step][1] == top[step + 2];
    third += said[step][2] == top[step + 3];
  }
  // A shorter one would not be useful.
  EXPECT_GT(next, steps / 4);
  EXPECT_GT(second, steps / 4);
  EXPECT_GT(third, steps / 6);
}

}  // namespace
}  // namespace edmill::engine
