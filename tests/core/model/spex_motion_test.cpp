// The nested motion of the vessel: (2.16'), its velocity and acceleration, and why the printed
// (2.14) is not it.
#include <gtest/gtest.h>

#include "core.hpp"
#include "model/motion.hpp"
#include "random_physics.hpp"
#include "spex_case.hpp"

namespace edmill::model {
namespace {

using testing::draw;
using testing::draw_vector;

/// Derivative of a function of time by a central difference with two Richardson steps, in 50
/// digits: error of order h^6, far below the comparison's tolerance.
template <class Function> Vec3<mpfr> derivative(Function&& f, const mpfr& t) {
  const mpfr h("1e-7");
  const auto central = [&](const mpfr& step) {
    return Vec3<mpfr>((f(t + step) - f(t - step)) * (1 / (2 * step)));
  };
  const Vec3<mpfr> a = central(h), b = central(h / 2), c = central(h / 4);
  const Vec3<mpfr> ab = (b * mpfr(4) - a) * (mpfr(1) / 3), bc = (c * mpfr(4) - b) * (mpfr(1) / 3);
  return (bc * mpfr(16) - ab) * (mpfr(1) / 15);
}

const SpexMotion<mpfr>& spex() {
  static const SpexMotion<mpfr> motion =
      *testing::spex_mill<mpfr>().motion.get_if<SpexMotion<mpfr>>();
  return motion;
}

Vec3<mpfr> wall_point(const mpfr& t, const Vec3<mpfr>& p) {
  return spex().to_inertial(spex().pose({0, t}), p);
}

TEST(SpexMotion, WallVelocityIsTheDerivativeOfTheWallPosition) {
  EXPECT_TRUE(rc::check([] {
    const Vec3<mpfr> p = draw_vector<mpfr>(mpfr("0.03"));
    const mpfr t = draw<mpfr>(mpfr(0), spex().period());
    const auto expected = derivative([&](const mpfr& s) { return wall_point(s, p); }, t);
    const auto found = spex().wall_velocity(spex().pose({0, t}), wall_point(t, p));
    RC_ASSERT(norm<mpfr>(Vec3<mpfr>(found - expected)) < mpfr("1e-30"));
  }));
}

template <class Real> void expect_nearby_poses_agree() {
  const auto motion = *testing::spex_mill<Real>().motion.template get_if<SpexMotion<Real>>();
  const Real speed = motion.angular_speed();
  EXPECT_TRUE(rc::check([&] {
    const Real t = draw<Real>(Real(0), motion.period());
    // From far below the longest turn to beyond it.
    const int exponent = *rc::gen::inRange(20, 60);
    const Real later = t + draw<Real>(Real(-1), Real(1)) * Real(std::ldexp(1.0, -exponent)) / speed;
    const auto known = motion.pose({0, t});
    const auto found = motion.pose_nearby({0, later}, known, {0, t});
    const auto direct = motion.pose({0, later});
    const Real allowed = 16 * epsilon<Real>();
    const auto close = [&](const Real& a, const Real& b, const Real& unit) {
      return abs(a - b) <= allowed * unit;
    };
    RC_ASSERT(close(found.sin_alpha, direct.sin_alpha, Real(1)) &&
        close(found.cos_alpha, direct.cos_alpha, Real(1)));
    RC_ASSERT(close(found.sin_gamma, direct.sin_gamma, Real(1)) &&
        close(found.cos_gamma, direct.cos_gamma, Real(1)));
    RC_ASSERT(close(found.theta_rate, direct.theta_rate, speed) &&
        close(found.gamma_rate, direct.gamma_rate, speed));
    RC_ASSERT(close(found.theta_acceleration, direct.theta_acceleration, speed * speed));
    RC_ASSERT(close(found.gamma_acceleration, direct.gamma_acceleration, speed * speed));
  }));
}

TEST(SpexMotion, PosesNearbyAgreeWithPosesFromSines) {
  expect_nearby_poses_agree<float128>();
  expect_nearby_poses_agree<mpfr>();
}

TEST(SpexMotion, WallAccelerationIsTheDerivativeOfTheWallVelocity) {
  EXPECT_TRUE(rc::check([] {
    const Vec3<mpfr> p = draw_vector<mpfr>(mpfr("0.03"));
    const mpfr t = draw<mpfr>(mpfr(0), spex().period());
    const auto velocity = [&](const mpfr& s) {
      return spex().wall_velocity(spex().pose({0, s}), wall_point(s, p));
    };
    const auto found = spex().wall_acceleration(spex().pose({0, t}), wall_point(t, p));
    RC_ASSERT(norm<mpfr>(Vec3<mpfr>(found - derivative(velocity, t))) < mpfr("1e-27"));
  }));
}

TEST(SpexMotion, VesselFrameRatesAreTheDerivativesOfVesselFramePositions) {
  EXPECT_TRUE(rc::check([] {
    const Vec3<mpfr> r = draw_vector<mpfr>(mpfr("0.15")), v = draw_vector<mpfr>(mpfr(5));
    const mpfr t = draw<mpfr>(mpfr(0), spex().period());
    const auto local = [&](const mpfr& s) {
      return spex().to_vessel_frame(spex().pose({0, s}), Vec3<mpfr>(r + v * (s - t)), v).position;
    };
    const auto found = spex().to_vessel_frame(spex().pose({0, t}), r, v).velocity;
    RC_ASSERT(norm<mpfr>(Vec3<mpfr>(found - derivative(local, t))) < mpfr("1e-30"));
  }));
}

TEST(SpexMotion, VesselFrameAndInertialFrameAreInverse) {
  EXPECT_TRUE(rc::check([] {
    const Vec3<mpfr> p = draw_vector<mpfr>(mpfr("0.03"));
    const auto pose = spex().pose({0, draw<mpfr>(mpfr(0), spex().period())});
    const auto back = spex().to_vessel_frame(
        pose, spex().to_inertial(pose, p), Vec3<mpfr>(mpfr(0), mpfr(0), mpfr(0)));
    RC_ASSERT(norm<mpfr>(Vec3<mpfr>(back.position - p)) < mpfr("1e-49"));
  }));
}

/// The printed (2.14), R_x(gamma) R_z(theta), about the centre (2.15).
Vec3<mpfr> printed_position(const mpfr& t, const Vec3<mpfr>& p) {
  const auto pose = spex().pose({0, t});
  const mpfr sin_theta = pose.cos_alpha, cos_theta = -pose.sin_alpha;
  const mpfr &sg = pose.sin_gamma, &cg = pose.cos_gamma, &l = spex().arm();
  return {l * cos_theta + cos_theta * p[0] - sin_theta * p[1],
      l * sin_theta + sin_theta * cg * p[0] + cos_theta * cg * p[1] - sg * p[2],
      sin_theta * sg * p[0] + cos_theta * sg * p[1] + cg * p[2]};
}

TEST(SpexMotionErrata, PrintedVelocityIsNotTheDerivativeOfThePrintedPosition) {
  const Vec3<mpfr> p(mpfr("0.01"), mpfr("0.02"), mpfr("0.005"));
  mpfr worst_printed(0), worst_nested(0);
  for (int k = 0; k < 32; ++k) {
    const mpfr t = spex().period() * k / 32;
    const auto pose = spex().pose({0, t});
    const auto error = [&](auto&& position) {
      const auto velocity = spex().wall_velocity(pose, position(t));
      return norm<mpfr>(Vec3<mpfr>(velocity - derivative(position, t)));
    };
    const mpfr printed = error([&](const mpfr& s) { return printed_position(s, p); });
    const mpfr nested = error([&](const mpfr& s) { return wall_point(s, p); });
    worst_printed = printed > worst_printed ? printed : worst_printed;
    worst_nested = nested > worst_nested ? nested : worst_nested;
  }
  EXPECT_GT(worst_printed, mpfr("0.1"));  // metres per second
  EXPECT_LT(worst_nested, mpfr("1e-30"));
}

TEST(SpexMotion, PoseIsTheThesisAnglesAtKnownPhases) {
  const auto motion = *testing::spex_mill<double>().motion.get_if<SpexMotion<double>>();
  const auto start = motion.pose({0, 0.0});                  // theta = theta_max + pi/2, gamma = 0
  EXPECT_NEAR(start.sin_alpha, 0.25881904510252074, 1e-15);  // sin 15 deg
  EXPECT_NEAR(start.cos_alpha, 0.9659258262890683, 1e-15);
  EXPECT_EQ(start.sin_gamma, 0);
  const auto quarter = motion.pose({0, motion.period() / 4});  // theta = pi/2, gamma = gamma_max
  EXPECT_NEAR(quarter.sin_alpha, 0, 1e-15);
  EXPECT_NEAR(quarter.sin_gamma, 0.25881904510252074, 1e-15);
  EXPECT_NEAR(quarter.theta_rate, -motion.theta_max() * motion.angular_speed(), 1e-12);
}

}  // namespace
}  // namespace edmill::model
