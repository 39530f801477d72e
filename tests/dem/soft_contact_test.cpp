#include "dem/soft_contact.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace edmill;

namespace {

/// The contact by an integration of its own: Heun's method with steps of 1e-5, in units of m = K = speed = 1.
double restitution_by_heun(double damping) {
  const double h = 1e-5;
  double x = 1e-12, v = 1;
  const auto force = [&](double place, double speed) {
    const double s = std::max(place, 0.0);
    return std::pow(s, 1.5) + damping * std::pow(s, 0.25) * speed;
  };
  for (;;) {
    const double a = -force(x, v), x1 = x + h * v, v1 = v + h * a, b = -force(x1, v1);
    x += h / 2 * (v + v1), v += h / 2 * (a + b);
    if (v < 0 && (force(x, v) <= 0 || x <= 0)) return -v;
  }
}

TEST(SoftContact, RestitutionIsThatOfItsEquation) {
  for (const double damping : {0.0, 0.05, 0.2, 0.4, 0.8, 1.2})
    EXPECT_NEAR(dem::restitution_of(damping, 20000), restitution_by_heun(damping), 2e-4) << damping;
}

TEST(SoftContact, DampingIsItsInverse) {
  for (const double e : {0.1, 0.3, 0.52, 0.6, 0.8, 0.95})
    for (const int steps : {20, 50, 1000})
      EXPECT_NEAR(dem::restitution_of(dem::damping_for(e, steps), steps), e, 1e-6);
  EXPECT_EQ(dem::damping_for(1, 50), 0);
}

/// By bisection on the rebounds of LAMMPS 29 Sep 2021 itself, 50 steps a contact.
TEST(SoftContact, IsThatOfLammps) {
  EXPECT_NEAR(dem::lammps_restitution(dem::damping_for(0.6, 50)), 0.43805, 2e-4);
}

TEST(SoftContact, YoungsModulusGivesTheDurationOfHertz) {
  // Steel-like ball: the duration from the modulus by Hertz's formula for a flat wall.
  const double radius = 0.004, mass = 8000 * 4.0 / 3 * std::acos(-1.0) * std::pow(radius, 3), poisson = 0.3;
  const double young = dem::young_for(50e-6, 1, radius, mass, poisson);
  const double effective = young / (2 * (1 - poisson * poisson));
  EXPECT_NEAR(2.868 * std::pow(mass * mass / (radius * effective * effective), 0.2), 50e-6, 1e-12);
}

}  // namespace
