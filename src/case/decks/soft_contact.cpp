#include "decks/soft_contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/trigonometry.hpp"

namespace edmill::decks {

namespace {

/// Solves f(x) = value between low and high for a decreasing f.
double where_falling(const auto& f, double value, double low, double high) {
  for (int k = 0; k < 60; ++k) {
    const double middle = (low + high) / 2;
    (f(middle) > value ? low : high) = middle;
  }
  return (low + high) / 2;
}

struct Bounce {
  double separation = 0;  ///< speed over that of the approach; 0 where the bodies do not part
  double duration = 0;
};

/// Integrates a contact in units of m = K = 1 and approach speed 1. Without damping it lasts 3.218.
/// @param place  position of the touch between two steps, 0 to 1
/// @param press  acceleration towards each other, in addition to the contact's own force
Bounce bounce(double damping, int steps, double place, Separation separation, double press = 0) {
  const double step = 3.218 / steps;
  double x = step * place, v = 1;
  int k = 0;
  // With much damping a contact creeps: bodies that have not separated by then never do.
  for (; x > 0 && k < 50 * steps; ++k) {
    const double root = std::sqrt(x), force = x * root + damping * std::sqrt(root) * v;
    v += step * press;
    if (force > 0 || separation == Separation::attracts) v -= step * force;
    x += step * v;
  }
  return {x <= 0 ? -v : 0, k * step};
}

}  // namespace

double restitution_of(double damping, int steps, Separation separation) {
  constexpr int places = 8;  // of the touch between two steps
  double sum = 0;
  for (int place = 0; place < places; ++place)
    sum += bounce(damping, steps, (place + 0.5) / places, separation).separation;
  return sum / places;
}

double damping_for(double restitution, int steps, Separation separation) {
  if (restitution >= 1) return 0;
  return where_falling([&](double damping) { return restitution_of(damping, steps, separation); },
      restitution, 0, 8);
}

double press_effect(double restitution) {
  constexpr int steps = 2000, intervals = 20;
  constexpr double press = 0.003;
  static const auto effects = [] {
    std::array<double, intervals + 1> values{};
    for (int k = 1; k < intervals; ++k) {
      const double damping = damping_for(k / double{intervals}, 100);
      const auto at_rest = bounce(damping, steps, 0.5, Separation::free);
      const auto pressed = bounce(damping, steps, 0.5, Separation::free, press);
      values[static_cast<std::size_t>(k)] =
          (at_rest.separation - pressed.separation) / (press * pressed.duration);
    }
    values[0] = values[1];
    return values;
  }();
  const double place = std::clamp(restitution, 0.0, 1.0) * intervals;
  const auto low = std::min(static_cast<std::size_t>(place), std::size_t{intervals - 1});
  return effects[low] + (place - static_cast<double>(low)) * (effects[low + 1] - effects[low]);
}

double lammps_restitution(double damping) {
  const auto polynomial = [](double e) {
    return 1.2728 +
        e * (-4.2783 + e * (11.087 + e * (-22.348 + e * (27.467 + e * (-18.022 + e * 4.8218)))));
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

}  // namespace edmill::decks
