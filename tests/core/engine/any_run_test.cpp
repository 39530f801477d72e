// What holds for runs in every motion and every vessel: no ball leaves it, the energy closes, a
// checkpoint goes on with the same bits, and wider scalars agree.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <tuple>

#include "any_mills.hpp"
#include "event_recorder.hpp"
#include "mill_parts.hpp"
#include "run/run_statistics.hpp"

namespace edmill::engine {
namespace {

/// After every impact, the deepest overlap of the impact's balls with any wall, in float128, and of
/// all balls every thousandth time.
class WallCheck : public Observer<double> {
 public:
  explicit WallCheck(const model::Mill<double>& mill) : mill_(model::mill_cast<float128>(mill)) {}

  void on_impact(const Impact<double>& impact, Simulation<double>& simulation) override {
    if (events++ % 1000 == 0)
      for (int i = 0; i < simulation.ball_count(); ++i) look_at(simulation, impact.time, i);
    look_at(simulation, impact.time, impact.ball);
    if (!impact.with_wall) look_at(simulation, impact.time, impact.partner);
  }

  float128 deepest{0};
  std::uint64_t events = 0;
 private:
  void look_at(const Simulation<double>& simulation, const Instant<double>& time, int ball) {
    const auto now = dynamics::instant_cast<float128>(time);
    const auto flight = dynamics::flight_cast<float128>(simulation.flight(ball));
    const DriveClock<float128> clock(mill_.motion.period());
    const auto place =
        dynamics::position_after<float128>(flight, mill_.gravity, clock.elapsed(flight.start, now));
    const auto local = mill_.motion.position_in_vessel(mill_.motion.pose(now), place);
    const auto room = mill_.vessel.inset(float128(simulation.properties(ball).radius));
    const auto* pistons = mill_.vessel.pistons();
    for (int wall = 0; wall < room.wall_count(); ++wall) {
      const float128 moved = pistons ? pistons->of_wall(wall, now).value : float128(0);
      deepest = std::max(deepest, float128(room.overlap(wall, local) + moved));
    }
  }

  model::Mill<float128> mill_;
};

long wanted_collisions() {
  const char* text = std::getenv("EDMILL_ANY_COLLISIONS");
  return text ? std::atol(text) : 15000;
}

/// [s]; some mills are slow
double longest() { return std::max(4.0, 1e-4 * static_cast<double>(wanted_collisions())); }

class AnyRun : public ::testing::TestWithParam<testing::MillText> {
 protected:
  template <class Real>
  casefile::InitialCase<Real> built(
      double start = 0, const std::string& restitution = "0.53") const {
    const auto spec = testing::spec_of(GetParam(),
        "initial_time = \"" + std::to_string(start) + " s\"\nend_time = \"" +
            std::to_string(start + longest() + 1) + " s\"",
        "[[balls]]\ncount = 28\ndiameter = \"4.76 mm\"\n", restitution);
    auto mill = testing::mill_of(GetParam(), spec);
    return casefile::build_case_in<Real>(model::mill_cast<Real>(mill), spec);
  }
  /// A still vessel comes to rest: it is run for a time only.
  bool still() const { return !(testing::mill_of(GetParam()).motion.wall_speed(0) > 0); }
};
INSTANTIATE_TEST_SUITE_P(All, AnyRun, ::testing::ValuesIn(testing::all_mills),
    [](const auto& info) { return std::string(info.param.name); });

TEST_P(AnyRun, NoBallLeavesAndTheEnergyCloses) {
  for (const double start :
      {0.0, testing::slides(testing::mill_of(GetParam())) ? 10.0 : 123456.0}) {
    const auto the_case = built<double>(start, still() ? "1" : "0.53");
    Simulation<double> simulation(the_case.the_case, the_case.states, the_case.start);
    WallCheck check(the_case.the_case.mill);
    run::RunStatistics<double> statistics(model::partners_of(the_case.the_case.mill.vessel));
    simulation.attach(check);
    simulation.attach(statistics);
    const auto before = simulation.energy_at(simulation.now());
    const double begin = simulation.seconds();
    for (double step = 0;
         statistics.collisions() < static_cast<std::uint64_t>(wanted_collisions()) &&
         step < longest();
         step += 0.1)
      ASSERT_EQ(simulation.run_until(simulation.clock().at(begin + step)), EndReason::end_time);
    const auto after = simulation.energy_at(simulation.now());
    const double change = (after.kinetic + after.potential) - (before.kinetic + before.potential);
    const double left =
        statistics.wall_work() - statistics.milling_dose() + statistics.supplied_energy() - change;
    const double closure =
        std::abs(left) / (statistics.milling_dose() + before.kinetic + after.kinetic);
    std::cout << statistics.collisions() << " collisions from " << start
              << " s: deepest overlap with a wall " << static_cast<double>(check.deepest)
              << " m, closure " << closure << "\n";
    EXPECT_GT(statistics.collisions(), 1000u);
    EXPECT_LT(check.deepest, 1e-14);
    EXPECT_LT(closure, 1e-10);
  }
}

TEST_P(AnyRun, AWiderScalarMakesTheSameFirstImpacts) {
  const auto first = [&]<class Real>(Real) {
    const auto the_case = built<Real>();
    Simulation<Real> simulation(the_case.the_case, the_case.states, the_case.start);
    testing::EventRecorder<Real> log;
    simulation.attach(log);
    const bool slow = still() || testing::slides(testing::mill_of(GetParam()));
    const Real until = slow ? Real(1) / 4 : Real(1) / 20;
    EXPECT_EQ(simulation.run_until(simulation.clock().at(until)), EndReason::end_time);
    return log.impacts;
  };
  const auto narrow = first(double{});
  const auto wide = first(float128{});
  const auto widest = first(mpfr{});
  const std::size_t count = std::min({narrow.size(), wide.size(), widest.size(), std::size_t{60}});
  EXPECT_GT(count, 20u);
  for (std::size_t k = 0; k < count; ++k) {
    EXPECT_EQ(narrow[k].ball, widest[k].ball) << k;
    EXPECT_EQ(narrow[k].partner, widest[k].partner) << k;
    EXPECT_EQ(wide[k].ball, widest[k].ball) << k;
    EXPECT_EQ(wide[k].partner, widest[k].partner) << k;
  }
}

TEST_P(AnyRun, ACheckpointGoesOnWithTheSameBits) {
  const auto the_case = built<double>();
  Simulation<double> whole(the_case.the_case, the_case.states, the_case.start);
  whole.run_until(whole.clock().at(0.3));
  Archive save;
  whole.archive(save);
  Simulation<double> resumed(the_case.the_case, the_case.states, the_case.start);
  Archive load(save.bytes());
  resumed.archive(load);
  for (auto* simulation : {&whole, &resumed}) simulation->run_until(simulation->clock().at(0.6));
  ASSERT_EQ(whole.counts().impacts, resumed.counts().impacts);
  for (int ball = 0; ball < whole.ball_count(); ++ball) {
    EXPECT_EQ(whole.flight(ball).position, resumed.flight(ball).position);
    EXPECT_EQ(whole.flight(ball).velocity, resumed.flight(ball).velocity);
  }
}

/// Galilei: in a vessel that moves at constant speed balls that have that speed more make the same
/// impacts.
TEST(SlidingBox, SeesTheImpactsOfABoxAtRest) {
  const auto impacts = [](const std::string& mill, const Vec3<float128>& speed) {
    const testing::MillText text{"box", mill.c_str(),
        "type = \"box\"\nsize = [\"33 mm\", \"57 mm\", \"36 mm\"]", "gravity = \"9.8 m/s2\""};
    const auto spec = testing::spec_of(text, "end_time = \"1 s\"",
        "[[balls]]\ncount = 5\ndiameter = \"8 mm\"\nrandom_speed = \"2 m/s\"\n");
    auto built = casefile::build_case_in<float128>(casefile::build_mill<float128>(spec), spec);
    for (auto& state : built.states) state.velocity += speed;
    Simulation<float128> simulation(built.the_case, built.states, built.start);
    testing::EventRecorder<float128> log;
    simulation.attach(log);
    simulation.run_until(simulation.clock().at(float128(1) / 4));
    std::vector<std::tuple<int, int, float128>> list;
    for (const auto& impact : log.impacts)
      list.emplace_back(impact.ball, impact.partner, simulation.clock().seconds(impact.time));
    return list;
  };
  const auto at_rest =
      impacts("type = \"chain\"\n[[mill.joint]]\ntranslate = \"x\"\ndistance = \"1 cm\"",
          Vec3<float128>::Zero());
  const auto sliding =
      impacts("type = \"chain\"\n[[mill.joint]]\ntranslate = [2, -1, 2]\nspeed = \"-1.5 m/s\"",
          {-1, 0.5, -1});
  ASSERT_GT(at_rest.size(), 20u);
  for (std::size_t k = 0; k < 20; ++k) {
    const auto& [ball, partner, time] = at_rest[k];
    EXPECT_EQ(std::get<0>(sliding[k]), ball);
    EXPECT_EQ(std::get<1>(sliding[k]), partner);
    EXPECT_LT(std::abs(static_cast<double>(std::get<2>(sliding[k]) - time)), 1e-20);
  }
}

}  // namespace
}  // namespace edmill::engine
