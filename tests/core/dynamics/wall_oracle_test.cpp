// The certified ball-wall search against an independent solver on adversarial states, and the wide
// search that begins in double against the full one.
#include <gtest/gtest.h>

#include <iomanip>
#include <iostream>
#include <map>

#include "spex_case.hpp"
#include "wall_comparison.hpp"

namespace edmill::dynamics {
namespace {

TEST(WallSearch, AgreesWithAnIndependentSolverOnAdversarialStates) {
  constexpr std::uint64_t seed = 20110101;
  const long count = wanted_states();
  std::cout << "seed " << seed << ", " << count << " states\n";
  const auto mill = testing::spex_mill<double>();
  Comparison<double> compare(mill);
  const StateMaker make(mill, compare.longest_window());
  Draw draw(seed);
  std::map<std::string, Tally> tallies;
  for (long k = 0; k < count; ++k) {
    const Kind kind = all_kinds[k % std::size(all_kinds)];
    const bool turning = draw.chance(0.25);
    compare(make(draw, kind, turning), tallies[name(kind) + (turning ? ", drive turns" : "")]);
  }
  print(tallies);
  std::cout << "search " << compare.search_seconds << " s, oracle " << compare.oracle_seconds
            << " s\n";
  long bad = 0;
  for (const auto& [name, tally] : tallies) bad += tally.bad();
  EXPECT_EQ(bad, 0);
}

template <class Real> class WideWallOracle : public ::testing::Test {};
using WideScalars = ::testing::Types<float128, mpfr>;
TYPED_TEST_SUITE(WideWallOracle, WideScalars);

TYPED_TEST(WideWallOracle, AgreesWithAnIndependentSolver) {
  constexpr std::uint64_t seed = 20110104;
  const long count = wanted_states() / 10;
  std::cout << "seed " << seed << ", " << count << " states\n";
  const auto mill = testing::spex_mill<double>();
  Comparison<TypeParam> compare(mill);
  const StateMaker make(mill, compare.longest_window());
  Draw draw(seed);
  std::map<std::string, Tally> tallies;
  for (long k = 0; k < count; ++k) {
    const Kind kind = all_kinds[k % std::size(all_kinds)];
    compare(make(draw, kind, draw.chance(0.25)), tallies[name(kind)]);
  }
  print(tallies);
  long bad = 0;
  for (const auto& [name, tally] : tallies) bad += tally.bad();
  EXPECT_EQ(bad, 0);
  // Double must decide nearly all states that are not undecidable in it by construction.
  for (const auto kind : {Kind::near, Kind::seam, Kind::axis, Kind::anywhere})
    EXPECT_GT(tallies[name(kind)].by_double, tallies[name(kind)].states * 9 / 10) << name(kind);
}

/// States with digits below those of double, in a mill with such digits.
template <class Real> WallQuery<Real> with_more_digits(Draw& draw, const WallQuery<double>& q) {
  auto wide = widened<Real>(q);
  const auto more = [&](const Real& x) {
    return Real(x * (1 + Real(draw.symmetric()) * Real(0x1p-53)));
  };
  for (int k = 0; k < 3; ++k) {
    wide.flight.position[k] = more(wide.flight.position[k]);
    wide.flight.velocity[k] = more(wide.flight.velocity[k]);
  }
  const bool at_start = q.begin == q.flight.start;
  wide.begin.offset = more(wide.begin.offset);
  if (at_start)
    wide.flight.start = wide.begin;
  else if (wide.flight.start.period < wide.begin.period)
    wide.flight.start.offset = more(wide.flight.start.offset);
  wide.radius = more(wide.radius);
  return wide;
}

TYPED_TEST(WideWallOracle, InDoubleFirstDecidesAsTheFullSearch) {
  using Real = TypeParam;
  const auto walls = testing::general_search(testing::spex_mill<Real>());
  const auto& clock = walls.mill().clock;
  StateMaker make(testing::spex_mill<double>(), static_cast<double>(walls.longest_window()));
  Draw draw(20110105);
  const Real ulp = epsilon<Real>() * clock.period();
  std::map<std::string, std::array<long, 3>> counts;  // states, decided in double, contacts
  Real worst(0);
  for (long k = 0; k < wanted_states() / 5; ++k) {
    const Kind kind = all_kinds[k % std::size(all_kinds)];
    const auto query = with_more_digits<Real>(draw, make(draw, kind, draw.chance(0.25)));
    const auto first = walls.search_by_double(query);
    auto& count = counts[name(kind)];
    ++count[0];
    if (first.verdict == Verdict::undecided) continue;
    ++count[1];
    if (first.verdict == Verdict::none) {
      auto shorter = query;
      if (first.searched < query.length) shorter.length = first.searched;
      const auto full = over_window(
          [&](const WallQuery<Real>& q) { return walls.search(q); }, shorter, clock.period());
      EXPECT_EQ(full.verdict, Verdict::none) << name(kind) << " " << k;
      continue;
    }
    ++count[2];
    // The window of the search in double is longer by some roundings.
    auto longer = query;
    longer.length += Real(8 * epsilon<double>()) * (query.begin.offset + query.length);
    const auto full = over_window(
        [&](const WallQuery<Real>& q) { return walls.search(q); }, longer, clock.period());
    ASSERT_EQ(full.verdict, Verdict::contact) << name(kind) << " " << k;
    EXPECT_EQ(full.wall, first.wall) << name(kind) << " " << k;
    // The bound on the rounding is several times what it usually is: a quarter of it, and some
    // ulps.
    const Real apart = abs(clock.elapsed(first.time, full.time));
    const Real allowed =
        (first.time_error > full.time_error ? first.time_error : full.time_error) / 4 + 8 * ulp;
    if (apart / allowed > worst) worst = apart / allowed;
    EXPECT_LE(apart, allowed) << name(kind) << " " << k;
    ASSERT_TRUE(first.pose.has_value());
    const auto pose = std::get<0>(walls.mill().motion.pose({0, first.time.offset}));
    const auto found = std::get<0>(*first.pose);
    EXPECT_LE(abs(found.sin_alpha - pose.sin_alpha), 16 * epsilon<Real>());
    EXPECT_LE(abs(found.cos_gamma - pose.cos_gamma), 16 * epsilon<Real>());
  }
  for (const auto& [name, count] : counts)
    std::cout << std::left << std::setw(42) << name << std::right << std::setw(9) << count[0]
              << " states, " << std::setw(9) << count[1] << " decided in double, " << std::setw(9)
              << count[2] << " contacts\n";
  std::cout << "largest difference of times over what is allowed: " << static_cast<double>(worst)
            << "\n";
}

TEST(WallSearch, AgreesWithAnIndependentSolverInOtherMills) {
  constexpr std::uint64_t seed = 20110102;
  const long each = std::max<long>(wanted_states() / 500, 64);
  std::cout << "seed " << seed << ", 24 mills of " << each << " states\n";
  Draw draw(seed);
  std::map<std::string, Tally> tallies;
  for (int m = 0; m < 24; ++m) {
    auto mill = testing::spex_mill<double>();
    const bool still = m % 4 == 0, weightless = m % 3 == 0;
    // Braces keep the order of the draws.
    mill.motion = model::SpexMotion<double>{draw.chance(0.2) ? 0.0 : draw.uniform(0.02, 0.2),
        still ? 0.0 : draw.uniform(0.01, 0.8),
        still || draw.chance(0.2) ? 0.0 : draw.uniform(0.01, 0.6), draw.log_uniform(0.02, 0.5)};
    mill.vessel = model::CylinderVessel<double>{draw.uniform(0.01, 0.05), draw.uniform(0.01, 0.05)};
    mill.gravity = {draw.uniform(-10, 10), draw.uniform(-10, 10), draw.uniform(-10, 10)};
    if (weightless) mill.gravity = {0.0, 0.0, 0.0};
    Comparison<double> compare(mill);
    const StateMaker make(mill, compare.longest_window());
    for (long k = 0; k < each; ++k) {
      Kind kind = all_kinds[k % std::size(all_kinds)];
      // Without acceleration no path from inside turns back at a wall.
      if (still && weightless && (kind == Kind::grazing || kind == Kind::dipping))
        kind = Kind::anywhere;
      compare(make(draw, kind, draw.chance(0.25)),
          tallies[std::string(still ? "still" : "driven") + (weightless ? ", weightless" : "")]);
    }
  }
  print(tallies);
  long bad = 0;
  for (const auto& [name, tally] : tallies) bad += tally.bad();
  EXPECT_EQ(bad, 0);
}

}  // namespace
}  // namespace edmill::dynamics
