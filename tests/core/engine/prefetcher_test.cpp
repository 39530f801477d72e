// Prefetching changes no bit of a run.
#include "engine/prefetcher.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "casefile/case_spec.hpp"
#include "core.hpp"
#include "event_recorder.hpp"

namespace edmill::engine {
namespace {

/// Impacts of the first 20 ms, and all balls' states then.
struct Record {
  std::vector<Impact<double>> impacts;
  std::vector<model::BallState<double>> states;

  Record(const casefile::InitialCase<double>& built, bool prefetch) {
    Simulation<double> simulation(built.the_case, built.states, built.start);
    testing::EventRecorder<double> recorder;
    simulation.attach(recorder);
    simulation.prefetch(prefetch);
    const auto end = simulation.clock().at(0.02);
    EXPECT_EQ(simulation.run_until(end), EndReason::end_time);
    impacts = recorder.impacts;
    for (int i = 0; i < simulation.ball_count(); ++i) states.push_back(simulation.state_at(i, end));
  }
};

TEST(Prefetcher, ChangesNoBitOfARunOf2000Balls) {
  const auto spec = casefile::read_case(EDMILL_SOURCE_DIR "/docs/examples/demo.toml",
      {"balls.0.count=2000", "balls.0.diameter=2.36 mm", "balls.0.gap_ball=0.2 mm",
          "contact.restitution=0.8"});
  const auto built = casefile::build_case<double>(spec);
  ASSERT_GT(spec.ball_count(), static_cast<std::size_t>(Prefetcher<double>::worthwhile));
  const Record with(built, true), without(built, false);
  ASSERT_EQ(with.impacts.size(), without.impacts.size());
  EXPECT_GT(with.impacts.size(), 10000u);
  for (std::size_t k = 0; k < with.impacts.size(); ++k) {
    const auto &a = with.impacts[k], &b = without.impacts[k];
    ASSERT_TRUE(a.time == b.time && a.ball == b.ball && a.partner == b.partner) << "impact " << k;
  }
  for (std::size_t i = 0; i < with.states.size(); ++i) {
    ASSERT_EQ(with.states[i].position, without.states[i].position) << "ball " << i;
    ASSERT_EQ(with.states[i].velocity, without.states[i].velocity) << "ball " << i;
    ASSERT_EQ(with.states[i].spin, without.states[i].spin) << "ball " << i;
  }
}

}  // namespace
}  // namespace edmill::engine
