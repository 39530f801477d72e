// Claim 09, still vessels: sliding to rolling, rolling down an incline, the rolling pendulum.
#include <array>
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>

#include "one_ball.hpp"

namespace edmill::verification {
namespace {

using Components = std::array<exact, 3>;

const exact radius = exact(1) / 16;
constexpr double g = 10;
const std::vector<double> two_decades{1e-2, 3e-3, 1e-3, 3e-4, 1e-4};

/// A still vessel of 2 m x 1 m about the X axis; SI, in the inertial frame.
std::string still_case(const Components& gravity, const Law& law, const Components& position,
    const Components& velocity) {
  const auto vector = [](const Components& v) { return vector_text(v[0], v[1], v[2]); };
  return "[run]\nend_time = \"1000 s\"\ngravity = " + vector(gravity) +
      "[mill]\ntype = \"still\"\n[vessel]\ndiameter = \"2 m\"\nheight = \"1 m\"\n" + law.text() +
      "[[ball]]\ndiameter = \"" + (2 * radius).str() + " m\"\nposition = " + vector(position) +
      "velocity = " + vector(velocity);
}

const Components at_rest{0, 0, 0};

/// Over cap 1, the floor at X = -1/2 m, at the top of a hop that left it at v_s where `gravity`
/// presses.
Components on_floor(const Law& law, double gravity) {
  const exact v_s = decimal(law.least_separation);
  return {radius - exact(1) / 2 + v_s * v_s / (2 * exact(gravity)), 0, 0};
}

/// Speed along Z of the ball's point that touches the floor. [m/s]
template <class Real> Real slip_on_floor(const model::BallState<Real>& s) {
  return s.velocity[2] + static_cast<Real>(radius) * s.spin[1];
}

// --- Sliding to rolling: a throw along the floor without spin ---

template <class Real> struct Throw {
  static constexpr double mu = 0.25;
  Real slip_end{-1};  ///< time of the first impact that sticks [s]
  Real speed, slip;   ///< once it rolls [m/s]
  Real dose;          ///< less what v_s supplies, over m v0^2

  Throw(double v0, double v_s, double min_tangential, ImpactBound& bound) {
    const Law law{v_s, mu, min_tangential};
    OneBall<Real> run(still_case({-g, 0, 0}, law, on_floor(law, g), {0, 0, v0}), 1, g);
    run.watch = [&](const auto& impact) {
      if (slip_end < 0 && impact.outcome.restitution_tangential <= min_tangential)
        slip_end = run.seconds(impact);
    };
    const auto end = run.at(Real(1) / 4);
    speed = end.velocity[2];
    slip = slip_on_floor<Real>(end);
    dose = (run.dose - run.supplied) / (run.ball().mass * v0 * v0);
    bound.add(run);
  }
};

/// Largest errors of 16 throws, whose slip leaves different remainders when divided by 7 mu v_s.
struct ThrowErrors {
  double time = 0, speed = 0, dose = 0;

  ThrowErrors(double v_s, double min_tangential, ImpactBound& bound) {
    for (int k = 0; k < 16; ++k) {
      const double v0 = 1 + std::fmod(0.618034 * k, 1) / 4;
      const Throw<double> run(v0, v_s, min_tangential, bound);
      EXPECT_GT(run.slip_end, 0);
      raise(time, std::abs(run.slip_end - 2 * v0 / (7 * Throw<double>::mu * g)));
      raise(speed, std::abs(run.speed - v0 * 5 / 7));
      raise(dose, std::abs(run.dose * 7 - 1));
    }
  }
};

/// Sticking that takes all slip away leaves 5/7 of the speed at any v_s, and 1/7 of m v0^2 as dose,
/// but for rounding: up to 12500 impacts, at each of which the place is rounded by up to 1.1e-16 m.
TEST(SustainedContact, AThrownBallEndsRolling) {
  Convergence time("throw, e_t >= 0, time when slip ends");
  ImpactBound bound;
  double worst_time = 0, worst_speed = 0, worst_dose = 0;
  for (const double v_s : two_decades) {
    const ThrowErrors errors(v_s, 0, bound);
    time.add(v_s, errors.time);
    raise(worst_time, errors.time * g / v_s);
    raise(worst_speed, errors.speed);
    raise(worst_dose, errors.dose);
  }
  time.expect_order(1, 0.05);
  sustained.at_most("the same, largest error over v_s/g", worst_time, 1.001);
  sustained.at_most(
      "throw, e_t >= 0, largest error of 5/7 v0 at any v_s", worst_speed, 1e-12, " m/s");
  sustained.at_most(
      "throw, e_t >= 0, largest relative error of the dose m v0^2/7 at any v_s", worst_dose, 1e-10);
  bound.expect("throws", 1e-6);
}

/// Sticking that reverses the slip leaves a remainder of it that changes its sign for ever.
TEST(SustainedContact, AThrownBallWithReversedSlipTendsToRolling) {
  Convergence time("throw, e_t >= -1, time when slip ends"), speed("throw, e_t >= -1, final speed"),
      dose("throw, e_t >= -1, dose");
  ImpactBound bound;
  double worst_time = 0, worst_speed = 0;
  for (const double v_s : two_decades) {
    const ThrowErrors errors(v_s, -1, bound);
    time.add(v_s, errors.time);
    speed.add(v_s, errors.speed);
    dose.add(v_s, errors.dose);
    raise(worst_time, errors.time * g / v_s);
    raise(worst_speed, errors.speed / (Throw<double>::mu * v_s));
  }
  time.expect_order(1, 0.05);
  sustained.at_most("the same, largest error over v_s/g", worst_time, 2.001);
  speed.expect_order(1, 0.05);
  sustained.at_most("the same, largest error over mu v_s", worst_speed, 1.001);
  dose.expect_order(2, 0.1);
  bound.expect("throws", 1e-6);
}

TEST(SustainedContact, AThrownBallEndsRollingInFloat128) {
  ImpactBound bound;
  const Throw<float128> run(1, 1e-4, 0, bound);
  sustained.at_most("throw in float128, e_t >= 0, v_s 1e-4, error of 5/7 v0",
      abs(run.speed - float128(5) / 7), 1e-31, " m/s");
  sustained.at_most("the same, slip left", abs(run.slip), 1e-31, " m/s");
  sustained.at_most("the same, relative error of the dose", abs(run.dose * 7 - 1), 1e-28);
  bound.expect("throw in float128", 1e-20);
}

// --- Incline: gravity of 10 m/s2 with 8 into the floor and 6 along it ---

struct Incline {
  const char* name;
  double mu, min_tangential, acceleration;
  double speed_bound;     ///< of the error of the speed, over v_s
  double distance_error;  ///< relative bound at v_s 1e-4
};

void expect_incline(const Incline& c) {
  const std::string name = "incline, " + std::string(c.name);
  Convergence speed(name + ", speed");
  ImpactBound bound;
  double worst = 0, mean = 0;
  for (const double v_s : two_decades) {
    const Law law{v_s, c.mu, c.min_tangential};
    OneBall<double> run(still_case({-8, 0, 6}, law, on_floor(law, 8), at_rest), 1, 8);
    double error = 0;
    for (int k = 1; k <= 64; ++k) {  // at different parts of a hop
      const double time = k / 128.0 + 0.3 * v_s * k / 64;
      const auto state = run.at(time);
      raise(error, std::abs(state.velocity[2] - c.acceleration * time));
      if (k == 64) mean = 2 * state.position[2] / (time * time);
    }
    speed.add(v_s, error);
    raise(worst, error / v_s);
    bound.add(run);
  }
  speed.expect_order(1, 0.05);
  sustained.at_most("the same, largest error over v_s", worst, c.speed_bound);
  sustained.at_most(name + ", v_s 1e-4: mean acceleration " + Claim::text(mean, 7) +
          " m/s2, relative to " + Claim::text(c.acceleration, 6) + " off by",
      std::abs(mean / c.acceleration - 1), c.distance_error);
  bound.expect(name, 1e-6);
}

/// tan = 3/4: it rolls where tan < 7/2 mu, 0.214 < mu. In flight the slip grows by d = 6 m/s2 * 2
/// v_s/8. Where an impact takes it away the speed runs ahead by up to 2/7 d and in the mean by d/7,
/// which makes 2e-5 of the way at 1e-4 m/s; where an impact reverses it, from -d/2 to d/2, by up to
/// d/7 and not in the mean. While sliding an impact takes 2 mu v_s.
TEST(SustainedContact, ABallRollsOrSlidesDownAnIncline) {
  const double rolling = 6.0 * 5 / 7, ahead = 2.0 / 7 * 6 * 2 / 8;
  expect_incline({"mu 0.5, e_t >= 0", 0.5, 0, rolling, 1.001 * ahead, 2.01e-5});
  expect_incline({"mu 0.5, e_t >= -1", 0.5, -1, rolling, 1.001 * ahead / 2, 1e-8});
  expect_incline({"mu 0.22, e_t >= 0", 0.22, 0, rolling, 1.001 * ahead, 2.01e-5});
  expect_incline({"mu 0.22, e_t >= -1", 0.22, -1, rolling, 1.001 * ahead / 2, 1e-8});
  expect_incline({"mu 0.2, e_t >= -1", 0.2, -1, 6 - 0.2 * 8, 1.001 * 0.2, 1e-8});
}

// --- Rolling pendulum ---

/// Gravity along -Y; the ball is let go at 60 deg from the lowest place of the cylinder, at the top
/// of a hop.
namespace pendulum {

const exact length = 1 - radius, amplitude = boost::math::constants::pi<exact>() / 3;
const exact modulus = sin(amplitude / 2);

exact period() { return 4 * sqrt(7 * length / (5 * exact(g))) * boost::math::ellint_1(modulus); }

/// What impacts that take the slip away cost: slip d = 2 v_s g sin(phi)/a in a hop, m d^2/7 of
/// energy with it, a = g cos(phi) + v^2/length. Shares of the amplitude in Z and of the period,
/// over v_s, at the end of the first half swing and between the first and the third passage of the
/// lowest place, where the amplitude has lost 1.5 times as much. [s/m]
struct Damping {
  double turning, period;

  Damping() {
    constexpr int count = 400;  // of the midpoint rule, on a periodic function of psi
    const exact pi = boost::math::constants::pi<exact>();
    exact sum(0);
    for (int k = 0; k < count; ++k) {
      const exact sine = modulus * sin(pi * (k + exact(1) / 2) / count - pi / 2);  // of phi/2
      const exact phi = 2 * asin(sine);
      const exact pressing = exact(g) * (cos(phi) + exact(10) / 7 * (cos(phi) - cos(amplitude)));
      sum += sin(phi) * sin(phi) / pressing / sqrt(1 - sine * sine);
    }
    const exact integral = sum * pi / count * sqrt(7 * length / (5 * exact(g)));
    const exact lost = 2 * exact(g) * integral / (7 * length * sin(amplitude));
    const exact K = boost::math::ellint_1(modulus), E = boost::math::ellint_2(modulus);
    const exact slope =
        (E / (modulus * (1 - modulus * modulus)) - K / modulus) * cos(amplitude / 2) / 2;
    turning = static_cast<double>(lost / tan(amplitude));
    period = static_cast<double>(lost * exact(3) / 2 * slope / K);
  }
};

struct Errors {
  double period = 0, turning = 0;  ///< relative

  Errors(double v_s, double min_tangential, ImpactBound& bound) {
    const Law law{v_s, 1, min_tangential};
    const exact hop = decimal(v_s) * decimal(v_s) / (2 * exact(g) * cos(amplitude));
    const exact y = -(length - hop) * cos(amplitude), z = (length - hop) * sin(amplitude);
    // A rolling ball presses at most with g + v^2/length, v^2 = 10/7 g length (1 - cos 60 deg). Its
    // slip is at most 2 v_s tan 60 deg, 2/7 of which is less than v_s.
    const double l = static_cast<double>(length), fastest = std::sqrt(5.0 / 7 * g * l) + v_s;
    OneBall<double> run(
        still_case({0, -g, 0}, law, {0, y, z}, at_rest), 2, g + fastest * fastest / l);
    std::vector<double> passages;  // of the lowest place
    double before = 1, furthest = 0;
    run.watch = [&](const auto& impact) {
      const double now = run.simulation().flight(0).position[2];
      if ((before > 0) != (now > 0))  // in the flight that ends here, in which Z is linear in time
        passages.push_back(run.seconds(impact) - now / impact.velocity_before[0][2]);
      if (passages.size() == 1) furthest = std::min(furthest, now);
      before = now;
    };
    run.at(1.3 * static_cast<double>(pendulum::period()));
    bound.add(run);
    EXPECT_EQ(passages.size(), 3u);
    if (passages.size() != 3) return;
    period = std::abs((passages[2] - passages[0]) / static_cast<double>(pendulum::period()) - 1);
    turning = std::abs(furthest / static_cast<double>(length * sin(amplitude)) + 1);
  }
};

TEST(SustainedContact, ABallRollsToAndFroInACylinder) {
  sustained.say("pendulum, period " + period().str(12) + " s");
  const std::string name = "pendulum, e_t >= 0";
  const Damping damping;
  Convergence in_period(name + ", period"), in_turning(name + ", far turning point");
  ImpactBound bound;
  for (const double v_s : two_decades) {
    const Errors errors(v_s, 0, bound);
    in_period.add(v_s, errors.period);
    in_turning.add(v_s, errors.turning);
  }
  in_period.expect_order(1, 0.01);
  in_period.expect_factor(damping.period, 0.01);
  in_turning.expect_order(1, 0.01);
  in_turning.expect_factor(damping.turning, 0.01);
  bound.expect(name, 1e-6);
}

/// Slip that is reversed costs nothing, and what is left is of second order.
TEST(SustainedContact, ABallWithReversedSlipRollsToAndFroInACylinder) {
  const std::string name = "pendulum, e_t >= -1";
  Convergence in_period(name + ", period");
  ImpactBound bound;
  for (const double v_s : {1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4}) {
    const Errors errors(v_s, -1, bound);
    in_period.add(v_s, errors.period);
  }
  in_period.expect_order(2, 0.2);
  bound.expect(name, 1e-6);
}

}  // namespace pendulum
}  // namespace
}  // namespace edmill::verification
