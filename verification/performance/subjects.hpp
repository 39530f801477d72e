// What the benchmarks run: cases of edmill past their transient.
#pragma once

#include <benchmark/benchmark.h>

#include <string>

#include "spex_case.hpp"

namespace edmill::performance {

/// Bytes of this process that are in memory.
double resident_bytes();
/// Hands freed memory back, so that what is built next shows up in `resident_bytes`.
void settle_memory();

/// One of the cases in the shaking vial of the SPEX.
struct SpexSubject {
  const char* name;
  int balls;
  const char* diameter;
  const char* restitution;
  const char* gaps;
  double packing;
  int steps;  ///< of a hundredth of a second, which hold some 600 000 collisions
};
inline constexpr SpexSubject demo{"28x4.76mm", 28, "4.76 mm", "0.53", "", 0.0245, 3500};
inline constexpr SpexSubject spex_subjects[] = {
    demo,
    {"111x4.76mm", 111, "4.76 mm", "0.64", "", 0.0970, 600},
    {"363x2.36mm", 363, "2.36 mm", "0.80", "", 0.0386, 260},
    {"908x2.36mm", 908, "2.36 mm", "0.80", "gap_ball = \"0.2 mm\"", 0.0967, 45},
};

/// Its text, without an end.
std::string spex_text(const SpexSubject& subject);

/// Elastic smooth balls of 4.76 mm without gravity in a still vessel of the SPEX vial's shape, from
/// a close-packed lattice stretched over the vessel, at random velocities of up to 1 m/s.
/// @throws std::invalid_argument when the lattice does not fit at this packing
casefile::InitialCase<double> still_gas(int balls, double packing);

/// Makes the wall search of runs in double in place of the program's own, when it is set.
using WallPolicy = dynamics::AnyWallSearch<double>::Policy (*)(const model::Mill<double>&);
inline WallPolicy wall_policy = nullptr;

/// A simulation after this number of collisions, advanced in short intervals of time.
template <class Real> class Run {
 public:
  explicit Run(const casefile::InitialCase<Real>& built)
      : simulation_(built.the_case, built.states, built.start) {
    if constexpr (std::is_same_v<Real, double>)
      if (wall_policy) simulation_.replace_wall_search(wall_policy(built.the_case.mill));
    end_ = simulation_.seconds();
  }

  engine::Simulation<Real>& simulation() { return simulation_; }
  void until(const Real& seconds) {
    end_ = seconds;
    simulation_.run_until(simulation_.clock().at(end_));
  }
  /// At least this number of further collisions, in intervals of `step` [s].
  void collisions(std::uint64_t count, const Real& step) {
    const auto target = simulation_.counts().impacts + count;
    while (simulation_.counts().impacts < target) until(end_ + step);
  }
 private:
  engine::Simulation<Real> simulation_;
  Real end_{0};
};

/// Counters of a throughput: collisions per CPU second, and CPU nanoseconds for each.
inline void count_collisions(benchmark::State& state, std::uint64_t collisions) {
  const auto number = static_cast<double>(collisions);
  state.counters["collisions"] = benchmark::Counter(number, benchmark::Counter::kIsRate);
  state.counters["ns"] =
      benchmark::Counter(number * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void register_spex();
void register_still_gas();
void register_operations();
void register_wall_answers();

}  // namespace edmill::performance
