// Throughput of the simulation, in collisions per CPU second of one thread.
#include <benchmark/benchmark.h>

#include "spex_case.hpp"

namespace edmill {
namespace {

/// A SPEX case past its transient, run on for a hundredth of a second at a time.
template <class Real>
void spex(benchmark::State& state, int balls, const char* diameter, const char* restitution,
          const char* more) {
  const auto spec = casefile::parse_case(
      testing::spex_text("end_time = \"1 s\"", std::string("restitution = ") + restitution,
                         testing::batch(balls, diameter, more)),
      "bench.toml");
  const auto built = setup::build_case<Real>(spec);
  engine::Simulation<Real> simulation(built.the_case, built.states, built.start);
  Real end = Real(1) / (std::is_same_v<Real, double> ? 2 : 20);
  simulation.run_until(simulation.clock().at(end));
  const auto before = simulation.counts().impacts;
  for (auto _ : state) {
    end += Real(1) / (std::is_same_v<Real, double> ? 100 : 1000);
    simulation.run_until(simulation.clock().at(end));
  }
  state.counters["collisions"] = benchmark::Counter(static_cast<double>(simulation.counts().impacts - before),
                                                    benchmark::Counter::kIsRate);
}

constexpr auto spex_double = spex<double>;
constexpr auto spex_float128 = spex<float128>;
constexpr auto spex_mpfr50 = spex<mpfr50>;

BENCHMARK_CAPTURE(spex_double, demo_28_x_4_76mm, 28, "4.76 mm", "0.53", "");
BENCHMARK_CAPTURE(spex_double, 111_x_4_76mm, 111, "4.76 mm", "0.64", "");
BENCHMARK_CAPTURE(spex_double, 363_x_2_36mm, 363, "2.36 mm", "0.80", "");
BENCHMARK_CAPTURE(spex_double, 908_x_2_36mm, 908, "2.36 mm", "0.80", "gap_ball = \"0.2 mm\"");
BENCHMARK_CAPTURE(spex_float128, demo_28_x_4_76mm, 28, "4.76 mm", "0.53", "");
BENCHMARK_CAPTURE(spex_mpfr50, demo_28_x_4_76mm, 28, "4.76 mm", "0.53", "");

}  // namespace
}  // namespace edmill

BENCHMARK_MAIN();
