#include "dem/soft_contact.hpp"

#include <cmath>

#include "base/trigonometry.hpp"

namespace edmill::dem {

namespace {

/// x with f(x) = value, of an f that falls between low and high.
template <class F>
double where_falling(const F& f, double value, double low, double high) {
  for (int k = 0; k < 60; ++k) {
    const double middle = (low + high) / 2;
    (f(middle) > value ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace

double restitution_of(double damping, int steps, Separation separation) {
  // In units in which m = K = 1 and the speed of the approach is 1. Without damping a contact lasts 3.218.
  const double step = 3.218 / steps;
  constexpr int places = 8;  // of the touch between two steps
  double sum = 0;
  for (int place = 0; place < places; ++place) {
    double x = step * (place + 0.5) / places, v = 1;
    // With much damping a contact creeps: what has not parted by then does not.
    for (int k = 0; x > 0 && k < 50 * steps; ++k) {
      const double root = std::sqrt(x), force = x * root + damping * std::sqrt(root) * v;
      if (force > 0 || separation == Separation::attracts) v -= step * force;
      x += step * v;
    }
    if (x <= 0) sum -= v;
  }
  return sum / places;
}

double damping_for(double restitution, int steps, Separation separation) {
  if (restitution >= 1) return 0;
  return where_falling([&](double damping) { return restitution_of(damping, steps, separation); },
                       restitution, 0, 8);
}

double lammps_restitution(double damping) {
  const auto polynomial = [](double e) {
    return 1.2728 + e * (-4.2783 + e * (11.087 + e * (-22.348 + e * (27.467 + e * (-18.022 + e * 4.8218)))));
  };
  return where_falling(polynomial, damping, 0, 1);
}

double formula_restitution(double damping) {
  // damping = sqrt(5) b, b = -ln e / sqrt(ln^2 e + pi^2).
  const double b = damping / std::sqrt(5.0);
  return std::exp(-numerics::pi<double>() * b / std::sqrt(1 - b * b));
}

double young_for(double contact_time, double speed, double radius, double mass, double poisson) {
  // Hertz: duration = 2.868 (m^2 / (R E*^2 v))^(1/5) against a flat wall.
  const double effective = mass / std::sqrt(radius * speed) * std::pow(2.868 / contact_time, 2.5);
  return 2 * (1 - poisson * poisson) * effective;
}

}  // namespace edmill::dem
