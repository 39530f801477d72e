// Collisions per CPU second of one thread: edmill's cases, and the reference implementations at
// equal numbers.
#include <cmath>

#include "minimal_loop.hpp"
#include "peer_loop.hpp"
#include "subjects.hpp"

namespace edmill::performance {

namespace {

/// The throughput, and what the engine did for each collision.
template <class Real>
void count_work(benchmark::State& state, const engine::EngineCounts<Real>& before,
    const engine::EngineCounts<Real>& after) {
  const auto collisions = after.impacts - before.impacts;
  count_collisions(state, collisions);
  const auto each = [&](std::uint64_t from, std::uint64_t to) {
    return static_cast<double>(to - from) / static_cast<double>(collisions);
  };
  state.counters["crossings"] = each(before.cell_crossings, after.cell_crossings);
  state.counters["stale"] = each(before.stale_events, after.stale_events);
  state.counters["wall_searches"] = each(before.wall_searches, after.wall_searches);
}

/// The vial past its transient, run on by a hundredth of a second (wide scalars: a thousandth) at a
/// time.
template <class Real> void spex(benchmark::State& state, const SpexSubject& subject) {
  constexpr bool wide = !std::is_same_v<Real, double>;
  Run<Real> run(casefile::build_case<Real>(casefile::parse_case(spex_text(subject), "bench.toml")));
  Real end = Real(1) / (wide ? 20 : 2);
  run.until(end);
  const auto before = run.simulation().counts();
  for (auto _ : state) {
    end += Real(1) / (wide ? 1000 : 100);
    run.until(end);
  }
  count_work(state, before, run.simulation().counts());
}

/// Elastic balls after some collisions of each.
void still(benchmark::State& state, int balls, double packing) {
  const auto built = still_gas(balls, packing);
  settle_memory();
  const double bytes = resident_bytes();
  Run<double> run(built);
  const double built_bytes = resident_bytes() - bytes;
  // About one collision of each ball for a step: a free path is about d / (8.5 packing), the speed
  // 0.75 m/s.
  const double step = 0.00476 / (0.75 * 8.5 * packing) / std::max(1.0, balls / 1000.0);
  run.collisions(20 * static_cast<std::uint64_t>(balls) + 1000, step);
  const auto before = run.simulation().counts();
  for (auto _ : state) run.collisions(20000, step);
  count_work(state, before, run.simulation().counts());
  if (balls >= 10000) state.counters["bytes_per_ball"] = built_bytes / balls;
}

/// A reference implementation.
template <class Loop>
void periodic(benchmark::State& state, int balls, double packing, bool in_order = true) {
  settle_memory();
  const double bytes = resident_bytes();
  Loop loop(balls, packing, 20110101, in_order);
  const double built_bytes = resident_bytes() - bytes;
  loop.run(20 * static_cast<std::uint64_t>(balls) + 1000);
  const auto before = loop.collisions(), crossings = loop.crossings(), stale = loop.stale_events();
  for (auto _ : state) loop.run(20000);
  const auto collisions = loop.collisions() - before;
  count_collisions(state, collisions);
  const auto each = [&](std::uint64_t count) {
    return static_cast<double>(count) / static_cast<double>(collisions);
  };
  state.counters["crossings"] = each(loop.crossings() - crossings);
  state.counters["stale"] = each(loop.stale_events() - stale);
  if (balls >= 10000) state.counters["bytes_per_ball"] = built_bytes / balls;
}

template <class Function> void add(const std::string& name, int iterations, Function function) {
  benchmark::RegisterBenchmark(name.c_str(), function)
      ->Iterations(iterations)
      ->Unit(benchmark::kMillisecond);
}

/// Each iteration is 20 000 collisions.
void add_reference_loops(const std::string& name, int balls, double packing, int iterations) {
  add("minimal/" + name, iterations,
      [=](benchmark::State& s) { periodic<MinimalLoop>(s, balls, packing); });
  add("peer/" + name, iterations,
      [=](benchmark::State& s) { periodic<PeerLoop>(s, balls, packing); });
}

std::string gas_name(double packing, int balls) {
  return "gas/packing_" + std::to_string(packing).substr(0, 4) + "/" + std::to_string(balls);
}

void add_gas(double packing, int balls) {
  const std::string name = gas_name(packing, balls);
  add("edmill/" + name, 10, [=](benchmark::State& s) { still(s, balls, packing); });
  // The reference implementations need a box of four balls a side.
  if (balls > 123 * packing) add_reference_loops(name, balls, packing, 10);
}

}  // namespace

void register_spex() {
  for (const auto& subject : spex_subjects) {
    const std::string name = std::string("spex/") + subject.name;
    add("edmill/" + name, subject.steps, [&](benchmark::State& s) { spex<double>(s, subject); });
    add_reference_loops(name, subject.balls, subject.packing, 30);
  }
  add("scalar/double/demo", 400, [](benchmark::State& s) { spex<double>(s, demo); });
  add("scalar/float128/demo", 200, [](benchmark::State& s) { spex<float128>(s, demo); });
  add("scalar/mpfr50/demo", 100, [](benchmark::State& s) { spex<mpfr>(s, demo); });
}

void register_still_gas() {
  for (const int balls : {1000, 10000, 100000}) {
    add_gas(0.26, balls);
    add("peer-any-order/" + gas_name(0.26, balls), 10,
        [=](benchmark::State& s) { periodic<PeerLoop>(s, balls, 0.26, false); });
  }
  for (const int balls : {1, 3, 10, 30, 100, 300, 1000, 3000, 10000, 30000, 100000})
    add_gas(0.10, balls);
  for (const double packing : {0.05, 0.15, 0.20, 0.25, 0.30, 0.35}) add_gas(packing, 1000);
}

}  // namespace edmill::performance
