// Balls that touch up to three walls at the start: exactly, or apart or overlapped by rounding; at
// rest, fast or hardly moving against them; in vessels that stand still or vibrate along any axis.
// Each first impact is that of a computation in 200 digits, in which the states are exact.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <optional>

#include "base/errors.hpp"
#include "casefile/random.hpp"
#include "core.hpp"

namespace edmill::engine {
namespace {

using Sharp = mpfr_of<200>;
constexpr double soon = 1e-6;  // [s]

/// States of each scalar; the long test sets another number.
int states_of_each_scalar() {
  const char* number = std::getenv("EDMILL_CORNERS");
  return number ? std::atoi(number) : 400;
}

/// The first impact with a wall, by the Taylor polynomial of second degree of its gap.
struct Expected {
  int wall;
  Sharp time;  ///< after the start [s]
  bool moves;
};

/// A gap and its rate, at a time after the start.
struct Gap {
  Sharp value, rate;
};

/// The first time at which the gap is zero or negative while it falls, up to `soon`. Where the
/// first two derivatives tell it they do; else the gap is followed, from a time on at which it has
/// hardly changed.
/// @param d, r, c  the gap and its derivatives at the start
template <class F>
std::optional<Sharp> contact_time(
    const Sharp& d, const Sharp& r, const Sharp& c, const Sharp& zero, const F& gap) {
  if (d <= 0 && (r < -zero || (abs(r) <= zero && c < -zero))) return Sharp(0);
  if (zero == 0 || abs(c) > 0.01) {
    const Sharp square = r * r - 2 * d * c;
    if (d <= 0 && r <= zero) return std::nullopt;
    if (d <= 0 && c < 0 && square <= 0) return Sharp(-r / c);
    if (square < 0 || (r >= 0 && c >= 0)) return std::nullopt;
    const Sharp root = sqrt(square);
    return r < 0 ? Sharp(2 * d / (root - r)) : Sharp((r + root) / -c);
  }
  const Sharp rounding(zero > 0 ? 1e-47 : 0);
  Sharp low = 0;
  for (Sharp t = 1e-45; t < soon; low = t, t *= 2) {
    const auto at = gap(t);
    if (at.value > rounding || !(at.rate < -zero)) continue;
    Sharp high = t;
    for (int k = 0; k < 60; ++k) {
      const Sharp middle = (low + high) / 2;
      const auto half = gap(middle);
      (half.value > rounding || !(half.rate < -zero) ? low : high) = middle;
    }
    return t == 1e-45 ? Sharp(0) : high;
  }
  return std::nullopt;
}

template <class Real> struct Corner {
  model::Case<Real> the_case;
  model::BallState<Real> ball;
  std::vector<Expected> expected;  ///< soon
  bool moves = false;              ///< a wall that it touches does
};

/// A box, or a cylinder with a corner of a cap and the side, that stands still or vibrates along a
/// line.
template <class Real> class Corners {
 public:
  explicit Corners(std::uint64_t seed) : random_(seed) {}

  Corner<Real> draw() {
    Corner<Real> corner;
    auto& mill = corner.the_case.mill;
    const Real period = Real(1) / 32, radius = real(0.002, 0.005);
    draw_motion(mill, period);
    mill.gravity = {Real(0), coin(0.2) ? Real(0) : real(-9.9, -9.7), Real(0)};
    const double kind = uniform();
    mill.ball_ball.law = mill.ball_wall.law =
        model::WaltonBraun<Real>{.normal = kind < 0.1 ? Real(0)
                : kind < 0.2                          ? Real(1)
                                                      : real(0, 1),
            .friction = coin(0.3) ? Real(0) : real(0, 1)};
    mill.ball_ball.least_separation = mill.ball_wall.least_separation =
        coin(0.3) ? Real(0) : Real(1) / 100;
    corner.the_case.balls.push_back({radius, Real(1) / 100, Real(2) / 5});
    corner.ball.spin = {real(-9, 9), real(-9, 9), real(-9, 9)};
    if (coin(0.5))
      draw_in_box(corner);
    else
      draw_in_cylinder(corner);
    return corner;
  }
 private:
  double uniform() { return random_.uniform<double>(); }
  bool coin(double share) { return uniform() < share; }
  Real real(double low, double high) {
    return Real(low) + random_.uniform<Real>() * Real(high - low);
  }

  void draw_motion(model::Mill<Real>& mill, const Real& period) {
    model::Joints<Real> joints{{}, period};
    amplitude_ = {Sharp(0), Sharp(0), Sharp(0)};
    const double kind = uniform();
    const int only = static_cast<int>(3 * uniform());
    phase_ = coin(0.5) ? Real(static_cast<int>(4 * uniform())) / 4 : real(0, 1);
    period_ = Sharp(period);
    for (int k = 0; k < 3; ++k) {
      auto joint = model::axis_joint<Real>(false, static_cast<std::size_t>(k));
      const bool moves = kind > 0.1 && (kind > 0.8 || k == only);
      const Real amplitude = moves ? real(0.001, 0.005) : Real(0);
      amplitude_[k] = Sharp(amplitude);
      joint.swings.push_back({amplitude, 1 / period, phase_, model::TurnFraction{.whole = 1}});
      joints.list.push_back(joint);
    }
    mill.motion = model::ChainMotion<Real>(joints);
  }
  /// Of the vessel's centre at the start, along an axis.
  Sharp place(int k) const { return amplitude_[k] * sine(); }
  Sharp speed(int k) const { return amplitude_[k] * turn() / period_ * cosine(); }
  /// The ball's coordinate in the vessel and its rate, at a time after the start.
  Gap seen(const Corner<Real>& corner, int k, const Sharp& t) const {
    const Sharp g(corner.the_case.mill.gravity[k]), v(corner.ball.velocity[k]);
    Sharp away = t * (v + t * g / 2), rate = v + t * g;
    if (amplitude_[k] != 0) {
      const Sharp phase = turn() * t / period_;  // of the time since the start
      const Sharp sine_then = sine() * cos(phase) + cosine() * sin(phase),
                  cosine_then = cosine() * cos(phase) - sine() * sin(phase);
      away -= amplitude_[k] * (sine_then - sine()),
          rate -= amplitude_[k] * turn() / period_ * cosine_then;
    }
    return {Sharp(corner.ball.position[k]) - place(k) + away, rate};
  }
  Sharp acceleration(int k) const {
    return -amplitude_[k] * turn() / period_ * turn() / period_ * sine();
  }
  static Sharp turn() { return 2 * boost::math::constants::pi<Sharp>(); }
  Sharp sine() const {
    return quarter() ? Sharp(quarters() % 2 == 0 ? 0 : 2 - quarters())
                     : sin(turn() * Sharp(phase_));
  }
  Sharp cosine() const {
    return quarter() ? Sharp(quarters() % 2 == 1 ? 0 : 1 - quarters())
                     : cos(turn() * Sharp(phase_));
  }
  bool quarter() const { return Real(quarters()) == 4 * phase_; }
  int quarters() const { return static_cast<int>(static_cast<double>(Real(4 * phase_))); }

  /// A few units of the last place away, or not.
  Real near(const Sharp& value) {
    Real x(value);
    if (coin(0.4)) return x;
    return x + x * epsilon<Real>() * Real(static_cast<int>(7 * uniform()) - 3);
  }
  /// Approach to a wall: fast, slow, hardly, not at all.
  Real draw_approach() {
    const double kind = uniform();
    if (kind < 0.35) return real(-0.5, 1);
    if (kind < 0.55) return real(-0.01, 0.01);
    if (kind < 0.75) return Real(0);
    return epsilon<Real>() * real(-4, 4);
  }

  void draw_in_box(Corner<Real>& corner) {
    const Vec3<Real> half{real(0.01, 0.02), real(0.01, 0.02), real(0.01, 0.02)};
    corner.the_case.mill.vessel = model::BoxVessel<Real>{half};
    const Real& radius = corner.the_case.balls[0].radius;
    const double kind = uniform();
    const int free_axis = kind < 0.3 ? 3 : static_cast<int>(3 * uniform());
    const int second_free = kind > 0.9 ? (free_axis + 1) % 3 : 3;
    for (int k = 0; k < 3; ++k) {
      if (k == free_axis || k == second_free) {
        corner.ball.position[k] = real(-0.001, 0.001) + Real(place(k));
        corner.ball.velocity[k] = real(-1, 1);
        continue;
      }
      const int side = coin(0.5) ? 1 : -1;
      const Sharp room = Sharp(half[k]) - Sharp(radius);
      corner.ball.position[k] = near(place(k) + side * room);
      corner.ball.velocity[k] = Real(speed(k)) + Real(side) * draw_approach();
      const Sharp gap = room - side * (Sharp(corner.ball.position[k]) - place(k));
      const Sharp rate = -side * (Sharp(corner.ball.velocity[k]) - speed(k));
      const Sharp bend = -side * (Sharp(corner.the_case.mill.gravity[k]) - acceleration(k));
      expect(corner, 2 * k + (side > 0), amplitude_[k] != 0, gap, rate, bend,
          [=, this, ball = corner](const Sharp& t) {
            const auto p = seen(ball, k, t);
            return Gap{room - side * p.value, -side * p.rate};
          });
    }
  }

  /// A cap and the side, or one of them; the axis is y.
  void draw_in_cylinder(Corner<Real>& corner) {
    const Real wide = real(0.01, 0.02), half = real(0.01, 0.02);
    corner.the_case.mill.vessel = model::CylinderVessel<Real>{wide, half};
    const Real& radius = corner.the_case.balls[0].radius;
    auto& [position, velocity, spin] = corner.ball;
    const auto& gravity = corner.the_case.mill.gravity;
    const bool at_cap = coin(0.8), at_side = !at_cap || coin(0.8);
    position = {real(-0.001, 0.001) + Real(place(0)), real(-0.001, 0.001) + Real(place(1)),
        real(-0.001, 0.001) + Real(place(2))};
    velocity = {real(-1, 1), real(-1, 1), real(-1, 1)};
    if (at_cap) {
      const int side = coin(0.5) ? 1 : -1;
      const Sharp room = Sharp(half) - Sharp(radius);
      position[1] = near(place(1) + side * room);
      velocity[1] = Real(speed(1)) + Real(side) * draw_approach();
      expect(corner, side > 0, amplitude_[1] != 0, room - side * (Sharp(position[1]) - place(1)),
          -side * (Sharp(velocity[1]) - speed(1)), -side * (Sharp(gravity[1]) - acceleration(1)),
          [=, this, ball = corner](const Sharp& t) {
            const auto p = seen(ball, 1, t);
            return Gap{room - side * p.value, -side * p.rate};
          });
    }
    if (!at_side) return;
    // On the x or z axis, so that what is along the normal can be zero exactly.
    const int k = coin(0.5) ? 0 : 2, other = 2 - k, side = coin(0.5) ? 1 : -1;
    const Sharp room = Sharp(wide) - Sharp(radius);
    position[other] = Real(place(other)),
    velocity[other] = coin(0.5) ? Real(speed(other)) : real(-0.5, 0.5);
    position[k] = near(place(k) + side * room);
    velocity[k] = Real(speed(k)) + Real(side) * draw_approach();
    Sharp gap = room * room, rate = 0, bend = 0;
    for (const int axis : {0, 2}) {
      const Sharp p = Sharp(position[axis]) - place(axis), u = Sharp(velocity[axis]) - speed(axis);
      gap -= p * p, rate -= 2 * p * u;
      bend -= 2 * (u * u + p * (Sharp(gravity[axis]) - acceleration(axis)));
    }
    expect(corner, 2, amplitude_[0] != 0 || amplitude_[2] != 0, gap, rate, bend,
        [=, this, ball = corner](const Sharp& t) {
          const auto x = seen(ball, 0, t), z = seen(ball, 2, t);
          return Gap{room * room - x.value * x.value - z.value * z.value,
              -2 * (x.value * x.rate + z.value * z.rate)};
        });
  }

  /// @param moves  the wall does, along its normal: of its sines 50 digits are known at most, and
  /// what vanishes in them is zero by the rule
  template <class F>
  void expect(Corner<Real>& corner, int wall, bool moves, const Sharp& gap, const Sharp& rate,
      const Sharp& bend, const F& later) {
    corner.moves = corner.moves || moves;
    const bool touches = moves && abs(gap) < 1e-47;
    const Sharp zero(moves ? 1e-44 : 0);
    const auto time = contact_time(touches ? Sharp(0) : gap, rate, bend, zero, later);
    if (time && *time < soon) corner.expected.push_back({wall, *time, moves});
  }

  casefile::Random random_;
  std::array<Sharp, 3> amplitude_;
  Real phase_{};
  Sharp period_;
};

template <class Real> struct FirstImpact : Observer<Real> {
  std::optional<Impact<Real>> first;
  double time = 0;
  int impacts = 0;
  void on_impact(const Impact<Real>& impact, Simulation<Real>& s) override {
    if (!first) first = impact, time = static_cast<double>(s.seconds());
    if (++impacts == 1) s.request_stop(EndReason::stopped);
  }
};

template <class Real> class CornersTest : public ::testing::Test {};
using CornerScalars = ::testing::Types<double, float128, mpfr>;
TYPED_TEST_SUITE(CornersTest, CornerScalars);

TYPED_TEST(CornersTest, AreDecidedAsTheirExactStatesSay) {
  using Real = TypeParam;
  const char* number = std::getenv("EDMILL_CORNERS_SEED");
  const std::uint64_t seed = number ? std::strtoull(number, nullptr, 10) : 51;
  Corners<Real> corners(seed);
  int undecided = 0, wrong = 0, by_rule = 0, tied = 0, several = 0, none = 0;
  double slowest = 0;
  int slowest_state = 0;
  const int states = states_of_each_scalar();
  for (int k = 0; k < states; ++k) {
    const auto corner = corners.draw();
    FirstImpact<Real> watch;
    double took = 1e3;
    try {
      // A slow search is timed again: what its processor did besides is not the search's cost.
      for (int trial = 0; trial == 0 || (trial < 4 && took > 5e-3); ++trial) {
        const std::clock_t begin = std::clock();
        watch = FirstImpact<Real>{};
        Simulation<Real> simulation(corner.the_case, {corner.ball}, {});
        simulation.attach(watch);
        simulation.run_until(simulation.clock().at(Real(soon)));
        took = std::min(took, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
      }
    } catch (const UndecidedError& error) {
      if (++undecided < 4) ADD_FAILURE() << "state " << k << ": " << error.what();
      continue;
    }
    if (took > slowest) slowest = took, slowest_state = k;
    const Expected* first = nullptr;
    for (const auto& e : corner.expected)
      if (!first || e.time < first->time) first = &e;
    several += corner.expected.size() > 1;
    none += !first;
    const bool impact_soon = watch.first && watch.time < soon / 2;
    if (!first || first->time > soon / 2) {
      if (impact_soon && !first && !watch.first->by_rule && ++wrong < 10)
        ADD_FAILURE() << "state " << k << ": an impact with wall " << watch.first->partner << " at "
                      << watch.time << " s, where none comes";
      continue;
    }
    const Sharp margin = first->time / 100;
    bool right = false, tie = false;
    for (const auto& e : corner.expected) {
      // No scalar knows better than 50 digits when a ball that is pressed on a moving wall touches
      // it.
      const bool by_rule =
          (e.moves || first->moves) && (e.time < 1e-22 || (watch.first && watch.first->by_rule));
      const bool tied_with_first = e.time - first->time <= margin || by_rule;
      right = right || (watch.first && e.wall == watch.first->partner && tied_with_first);
      tie = tie || (&e != first && tied_with_first);
    }
    tied += tie;
    by_rule += watch.first && watch.first->by_rule && !tie && !corner.moves;
    if (!right && ++wrong < 10) {
      ADD_FAILURE() << "state " << k << ": first " << (watch.first ? watch.first->partner : -1)
                    << " at " << watch.time << " s, expected wall " << first->wall << " at "
                    << first->time.str(6);
    }
  }
  std::cout << states << " states, seed " << seed << ": " << none << " without an impact, "
            << several << " with several, " << tied << " tied, " << by_rule
            << " others by rule, slowest " << 1e3 * slowest << " ms of processor time, state "
            << slowest_state << "\n";
  EXPECT_EQ(undecided, 0);
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(by_rule, 0);
}

}  // namespace
}  // namespace edmill::engine
