// Two contacts of one ball at nearly, or exactly, the same time: the first one collides, by the
// exact answer in rationals. Still vessel, no gravity, motion along the axes, so that every contact
// time is a rational.
#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <cstdlib>
#include <random>

#include "core.hpp"

namespace edmill::engine {
namespace {

using boost::multiprecision::cpp_int;
using boost::multiprecision::cpp_rational;

/// States of each kind; the long test sets another number.
int states_of_each_kind() {
  const char* number = std::getenv("EDMILL_NEAR_TIES");
  return number ? std::atoi(number) : 500;
}

/// Random numbers that a scalar holds exactly, as rationals.
template <class Real> class Exact {
 public:
  explicit Exact(std::uint64_t seed) : random_(seed) {}

  /// In [low, low + size), with all the digits of the scalar.
  cpp_rational draw(const cpp_rational& low, const cpp_rational& size) {
    cpp_int bits = 0;
    for (int k = 0; k < 4; ++k) bits = (bits << 62) + cpp_int(random_() >> 2);
    return rounded(low + size * cpp_rational(bits, cpp_int(1) << 248));
  }
  bool coin() { return (random_() >> 40) % 2 == 0; }
  int below(int n) { return static_cast<int>((random_() >> 33) % static_cast<std::uint64_t>(n)); }

  /// A number of the scalar within a unit of its last digit.
  static cpp_rational rounded(const cpp_rational& value) {
    const cpp_int n = abs(numerator(value));
    if (n == 0) return 0;
    const int size = static_cast<int>(msb(n)) - static_cast<int>(msb(denominator(value)));
    const int shift = std::numeric_limits<Real>::digits - 2 - size;  // so that it certainly fits
    const cpp_rational scaled = shift >= 0
        ? cpp_rational(value * cpp_rational(cpp_int(1) << shift))
        : cpp_rational(value / cpp_rational(cpp_int(1) << -shift));
    const cpp_int whole = numerator(scaled) / denominator(scaled);
    return shift >= 0 ? cpp_rational(whole, cpp_int(1) << shift) : cpp_rational(whole << -shift);
  }

  static Real number(const cpp_rational& value) {
    // Exact by construction: the numerator in pieces of 30 bits, the denominator a power of two.
    cpp_int n = abs(numerator(value));
    Real sum{0}, weight{1};
    for (; n != 0; n >>= 30, weight *= Real(1 << 30))
      sum += weight * Real(static_cast<int>(cpp_int(n & ((1 << 30) - 1))));
    for (cpp_int d = denominator(value); d > 1; d >>= 1) sum /= 2;
    return value < 0 ? Real(-sum) : sum;
  }
 private:
  std::mt19937_64 random_;
};

struct TiedBall {
  std::array<cpp_rational, 3> position, velocity;
};

/// A vessel at rest about the origin: caps at X = ±half_height, Z across.
struct Scene {
  cpp_rational radius, vessel_radius, half_height;
  std::vector<TiedBall> balls;
};

/// The first collision, and the number of impacts at that time that were put first by a rule.
struct First {
  bool with_wall;
  int ball, partner;
  bool by_rule;
  std::uint64_t order_decisions;
};

template <class Real> First first_impact(const Scene& scene) {
  const auto number = [](const cpp_rational& x) { return Exact<Real>::number(x); };
  model::Case<Real> the_case;
  the_case.mill.motion = model::SpexMotion<Real>(Real(0), Real(0), Real(0), Real(1) / 16);
  the_case.mill.vessel =
      model::CylinderVessel<Real>{number(scene.vessel_radius), number(scene.half_height)};
  the_case.mill.gravity = {Real(0), Real(0), Real(0)};
  the_case.mill.ball_ball.law = the_case.mill.ball_wall.law =
      model::WaltonBraun<Real>{.normal = Real(1) / 2};
  std::vector<model::BallState<Real>> states;
  for (const auto& ball : scene.balls) {
    the_case.balls.push_back({number(scene.radius), Real(1), Real(2) / 5});
    model::BallState<Real> state{{}, {}, {Real(0), Real(0), Real(0)}};
    for (int k = 0; k < 3; ++k) state.position[k] = number(ball.position[k]);
    for (int k = 0; k < 3; ++k) state.velocity[k] = number(ball.velocity[k]);
    states.push_back(state);
  }
  Simulation<Real> simulation(the_case, states, {});
  struct FirstThree : Observer<Real> {
    std::optional<First> first;
    Instant<Real> latest{};
    int impacts = 0;
    void on_impact(const Impact<Real>& impact, Simulation<Real>& s) override {
      if (!first) first = First{impact.with_wall, impact.ball, impact.partner, impact.by_rule, 0};
      EXPECT_FALSE(impact.time < latest) << "the time goes back";
      latest = impact.time;
      if (++impacts == 3) s.request_stop(EndReason::stopped);
    }
  } watch;
  simulation.attach(watch);
  simulation.run_until(simulation.clock().at(Real(100)));
  if (!watch.first) return {false, -1, -1, false, 0};
  for (const auto& e : simulation.escalations()) watch.first->order_decisions += e.order + e.wall;
  return *watch.first;
}

/// Results of the simulations of many states.
struct Score {
  int states = 0, wrong = 0, exact_ties = 0, unmarked_ties = 0, marked_others = 0, escalated = 0;
  double smallest = 1, largest = 0;  ///< differences in time [s]

  /// @param right  whether the first impact is the one that is exactly earlier
  void take(const cpp_rational& one, const cpp_rational& other, bool one_came, bool other_came,
      const First& first) {
    const double difference = static_cast<double>(abs(cpp_rational(one - other)));
    ++states;
    escalated += first.order_decisions > 0;
    if (one == other) {
      ++exact_ties;
      unmarked_ties += !first.by_rule;
      wrong += !one_came && !other_came;
      return;
    }
    smallest = std::min(smallest, difference), largest = std::max(largest, difference);
    wrong += one < other ? !one_came : !other_came;
    marked_others += first.by_rule;
  }
  /// @param exactly  exact arithmetic decides, as walls at rest are planes; else a wider scalar
  /// does
  void expect_all_right(double close, bool exactly = false) const {
    std::cout << states << " states: " << wrong << " wrong, " << escalated << " by a wider scalar, "
              << exact_ties << " exact ties, others " << smallest << " to " << largest
              << " s apart\n";
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(unmarked_ties, 0);
    EXPECT_EQ(marked_others, 0);
    if (exactly)
      EXPECT_EQ(escalated, 0);
    else
      EXPECT_GT(escalated, states / 2);  // or the states are not near ties
    EXPECT_LT(largest, close);
  }
};

/// The scene's sizes, and a ball at rest in the middle.
template <class Real> Scene empty_scene(Exact<Real>& random) {
  return {random.draw(cpp_rational(1, 1000), cpp_rational(1, 100)), random.draw(1, 1),
      random.draw(1, 1), {}};
}

template <class Real> class NearTies : public ::testing::Test {
 public:
  /// Differences in time are about a rounding of a position over a speed [s].
  static double close() { return 4096 * static_cast<double>(epsilon<Real>()); }
};
using Scalars = ::testing::Types<double, float128>;
TYPED_TEST_SUITE(NearTies, Scalars);

/// Two balls reach the ball in the middle along X, from either side.
TYPED_TEST(NearTies, OfTwoPairsTheEarlierCollides) {
  using Real = TypeParam;
  Exact<Real> random(20110101);
  Score score;
  while (score.states < states_of_each_kind()) {
    Scene s = empty_scene(random);
    const cpp_rational sum = 2 * s.radius;
    const cpp_rational x = random.draw(cpp_rational(-1, 100), cpp_rational(1, 50)),
                       v = random.draw(cpp_rational(-1, 10), cpp_rational(1, 5)),
                       left_speed = random.draw(cpp_rational(1, 2), 4),
                       right_speed = random.draw(cpp_rational(1, 2), 4);
    const cpp_rational left = random.draw(x - sum - cpp_rational(1, 2), cpp_rational(2, 5));
    const cpp_rational left_time = (x - left - sum) / (left_speed - v);
    // At a distance to arrive at the same time, up to rounding; the gap is `left_time` times the
    // closing speed.
    const cpp_rational right = random.rounded(x + sum + left_time * (right_speed + v));
    const cpp_rational right_time = (right - x - sum) / (right_speed + v);
    const int middle = random.below(3), one = (middle + 1) % 3, two = (middle + 2) % 3;
    s.balls.resize(3);
    s.balls[middle] = {{x, 0, 0}, {v, 0, 0}};
    s.balls[one] = {{left, 0, 0}, {left_speed, 0, 0}};
    s.balls[two] = {{right, 0, 0}, {cpp_rational(-right_speed), 0, 0}};
    const First first = first_impact<Real>(s);
    const auto is = [&](int a) {
      return !first.with_wall && first.ball + first.partner == a + middle &&
          (first.ball == a || first.partner == a);
    };
    score.take(left_time, right_time, is(one), is(two), first);
  }
  score.expect_all_right(this->close());
}

/// A ball flies to a wall, another one follows it and is faster.
TYPED_TEST(NearTies, OfAPairAndAWallTheEarlierCollides) {
  using Real = TypeParam;
  Exact<Real> random(20110102);
  Score score;
  while (score.states < states_of_each_kind()) {
    Scene s = empty_scene(random);
    const bool cap = random.coin();
    const int axis = cap ? 0 : 2;
    const cpp_rational wall = (cap ? s.half_height : s.vessel_radius) - s.radius;
    const cpp_rational speed = random.draw(cpp_rational(1, 2), 2), faster = random.draw(3, 2);
    const cpp_rational x = random.draw(cpp_rational(0), wall / 2);
    const cpp_rational wall_time = (wall - x) / speed;
    const cpp_rational behind = random.rounded(x - 2 * s.radius - wall_time * (faster - speed));
    if (behind < -wall) continue;  // not in the vessel
    const cpp_rational pair_time = (x - behind - 2 * s.radius) / (faster - speed);
    const int sign = random.coin() ? 1 : -1, ball = random.below(2);
    s.balls.resize(2);
    s.balls[ball].position[axis] = sign * x, s.balls[ball].velocity[axis] = sign * speed;
    s.balls[1 - ball].position[axis] = sign * behind,
                s.balls[1 - ball].velocity[axis] = sign * faster;
    const First first = first_impact<Real>(s);
    // vessel frame: y is -X
    const int wall_id = cap ? (sign > 0 ? 0 : 1) : 2;
    score.take(wall_time, pair_time,
        first.with_wall && first.ball == ball && first.partner == wall_id, !first.with_wall, first);
  }
  score.expect_all_right(this->close());
}

/// A ball flies into the corner of a cap and the cylinder.
TYPED_TEST(NearTies, OfTwoWallsTheEarlierCollides) {
  using Real = TypeParam;
  Exact<Real> random(20110103);
  Score score;
  while (score.states < states_of_each_kind()) {
    Scene s = empty_scene(random);
    const cpp_rational cap = s.half_height - s.radius, side = s.vessel_radius - s.radius;
    const cpp_rational along = random.draw(cpp_rational(1, 2), 2),
                       across = random.draw(cpp_rational(1, 2), 2);
    const cpp_rational x = random.draw(cap / 2, cap / 4);
    const cpp_rational cap_time = (cap - x) / along;
    const cpp_rational z = random.rounded(side - cap_time * across);
    if (z < -side) continue;
    const cpp_rational side_time = (side - z) / across;
    const int sign = random.coin() ? 1 : -1;
    s.balls.push_back({{sign * x, 0, z}, {sign * along, 0, across}});
    const First first = first_impact<Real>(s);
    score.take(cap_time, side_time, first.with_wall && first.partner == (sign > 0 ? 0 : 1),
        first.with_wall && first.partner == 2, first);
  }
  score.expect_all_right(this->close(), true);
}

template <class Real> class ExactTies : public ::testing::Test {};
using AllScalars = ::testing::Types<double, float128, mpfr>;
TYPED_TEST_SUITE(ExactTies, AllScalars);

/// Two balls hit a third at once from both sides: lower numbers first, and the impact says so.
TYPED_TEST(ExactTies, OfTwoPairsAreMarked) {
  const Scene s{cpp_rational(1, 8), 2, 2,
      {{{-1, 0, 0}, {1, 0, 0}}, {{1, 0, 0}, {-1, 0, 0}}, {{0, 0, 0}, {0, 0, 0}}}};
  const First first = first_impact<TypeParam>(s);
  EXPECT_TRUE(first.by_rule);
  EXPECT_FALSE(first.with_wall);
  EXPECT_EQ(std::min(first.ball, first.partner), 0);
  EXPECT_EQ(std::max(first.ball, first.partner), 2);
}

TYPED_TEST(ExactTies, OfAPairAndAWallAreMarked) {
  // The front ball is at the cap after 1/2 s, when the one behind has caught up.
  const Scene s{cpp_rational(1, 8), 2, cpp_rational(13, 8),
      {{{cpp_rational(-1, 4), 0, 0}, {3, 0, 0}}, {{1, 0, 0}, {1, 0, 0}}}};
  const First first = first_impact<TypeParam>(s);
  EXPECT_TRUE(first.by_rule);
  EXPECT_TRUE(first.with_wall);
  EXPECT_EQ(first.ball, 1);
}

TYPED_TEST(ExactTies, OfTwoWallsAreMarked) {
  const Scene s{
      cpp_rational(1, 8), cpp_rational(9, 8), cpp_rational(9, 8), {{{0, 0, 0}, {1, 0, 1}}}};
  const First first = first_impact<TypeParam>(s);
  EXPECT_TRUE(first.by_rule);
  EXPECT_TRUE(first.with_wall);
  EXPECT_EQ(first.partner, 0);
}

/// Five balls at once: more contacts than an agenda keeps.
TYPED_TEST(ExactTies, OfMoreContactsThanABallKeepsAreMarked) {
  Scene s{cpp_rational(1, 8), 2, 2, {{{0, 0, 0}, {0, 0, 0}}}};
  for (const int sign : {-1, 1})
    for (int axis = 0; axis < 3; ++axis) {
      TiedBall ball{};
      ball.position[axis] = sign, ball.velocity[axis] = -sign;
      s.balls.push_back(ball);
    }
  const First first = first_impact<TypeParam>(s);
  EXPECT_TRUE(first.by_rule);
  EXPECT_EQ(std::min(first.ball, first.partner), 0);
  EXPECT_EQ(std::max(first.ball, first.partner), 1);
}

/// Contacts of different balls at one time commute: nothing is marked.
TYPED_TEST(ExactTies, OfDifferentBallsAreNoTies) {
  const Scene s{cpp_rational(1, 8), 2, 2,
      {{{-1, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {0, 0, 0}}, {{-1, 0, 1}, {1, 0, 0}},
          {{0, 0, 1}, {0, 0, 0}}}};
  EXPECT_FALSE(first_impact<TypeParam>(s).by_rule);
}

/// A contact exactly at the end of a search window.
TYPED_TEST(ExactTies, AContactAtAWindowsEndIsFound) {
  // 0.25 m at 1.5 m/s: the wall is reached after a whole number of windows of the still vessel.
  using Real = TypeParam;
  for (const int steps : {1, 2, 3, 5}) {
    const cpp_rational speed(3, 2), window(1, 128);
    Scene s{cpp_rational(1, 8), cpp_rational(1, 2), cpp_rational(1, 2), {}};
    const cpp_rational x = cpp_rational(3, 8) - speed * window * steps;
    s.balls.push_back({{x, 0, 0}, {speed, 0, 0}});
    const First first = first_impact<Real>(s);
    EXPECT_TRUE(first.with_wall);
    EXPECT_EQ(first.partner, 0);
    EXPECT_FALSE(first.by_rule);
  }
}

}  // namespace
}  // namespace edmill::engine
