// Contact laws of the normal restitution against what they stand for: the equation of motion of the
// contact, the energy of loading and unloading, the table.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core.hpp"
#include "model/contact_law.hpp"

namespace edmill::model {
namespace {

constexpr CoulombSlip<double> no_slip{0, -1};

/// What is left of the approach speed 1 in x" + x^(3/2) + b x^(1/2) x' = 0 when the force vanishes,
/// by Runge-Kutta of the fourth order.
double restitution_by_integration(double b) {
  const auto force = [b](double x, double v) {
    const double root = std::sqrt(std::max(x, 0.0));
    return -(root * root * root + b * root * v);
  };
  const double h = 1e-4;
  double x = 0, v = 1;
  for (;;) {
    const double v1 = v, a1 = force(x, v);
    const double v2 = v + h / 2 * a1, a2 = force(x + h / 2 * v1, v2);
    const double v3 = v + h / 2 * a2, a3 = force(x + h / 2 * v2, v3);
    const double v4 = v + h * a3, a4 = force(x + h * v3, v4);
    x += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    if (v < 0 && force(x, v) >= 0) return -v;
  }
}

TEST(FifthRoot, IsWithinThreeRoundingsOfAWiderOne) {
  std::mt19937_64 random(20110501);
  std::uniform_real_distribution<double> exponent(-300, 300), mantissa(1, 10);
  for (int k = 0; k < 2000; ++k) {
    const double x = mantissa(random) * std::pow(10.0, std::floor(exponent(random)));
    const mpfr50 root = numerics::fifth_root(mpfr50(x));
    EXPECT_LE(abs(mpfr50(root * root * root * root * root / x - 1)), 20 * epsilon<mpfr50>()) << x;
    EXPECT_LE(std::abs(static_cast<double>(mpfr50(numerics::fifth_root(x) / root - 1))),
        3 * epsilon<double>())
        << x;
  }
  EXPECT_EQ(numerics::fifth_root(0.0), 0);
  EXPECT_EQ(numerics::fifth_root(1.0), 1);
}

// The rational approximation is within 0.009 of the equation of motion for v* up to 2, where e_n is
// 0.09; for v* up to 0.6, e_n from 1 to 0.68, within 0.001.
TEST(Viscoelastic, FollowsTheEquationOfMotion) {
  for (const double v : {0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0, 1.3, 1.6, 2.0}) {
    const double integrated = restitution_by_integration(v * v);
    EXPECT_NEAR(Viscoelastic<double>::by_scaled_speed(v), integrated, v <= 0.6 ? 1e-3 : 9e-3) << v;
  }
}

// Two terms of the series in v*^2 with the constants of Ramirez et al. 1999.
TEST(Viscoelastic, BeginsAsTheSeriesDoes) {
  for (const double v : {0.01, 0.02, 0.05}) {
    const double b = v * v, series = 1 - 1.153449 * b + 0.798267 * b * b;
    EXPECT_NEAR(Viscoelastic<double>::by_scaled_speed(v), series, 0.4 * b * b * v + 4e-6 * b) << v;
  }
}

// In SI units, for two bodies and a wall: the equation of motion itself with the stiffness of
// Hertz.
TEST(Viscoelastic, ScalesWithBodiesAndSpeed) {
  const Viscoelastic<double> law{no_slip, 2e8, 4e-6};
  for (const auto& bodies :
      {ContactBodies<double>{4e-4, 2.4e-3}, ContactBodies<double>{2e-4, 2e-3, 3e-3}})
    for (const double speed : {0.01, 0.5, 3.0}) {
      const double radius = bodies.with_wall() ? 2.4e-3 : 1.2e-3;
      const double k = 4.0 / 3 * 2e8 * std::sqrt(radius) / bodies.effective_mass;
      const double b = 1.5 * 4e-6 * std::pow(k, 0.4) * std::pow(speed, 0.2);
      EXPECT_NEAR(law.restitution(speed, bodies), restitution_by_integration(b), 9e-3) << speed;
    }
  EXPECT_EQ(law.restitution(0, {4e-4, 2.4e-3}), 1);
}

// Loading by Hertz up to the yield pressure and by a constant pressure beyond; unloading by Hertz
// with the flattened radius. The restitution is the root of what is given back over what was put
// in.
TEST(ElasticPlastic, GivesBackTheEnergyOfUnloading) {
  const double modulus = 1e11, pressure = 2e9, radius = 2e-3, mass = 5e-4, pi = std::acos(-1.0);
  const ElasticPlastic<double> law{no_slip, modulus, pressure};
  const ContactBodies<double> bodies{mass, radius};
  const double a = pi * pressure * radius / (2 * modulus), depth = a * a / radius;
  const double yield_force = 4.0 / 3 * modulus * std::sqrt(radius) * std::pow(depth, 1.5);
  const double yield = std::sqrt(0.8 * yield_force * depth / mass);
  EXPECT_NEAR(law.yield_speed(bodies) / yield, 1, 1e-14);
  for (const double ratio : {1.0001, 1.5, 3.0, 10.0, 100.0}) {
    const double speed = ratio * yield, put_in = mass / 2 * speed * speed;
    const double slope = pi * pressure * radius;
    const double beyond = (-yield_force +
                              std::sqrt(yield_force * yield_force +
                                  2 * slope * (put_in - 0.4 * yield_force * depth))) /
        slope;
    const double force = yield_force + slope * beyond;
    const double flattened =
        4 * modulus / (3 * force) * std::pow((2 * force + yield_force) / (2 * pi * pressure), 1.5);
    const double back = std::pow(force / (4.0 / 3 * modulus * std::sqrt(flattened)), 2.0 / 3);
    EXPECT_NEAR(law.restitution(speed, bodies), std::sqrt(0.4 * force * back / put_in), 1e-12)
        << ratio;
  }
  EXPECT_EQ(law.restitution(yield * 0.999, bodies), 1);
}

TEST(ElasticPlastic, FallsWithTheFourthRootOfTheSpeed) {
  const ElasticPlastic<double> law{no_slip, 1e11, 1e8};
  const ContactBodies<double> bodies{5e-4, 2e-3};
  const double at = law.restitution(10, bodies), beyond = law.restitution(160, bodies);
  EXPECT_NEAR(at / beyond, 2, 1e-3);
}

// (6 3^(1/2) / 5)^(1/2) (2 (6/5)^(1/2))^(-1/4) = 1.1850: the limit of e_n (v/v_y)^(1/4) at large
// speed.
TEST(ElasticPlastic, HasTheFactorOfTheClosedForm) {
  const ElasticPlastic<double> law{no_slip, 1e11, 1e8};
  const ContactBodies<double> bodies{5e-4, 2e-3};
  const double speed = 1e4, ratio = speed / law.yield_speed(bodies);
  EXPECT_NEAR(law.restitution(speed, bodies) * std::pow(ratio, 0.25), 1.1850, 1e-4);
}

TEST(RestitutionBySpeed, IsTheTableAndMonotoneBetweenItsPoints) {
  const RestitutionBySpeed<double> law{
      no_slip, {{{0.1, 0.9}}, {{1, 0.7}}, {{2, 0.65}}, {{8, 0.25}}}};
  EXPECT_EQ(law.restitution(0), 0.9);
  for (const auto& point : law.points) EXPECT_EQ(law.restitution(point[0]), point[1]);
  EXPECT_EQ(law.restitution(100), 0.25);
  EXPECT_NEAR(law.restitution(5), 0.45, 1e-15);
  double last = 1;
  for (int k = 0; k <= 1000; ++k) {
    const double e = law.restitution(k * 0.01);
    EXPECT_LE(e, last) << k;
    last = e;
  }
}

TEST(RestitutionBySlip, IsTheTableAndSlidesBeyondIt) {
  const RestitutionBySlip<double> law{0.6, {{{0, -0.5}}, {{1, -0.4}}, {{4, 0.2}}}};
  const double approach = 2, change = (1 + 0.6) * approach, compliance = 3.5;
  const auto at = [&](double ratio) {
    return law.restitution_of_slip(change, ratio * approach, compliance);
  };
  EXPECT_EQ(law.restitution(3), 0.6);
  for (const auto& point : law.points) EXPECT_NEAR(at(point[0]), point[1], 1e-15);
  EXPECT_NEAR(at(2.5), -0.1, 1e-15);
  // The impulse along the surface is (1 - e_t) times the slip over the compliance.
  for (const double ratio : {4.0, 5.0, 40.0, 4e6})
    EXPECT_NEAR((1 - at(ratio)) * ratio, 0.8 * 4, 1e-9) << ratio;
  // Without an approach nothing is left to slip: no impulse.
  EXPECT_EQ(law.restitution_of_slip(0, 1, compliance), 1);
  EXPECT_EQ(law.restitution_of_slip(0, 0, compliance), 0.2);
}

// Table 5.3 of the thesis at its points; between them the plain mean.
TEST(PowderLoad, IsTheTableOfTheThesis) {
  const double table[3][4] = {
      {0.56, 0.54, 0.53, 0.50}, {0.64, 0.60, 0.56, 0.52}, {0.80, 0.74, 0.64, 0.55}};
  const double ratios[3] = {2.5, 5, 10}, millimetres[4] = {2.36, 3.16, 4.76, 9.52};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) {
      const PowderLoad<double> law{no_slip, ratios[row]};
      const double radius = millimetres[column] / 2000;
      EXPECT_NEAR(law.restitution(1, {1, radius}), table[row][column], 1e-15);
      EXPECT_NEAR(law.restitution(3, {1, radius, radius}), table[row][column], 1e-15);
    }
  const PowderLoad<double> between{no_slip, 3.75};
  EXPECT_NEAR(between.restitution(1, {1, 3.96e-3 / 2}), (0.54 + 0.53 + 0.60 + 0.56) / 4, 1e-14);
}

}  // namespace
}  // namespace edmill::model
