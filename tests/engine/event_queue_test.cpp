// The queue gives the earliest entry, ties to the lower ball, whatever was set before.
#include "edmill/engine/event_queue.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "edmill/setup/random.hpp"

namespace edmill::engine {
namespace {

TEST(EventQueue, TopAndRunnerUpAreTheTwoEarliest) {
  setup::Random random(11);
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
      std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return times[a] < times[b]; });
      const Instant<double> limit{static_cast<std::int64_t>(random.uniform<double>() * 3), 0.5};
      ASSERT_EQ(queue.top(), order[0]);
      const int second = balls > 1 && !(times[order[1]] > limit) ? order[1] : -1;
      ASSERT_EQ(queue.runner_up(limit), second);
    }
  }
}

}  // namespace
}  // namespace edmill::engine
