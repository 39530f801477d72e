// A search that does not end obeys the flag of interruption, and the run goes on from there as if
// nothing had been.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "base/interruption.hpp"
#include "casefile/build_case.hpp"
#include "core.hpp"
#include "spex_case.hpp"

namespace edmill::engine {
namespace {

template <class Real> struct Times : Observer<Real> {
  std::vector<std::pair<double, int>> impacts;
  void on_impact(const Impact<Real>& impact, Simulation<Real>& s) override {
    impacts.emplace_back(static_cast<double>(s.seconds()), impact.ball);
  }
};

class InterruptedSearch : public ::testing::Test {
 protected:
  casefile::InitialCase<double> built = casefile::build_case<double>(casefile::parse_case(
      testing::spex_text("end_time = \"1 s\"", "restitution = 0.5", testing::batch(12, "6 mm")),
      "search.toml"));
  dynamics::AnyWallSearch<double> walls{built.the_case.mill};
  std::atomic<bool> flag{false};

  /// Searches walls, but does not end the search of this number, counted from 0.
  void stop_at(Simulation<double>& simulation, int& searches, int number, bool sets_flag) {
    simulation.replace_wall_search([&, number, sets_flag](const auto& pose, const auto& query) {
      if (searches++ == number) {
        if (sets_flag) flag = true;
        for (;;) Interruption::check();
      }
      return walls.search(pose, query);
    });
  }
};

TEST_F(InterruptedSearch, EndsTheRunWithinASecond) {
  Simulation<double> simulation(built.the_case, built.states, built.start);
  int searches = 0;
  stop_at(simulation, searches, 100, false);
  std::chrono::steady_clock::time_point asked;
  std::thread user([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    asked = std::chrono::steady_clock::now();
    flag = true;
  });
  EXPECT_EQ(simulation.run_until(simulation.clock().at(1.0), &flag), EndReason::interrupted);
  user.join();
  EXPECT_EQ(searches, 101);
  EXPECT_LT(std::chrono::steady_clock::now() - asked, std::chrono::seconds(1));
}

TEST_F(InterruptedSearch, LosesNothingOfTheRun) {
  const double end = 0.06;
  int searches = 0;
  Times<double> expected;
  Simulation<double> undisturbed(built.the_case, built.states, built.start);
  stop_at(undisturbed, searches, -1, false);
  undisturbed.attach(expected);
  undisturbed.run_until(undisturbed.clock().at(end));
  const int all = searches;
  ASSERT_GT(expected.impacts.size(), 50u);
  int interrupted = 0;
  for (int number = 0; number < all; number += 1 + all / 400) {
    searches = 0, flag = false;
    Times<double> found;
    Simulation<double> simulation(built.the_case, built.states, built.start);
    stop_at(simulation, searches, number, true);
    simulation.attach(found);
    auto reason = EndReason::interrupted;
    for (int starts = 0; reason == EndReason::interrupted && starts < 3; ++starts) {
      reason = simulation.run_until(simulation.clock().at(end), &flag);
      interrupted += reason == EndReason::interrupted;
      flag = false;
    }
    ASSERT_EQ(reason, EndReason::end_time);
    ASSERT_EQ(found.impacts, expected.impacts) << "search " << number;
  }
  EXPECT_GT(interrupted, 100);
}

}  // namespace
}  // namespace edmill::engine
