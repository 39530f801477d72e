// Runs from one explicit state in double, float128 and mpfr50 have one sequence of events until
// rounding separates them.
#include <gtest/gtest.h>

#include <map>

#include "event_recorder.hpp"
#include "spex_case.hpp"

namespace edmill::engine {
namespace {

template <class Real>
std::vector<Impact<Real>> impacts_of(const casefile::CaseSpec& spec,
    const std::vector<model::BallState<double>>& states, std::uint64_t count) {
  auto built = casefile::build_case<Real>(spec);
  // Balls and states of the double case, digit for digit.
  const auto in_double = casefile::build_case<double>(spec);
  for (std::size_t k = 0; k < in_double.the_case.balls.size(); ++k) {
    const auto& b = in_double.the_case.balls[k];
    built.the_case.balls[k] = {Real(b.radius), Real(b.mass), Real(b.reduced_inertia)};
  }
  Simulation<Real> simulation(built.the_case, testing::cast_states<Real>(states), built.start);
  testing::EventRecorder<Real> recorder;
  simulation.attach(recorder);
  for (Real end = Real(1) / 100; recorder.impacts.size() < count; end += Real(1) / 100)
    simulation.run_until(simulation.clock().at(end));
  recorder.impacts.resize(count);
  return recorder.impacts;
}

template <class A, class B> bool same_event(const Impact<A>& a, const Impact<B>& b) {
  const auto key = [](const auto& i) {
    const int low = i.with_wall ? i.ball : std::min(i.ball, i.partner);
    const int high = i.with_wall ? i.partner : std::max(i.ball, i.partner);
    return std::tuple(i.with_wall, low, high);
  };
  return key(a) == key(b);
}

template <class A, class B>
std::size_t common_length(const std::vector<Impact<A>>& a, const std::vector<Impact<B>>& b) {
  std::size_t k = 0;
  while (k < a.size() && k < b.size() && same_event(a[k], b[k])) ++k;
  return k;
}

TEST(Precisions, EventSequencesAgreeUntilRoundingSeparatesThem) {
  const auto spec = testing::demo_spec();
  const auto states = casefile::build_case<double>(spec).states;
  constexpr std::uint64_t count = 6000;
  const auto narrow = impacts_of<double>(spec, states, count);
  const auto quad = impacts_of<float128>(spec, states, count);
  const auto wide = impacts_of<mpfr>(spec, states, count);

  const auto first = common_length(narrow, quad), second = common_length(quad, wide);
  std::cout << "double and float128 have " << first << " events in common, float128 and mpfr50 "
            << second << " (of " << count << ", 28 balls)\n";
  EXPECT_GT(first, 28u);
  EXPECT_GT(second, first + first / 2);

  // Rounding is the only difference: float128 and mpfr50 times of each ball's first five collisions
  // agree.
  std::map<int, int> collisions;
  const DriveClock<mpfr> clock(casefile::build_mill<mpfr>(spec).motion.period());
  const DriveClock<float128> quad_clock(casefile::build_mill<float128>(spec).motion.period());
  mpfr worst(0);
  int compared = 0;
  for (std::size_t k = 0; k < second; ++k) {
    const auto& impact = quad[k];
    const int count_one = ++collisions[impact.ball];
    const int count_two = impact.with_wall ? count_one : ++collisions[impact.partner];
    if (count_one > 5 && count_two > 5) continue;
    ++compared;
    const mpfr difference =
        abs(mpfr(quad_clock.seconds(impact.time)) - clock.seconds(wide[k].time));
    worst = difference > worst ? difference : worst;
  }
  std::cout << compared << " events compared, worst difference " << worst.str(3) << " s\n";
  for (int ball = 0; ball < 28; ++ball) EXPECT_GE(collisions[ball], 5) << "ball " << ball;
  EXPECT_LT(worst, mpfr("1e-28"));
}

/// Radii that no scalar holds exactly: a value that passed through a narrower scalar would show in
/// the contacts.
template <class Real> Real deepest_overlap(double end) {
  const auto built = casefile::build_case<Real>(testing::demo_spec());
  Simulation<Real> simulation(built.the_case, built.states, built.start);
  simulation.run_until(simulation.clock().at(Real(end)));
  EXPECT_GT(simulation.counts().impacts, 1000u);
  return simulation.counts().deepest_overlap;
}

TEST(Precisions, OverlapsAreOfTheRoundingOfTheScalar) {
  const float128 quad = deepest_overlap<float128>(0.1);
  const mpfr wide = deepest_overlap<mpfr>(0.1);
  std::cout << "deepest overlap: float128 " << to_text(quad) << " m, mpfr50 " << to_text(wide)
            << " m\n";
  // 1 m represents the reach of the mill, 16 roundings of it a contact.
  EXPECT_LT(quad, 16 * epsilon<float128>());
  EXPECT_LT(wide, 16 * epsilon<mpfr>());
}

}  // namespace
}  // namespace edmill::engine
