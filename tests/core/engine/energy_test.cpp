// Energy closure: wall work and supplied energy, minus the dose, equal the change
// of kinetic and potential energy.
#include <gtest/gtest.h>

#include "run/run_statistics.hpp"
#include "spex_case.hpp"

namespace edmill::engine {
namespace {

template <class Real> Real relative_closure(const casefile::CaseSpec& spec, const Real& seconds) {
  const auto built = casefile::build_case<Real>(spec);
  Simulation<Real> simulation(built.the_case, built.states, built.start);
  run::RunStatistics<Real> statistics(model::partners_of(built.the_case.mill.vessel));
  simulation.attach(statistics);
  const auto before = simulation.energy_at(simulation.now());
  EXPECT_EQ(simulation.run_until(simulation.clock().at(seconds)), EndReason::end_time);
  const auto after = simulation.energy_at(simulation.now());
  const Real change = (after.kinetic + after.potential) - (before.kinetic + before.potential);
  EXPECT_GT(statistics.milling_dose(), 0);
  const Real closure =
      (statistics.wall_work() - statistics.milling_dose() + statistics.supplied_energy() - change) /
      statistics.milling_dose();
  return closure < 0 ? Real(-closure) : closure;
}

TEST(EnergyClosure, DemoCaseInDoubleOverFiveSeconds) {
  const double closure = relative_closure<double>(testing::demo_spec(), 5);
  RecordProperty("closure", std::to_string(closure));
  std::cout << "relative closure, double, 5 s: " << closure << "\n";
  EXPECT_LT(closure, 1e-10);
}

TEST(EnergyClosure, DemoCaseInFloat128) {
  const float128 closure = relative_closure<float128>(testing::demo_spec(), float128(1) / 5);
  std::cout << "relative closure, float128, 0.2 s: " << closure << "\n";
  EXPECT_LT(closure, float128("1e-28"));
}

TEST(EnergyClosure, ElasticBallsInAStillVesselKeepTheirEnergy) {
  // Rough spheres (e_t = -1) without gravity: no wall work, no dose, energy constant to rounding.
  const auto spec = casefile::parse_case(
      "[run]\nend_time = \"2 s\"\n[mill]\ntype = \"still\"\n[vessel]\ndiameter = \"38 mm\"\nheight "
      "= \"57 "
      "mm\"\n"
      "[contact]\nmodel = \"constant\"\nrestitution_normal = 1\nrestitution_tangential = -1\n"
      "least_separation = \"0 m/s\"\n"
      "[[balls]]\ncount = 30\ndiameter = \"4.76 mm\"\nrandom_speed = \"3 m/s\"\n",
      "elastic.toml");
  const auto built = casefile::build_case<double>(spec);
  Simulation<double> simulation(built.the_case, built.states, built.start);
  run::RunStatistics<double> statistics(model::partners_of(built.the_case.mill.vessel));
  simulation.attach(statistics);
  const double before = simulation.energy_at(simulation.now()).kinetic;
  simulation.run_until(simulation.clock().at(2.0));
  EXPECT_GT(statistics.collisions(), 4000u);
  EXPECT_EQ(statistics.wall_work(), 0);
  EXPECT_NEAR(simulation.energy_at(simulation.now()).kinetic / before, 1, 1e-12);
  EXPECT_NEAR(statistics.milling_dose() / before, 0, 1e-12);
}

}  // namespace
}  // namespace edmill::engine
