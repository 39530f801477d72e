// A saved state that somebody has changed is refused, or the run goes on with it: nothing else
// happens.
#include <gtest/gtest.h>

#include <cstring>
#include <iostream>
#include <limits>
#include <random>

#include "base/errors.hpp"
#include "event_recorder.hpp"
#include "spex_case.hpp"

namespace edmill::engine {
namespace {

struct Stop : Observer<double> {
  int left = 100;
  void on_impact(const Impact<double>&, Simulation<double>& simulation) override {
    if (--left <= 0) simulation.request_stop(EndReason::stopped);
  }
};

/// One to three changes: bits, bytes, whole numbers, or a part that is left out.
std::string changed(std::string bytes, std::mt19937_64& random) {
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  for (std::size_t k = 1 + below(3); k > 0; --k) {
    const std::size_t at = below(bytes.size() - 8);
    const double numbers[] = {
        0, -1, 1e300, -1e300, std::numeric_limits<double>::quiet_NaN(), 1e-9, 1e12, 3};
    const std::int64_t integers[] = {0, -1, 1, 1 << 20, std::numeric_limits<std::int64_t>::max(),
        std::numeric_limits<std::int64_t>::min()};
    switch (below(6)) {
      case 0: bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8))); break;
      case 1: bytes[at] = static_cast<char>(random()); break;
      case 2: std::memcpy(&bytes[at], &numbers[below(8)], 8); break;
      case 3: std::memcpy(&bytes[at], &integers[below(6)], 8); break;
      case 4: std::memcpy(&bytes[at], &bytes[below(bytes.size() - 8)], 8); break;
      default:
        if (below(10) == 0) bytes.erase(at, 1 + below(8));
    }
  }
  return bytes;
}

void try_changes(const std::string& text, const char* name, int rounds) {
  const auto spec = casefile::parse_case(text, name);
  const auto built = casefile::build_case<double>(spec);
  Archive saved;
  {
    Simulation<double> simulation(built.the_case, built.states, built.start);
    simulation.run_until(simulation.clock().at(0.05));
    saved(simulation);
  }
  std::mt19937_64 random(20110101);
  std::cout << "seed 20110101\n";
  int refused = 0, went_on = 0, contradicted = 0;
  for (int round = 0; round < rounds; ++round) {
    const auto bytes = changed(saved.bytes(), random);
    Simulation<double> simulation(built.the_case, built.states, built.start);
    Stop stop;
    simulation.attach(stop);
    try {
      Archive loaded(bytes);
      loaded(simulation);
      loaded.finish();
      simulation.run_until(simulation.clock().after(simulation.now(), 0.01));
      ++went_on;
    } catch (const InputError&) {
      ++refused;
    } catch (const ContractError&) {
      ++contradicted;
    } catch (const UndecidedError&) {
      ++contradicted;
    }
  }
  std::cout << name << ": " << rounds << " changes, " << refused << " refused, " << contradicted
            << " contradictions found later, " << went_on << " runs\n";
  EXPECT_GT(refused, rounds / 20);
  EXPECT_GT(went_on, rounds / 20);
}

const std::string demo =
    testing::spex_text("end_time = \"1 s\"", "restitution = 0.6", testing::batch(12, "6 mm", ""));
const std::string crowd =
    testing::spex_text("end_time = \"1 s\"", "restitution = 0.6\nleast_separation = \"0 m/s\"",
        testing::batch(150, "2 mm",
            "gap_ball = \"0.1 mm\"\ngap_wall = \"0.1 mm\"\nrandom_speed = \"1 m/s\"\n"));

TEST(SavedState, ChangedByOthers) { try_changes(demo, "demo.toml", 3000); }
TEST(SavedState, ChangedByOthersOfManyBalls) { try_changes(crowd, "crowd.toml", 2000); }
TEST(SavedState, ChangedByOthersLong) {
  try_changes(demo, "demo.toml", 300000);
  try_changes(crowd, "crowd.toml", 100000);
}

TEST(SavedState, AWrongNumberOfElementsAsksForNoMemory) {
  std::uint64_t many = 1ull << 40;
  Archive save;
  save(many);
  Archive load(save.bytes());
  std::vector<std::array<double, 64>> values;
  EXPECT_THROW(load(values), InputError);
  EXPECT_LT(values.capacity(), 1000u);
}

}  // namespace
}  // namespace edmill::engine
