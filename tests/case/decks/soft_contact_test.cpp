#include "decks/soft_contact.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace edmill;

namespace {

/// The contact by an integration of its own: Heun's method with steps of 1e-5, in units of m = K =
/// speed = 1.
struct Rebound {
  double separation, duration;
};
Rebound rebound_by_heun(double damping, double press = 0) {
  const double h = 1e-5;
  double x = 1e-12, v = 1;
  const auto acceleration = [&](double place, double speed) {
    const double s = std::max(place, 0.0);
    return press - std::max(0.0, std::pow(s, 1.5) + damping * std::pow(s, 0.25) * speed);
  };
  for (double t = h;; t += h) {
    const double a = acceleration(x, v), x1 = x + h * v, v1 = v + h * a, b = acceleration(x1, v1);
    x += h / 2 * (v + v1), v += h / 2 * (a + b);
    if (x <= 0 || t > 50) return {-v, t};
  }
}

TEST(SoftContact, RestitutionIsThatOfItsEquation) {
  for (const double damping : {0.0, 0.05, 0.2, 0.4, 0.8, 1.2})
    EXPECT_NEAR(decks::restitution_of(damping, 20000), rebound_by_heun(damping).separation, 2e-4)
        << damping;
}

/// Separation is e - press_effect(e) p, with p the speed that the press would give meanwhile over
/// the approach.
TEST(SoftContact, APressTakesOffItsEffect) {
  for (const double e : {0.3, 0.52, 0.6, 0.77, 0.9})
    for (const double press : {-0.02, 0.005, 0.02}) {
      const double damping = decks::damping_for(e, 20000);
      const auto found = rebound_by_heun(damping, press);
      const double p = press * found.duration;
      EXPECT_NEAR(found.separation,
          rebound_by_heun(damping).separation - decks::press_effect(e) * p,
          0.04 * 0.45 * std::abs(p))
          << e << " " << press;
    }
  EXPECT_NEAR(decks::press_effect(1), 0, 1e-12);
}

TEST(SoftContact, DampingIsItsInverse) {
  for (const double e : {0.1, 0.3, 0.52, 0.6, 0.8, 0.95})
    for (const int steps : {20, 50, 1000})
      EXPECT_NEAR(decks::restitution_of(decks::damping_for(e, steps), steps), e, 1e-6);
  EXPECT_EQ(decks::damping_for(1, 50), 0);
}

/// By bisection on the rebounds of LAMMPS 29 Sep 2021 itself, 50 steps a contact.
TEST(SoftContact, IsThatOfLammps) {
  EXPECT_NEAR(decks::lammps_restitution(decks::damping_for(0.6, 50)), 0.43805, 2e-4);
}

TEST(SoftContact, YoungsModulusGivesTheDurationOfHertz) {
  // Steel-like ball: the duration from the modulus by Hertz's formula for a flat wall.
  const double radius = 0.004, mass = 8000 * 4.0 / 3 * std::acos(-1.0) * std::pow(radius, 3),
               poisson = 0.3;
  const double young = decks::young_for(50e-6, 1, radius, mass, poisson);
  const double effective = young / (2 * (1 - poisson * poisson));
  EXPECT_NEAR(2.868 * std::pow(mass * mass / (radius * effective * effective), 0.2), 50e-6, 1e-12);
}

}  // namespace
