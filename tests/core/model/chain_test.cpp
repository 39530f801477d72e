// Chains of joints: closed forms, phases after a long time, and the SPEX as a chain.
#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <iostream>
#include <random>

#include "any_mills.hpp"
#include "mill_parts.hpp"
#include "random_physics.hpp"

namespace edmill::model {
namespace {

using boost::multiprecision::cpp_int;
using boost::multiprecision::cpp_rational;
using testing::draw;

template <class Real> AnyMotion<Real> motion_of(const std::string& mill) {
  const auto spec = casefile::parse_case("[run]\nend_time = \"1 s\"\n[mill]\n" + mill +
          "\n[vessel]\ndiameter = \"38 mm\"\nheight = \"57 mm\"\n[contact]\nfriction = 0.4\n"
          "restitution = 0.5\n[[balls]]\ndiameter = \"5 mm\"\n",
      "chain.toml");
  return casefile::build_mill<Real>(spec).motion;
}

template <class Real> Real distance(const Vec3<Real>& a, const Vec3<Real>& b) {
  return norm<Real>(Vec3<Real>(a - b));
}

/// Whole turns taken off k times the fraction, in exact numbers.
TEST(TurnFraction, IsExactForAnyNumberOfPeriods) {
  std::mt19937_64 random(20261123);
  for (int k = 0; k < 2000; ++k) {
    TurnFraction fraction;
    cpp_int numerator = 0;
    for (auto& word : fraction.bits) {
      word = k % 3 == 0 ? (random() % 2 ? ~std::uint64_t{0} : 0) : random();
      numerator = (numerator << 64) + word;
    }
    const auto count =
        static_cast<std::int64_t>(random() >> (1 + random() % 62)) * (random() % 2 ? 1 : -1);
    cpp_rational turns = cpp_rational(numerator, cpp_int(1) << 1024) * count;
    const cpp_rational doubled = 2 * turns + 1;
    cpp_int whole = boost::multiprecision::numerator(doubled) /
        (2 * boost::multiprecision::denominator(doubled));
    turns -= whole;
    for (int step = 0; step < 2 && turns > cpp_rational(1, 2); ++step) turns -= 1;
    for (int step = 0; step < 2 && turns < cpp_rational(-1, 2); ++step) turns += 1;
    using Exact = mpfr_of<200>;
    const Exact exact = Exact(boost::multiprecision::numerator(turns)) /
        Exact(boost::multiprecision::denominator(turns));
    const auto off = [&](const Exact& found) {  // as an angle: -1/2 and 1/2 are one
      const Exact d = abs(found - exact);
      return static_cast<double>(d < 1 - d ? d : Exact(1 - d));
    };
    ASSERT_LE(off(Exact(fraction.times<double>(count))), 0x1p-53);
    ASSERT_LE(off(Exact(fraction.times<float128>(count))), 0x1p-113);
    ASSERT_LE(off(Exact(fraction.times<mpfr50>(count))), 1e-49);
  }
}

/// A slide on an arm that turns about z: the centre is on a spiral, r = a + v t.
TEST(Chain, ASlideOnAnArmMakesASpiral) {
  const auto motion = motion_of<mpfr>(
      "type = \"chain\"\n[[mill.joint]]\nrotate = \"z\"\nspeed = \"90 rpm\"\n[[mill.joint]]\n"
      "translate = \"x\"\ndistance = \"20 mm\"\nspeed = \"-0.07 m/s\"");
  const mpfr w = 3 * numerics::pi<mpfr>(), v("-0.07");
  for (const int k : {0, 1, 2}) {
    const mpfr offset = motion.period() * k / 3, t = offset + k * motion.period(),
               r = mpfr("0.02") + v * t;
    const auto pose = std::get<ChainPose<mpfr>>(motion.pose({k, offset}));
    const Vec3<mpfr> out{cos(w * t), sin(w * t), mpfr(0)}, along{-sin(w * t), cos(w * t), mpfr(0)};
    EXPECT_LT(static_cast<double>(distance<mpfr>(pose.centre, out * r)), 1e-47);
    EXPECT_LT(
        static_cast<double>(distance<mpfr>(pose.velocity, out * v + along * mpfr(r * w))), 1e-46);
    EXPECT_LT(static_cast<double>(distance<mpfr>(
                  pose.acceleration, along * mpfr(2 * v * w) - out * mpfr(r * w * w))),
        1e-45);
  }
}

/// Vertical is Y: the jar's centre runs on a circle about it, a point of the jar on an epicycle.
TEST(Chain, APlanetaryJarRunsOnItsEpicycle) {
  const auto motion = motion_of<mpfr>(
      "type = \"planetary\"\nradius = \"75 mm\"\nspeed = \"400 rpm\"\nratio = -2.18");
  const mpfr pi = numerics::pi<mpfr>(), disc = 2 * pi * 400 / 60, jar = disc * mpfr("-1.18");
  const mpfr radius("0.075"), r("0.013"), h("0.02");
  for (const int k : {0, 1, 7, 100}) {
    const mpfr offset = motion.period() * k / 101, t = offset + k * motion.period();
    const auto pose = motion.pose({k, offset});
    // About Y from z to x: x = cos, z = -sin.
    const Vec3<mpfr> expected{
        radius * cos(disc * t) + r * cos(jar * t), h, -radius * sin(disc * t) - r * sin(jar * t)};
    const Vec3<mpfr> velocity{-radius * disc * sin(disc * t) - r * jar * sin(jar * t), mpfr(0),
        -radius * disc * cos(disc * t) - r * jar * cos(jar * t)};
    const Vec3<mpfr> point = motion.to_inertial(pose, Vec3<mpfr>{r, h, mpfr(0)});
    EXPECT_LT(static_cast<double>(distance<mpfr>(point, expected)), 1e-47);
    EXPECT_LT(
        static_cast<double>(distance<mpfr>(motion.wall_velocity(pose, point), velocity)), 1e-45);
  }
}

/// 3 mm along (1, 2, 2) are 1, 2 and 2 mm along x, y and z.
TEST(Chain, ASwingAlongAnyAxisIsThreeAlongTheAxes) {
  const auto swing = [](const std::string& along, const std::string& amplitude) {
    return "[[mill.joint]]\ntranslate = " + along + "\nswing = [{amplitude = \"" + amplitude +
        "\", speed = \"31 rad/s\", phase = \"1 rad\"}]\n";
  };
  const std::string before =
      "type = \"chain\"\n[[mill.joint]]\nrotate = \"z\"\nspeed = \"300 rpm\"\n";
  const auto one = motion_of<float128>(before + swing("[1, 2, 2]", "3 mm"));
  const auto three = motion_of<float128>(
      before + swing("\"x\"", "1 mm") + swing("\"y\"", "2 mm") + swing("\"z\"", "2 mm"));
  const Vec3<float128> p(float128(0.01), float128(-0.02), float128(0.005));
  for (int k = 0; k < 100; ++k) {
    const Instant<float128> when{k, float128(k) / 1000};
    const auto a = one.pose(when), b = three.pose(when);
    EXPECT_LT(distance<float128>(one.to_inertial(a, p), three.to_inertial(b, p)), 1e-32);
    EXPECT_LT(distance<float128>(one.wall_velocity(a, p), three.wall_velocity(b, p)), 1e-30);
  }
}

TEST(Chain, ADrumTurnsAboutItsHorizontalAxis) {
  const auto motion = motion_of<double>("type = \"drum\"\nspeed = \"60 rpm\"");
  for (const double t : {0.0, 0.1, 0.7}) {
    const auto pose = motion.pose({0, t});
    EXPECT_LT(distance<double>(motion.axis_y(pose), {0, 0, 1}), 1e-15);
    EXPECT_LT(distance<double>(motion.angular_velocity(pose), {0, 0, 2 * M_PI}), 1e-14);
  }
}

TEST(Chain, TheSpexAsAChainIsTheSpex) {
  const std::string speed = ", speed = \"1098 rpm\"";
  const auto chain = motion_of<mpfr>(
      "type = \"chain\"\n[[mill.joint]]\nrotate = \"z\"\nangle = \"90 deg\"\nswing = [{amplitude = "
      "\"15 "
      "deg\"" +
      speed +
      ", phase = \"90 deg\"}]\n[[mill.joint]]\ntranslate = [\"10 cm\", 0, "
      "0]\n[[mill.joint]]\nrotate = "
      "\"x\"\n"
      "swing = [{amplitude = \"15 deg\"" +
      speed + "}]");
  const auto spex = motion_of<mpfr>("type = \"spex8000\"");
  EXPECT_EQ(chain.period(), spex.period());
  const Vec3<mpfr> p{mpfr("0.01"), mpfr("-0.02"), mpfr("0.003")};
  for (int k = 0; k < 20; ++k) {
    const Instant<mpfr> when{k, spex.period() * k / 20};
    const auto a = chain.pose(when);
    const auto b = spex.pose(when);
    const Vec3<mpfr> place = spex.to_inertial(b, p);
    EXPECT_LT(static_cast<double>(distance<mpfr>(chain.to_inertial(a, p), place)), 1e-47);
    EXPECT_LT(static_cast<double>(
                  distance<mpfr>(chain.wall_velocity(a, place), spex.wall_velocity(b, place))),
        1e-45);
    EXPECT_LT(static_cast<double>(distance<mpfr>(
                  chain.wall_acceleration(a, place), spex.wall_acceleration(b, place))),
        1e-43);
  }
}

/// Joints without a common period: the pose after 1e6 s, and after 1e9 drive periods, is as sharp
/// as at the start.
TEST(Chain, PhasesStaySharp) {
  const auto narrow = motion_of<double>(testing::skew_chain);
  const auto wide = motion_of<float128>(testing::skew_chain);
  const mpfr::Digits digits(200);
  const auto exact = motion_of<mpfr>(testing::skew_chain);
  const auto periods = static_cast<std::int64_t>(1e6 / narrow.period());
  const Vec3<double> p{0.01, -0.02, 0.015};
  double first = 0, late = 0, late_wide = 0;
  for (int k = 0; k < 500; ++k) {
    for (const std::int64_t period : {std::int64_t{0}, periods + k, std::int64_t{1000000000} + k}) {
      const double offset = narrow.period() * k / 500;
      const auto place = narrow.to_inertial(narrow.pose({period, offset}), p);
      const auto wider =
          wide.to_inertial(wide.pose({period, float128(offset)}), vector_cast<float128>(p));
      const auto truth =
          exact.to_inertial(exact.pose({period, mpfr(offset)}), vector_cast<mpfr>(p));
      const double off = static_cast<double>(distance<mpfr>(vector_cast<mpfr>(place), truth));
      const double off_wide = static_cast<double>(distance<mpfr>(vector_cast<mpfr>(wider), truth));
      (period == 0 ? first : late) = std::max(period == 0 ? first : late, off);
      if (period != 0) late_wide = std::max(late_wide, off_wide);
    }
  }
  std::cout << "largest error of a place: " << first << " m in the first period, " << late
            << " m after 1e6 s and 1e9 periods, " << late_wide << " m there in float128\n";
  EXPECT_LT(first, 1e-16);
  EXPECT_LT(late, 1e-16);
  EXPECT_LT(late_wide, 1e-34);
}

class AnyChain : public ::testing::TestWithParam<testing::MillText> {};
INSTANTIATE_TEST_SUITE_P(All, AnyChain, ::testing::ValuesIn(testing::all_mills),
    [](const auto& info) { return std::string(info.param.name); });

TEST_P(AnyChain, NothingLeavesTheSweptBoxNorIsFasterThanItsBounds) {
  const auto mill = testing::mill_of(GetParam());
  const auto& motion = mill.motion;
  const auto box = motion.swept(mill.vessel.half_sizes(), mill.vessel.reach());
  const double reach = motion.reach(mill.vessel.reach());
  EXPECT_TRUE(rc::check([&] {
    // Small cases of the property would draw the same place, outside the vessel, again and again.
    std::mt19937_64 random(*rc::gen::arbitrary<std::uint64_t>());
    std::uniform_real_distribution<double> part(-1, 1);
    std::optional<Vec3<double>> p;
    while (!p) {
      const double x = part(random), y = part(random), z = part(random);
      p = mill.vessel.place({x, y, z});
    }
    const auto pose =
        motion.pose({*rc::gen::inRange<std::int64_t>(0, testing::slides(mill) ? 20 : 1000),
            draw(0.0, motion.period())});
    const Vec3<double> place = motion.to_inertial(pose, *p);
    for (int axis = 0; axis < 3; ++axis)
      RC_ASSERT(place[axis] >= box.low[axis] && place[axis] <= box.high[axis]);
    RC_ASSERT(place.norm() <= reach);
    RC_ASSERT(motion.wall_velocity(pose, place).norm() <= motion.wall_speed(mill.vessel.reach()));
    RC_ASSERT(motion.wall_velocity(pose, place).norm() <= motion.speed_within(place.norm()));
    RC_ASSERT(
        motion.wall_acceleration(pose, place).norm() <= motion.acceleration_within(place.norm()));
  }));
}

}  // namespace
}  // namespace edmill::model
