// Collision logs with known statistics, for tests of the comparison.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace edmill {

struct SyntheticEvent {
  double time;
  int ball;
  bool with_wall;
  int partner;
  double approach_speed, slip_speed, milling_dose, wall_work;
};

/// A Poisson process of 400 impacts a second: a tenth on each cap, half on the cylinder, the rest
/// between balls. Speeds are log-normal and correlated: a factor 0.95 from one impact to the next,
/// so over about 20 impacts.
inline std::vector<SyntheticEvent> synthetic_events(std::uint64_t seed, double duration = 10) {
  std::mt19937_64 random(seed);
  std::exponential_distribution<double> wait(400);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  std::uniform_int_distribution<int> ball(0, 9);
  std::vector<SyntheticEvent> events;
  double z = normal(random);
  for (double t = wait(random); t < duration; t += wait(random)) {
    z = 0.95 * z + std::sqrt(1 - 0.95 * 0.95) * normal(random);
    SyntheticEvent e{t, ball(random), true, 0, std::exp(0.5 * z), 0, 0, 0};
    const double kind = uniform(random);
    e.with_wall = kind < 0.7;
    e.partner = kind < 0.1 ? 0
        : kind < 0.2       ? 1
        : e.with_wall      ? 2
                           : (e.ball + 1 + ball(random) % 9) % 10;
    e.slip_speed = uniform(random);
    e.milling_dose = 1e-4 * e.approach_speed * e.approach_speed;
    e.wall_work = e.with_wall ? 1.5e-4 * e.approach_speed : 0;
    events.push_back(e);
  }
  return events;
}

inline std::string log_text(const std::vector<SyntheticEvent>& events) {
  std::string text =
      "index,time,ball,partner_kind,partner,approach_speed,slip_speed,milling_dose,wall_work\n";
  std::uint64_t index = 0;
  for (const auto& e : events)
    text += fmt::format("{},{},{},{},{},{},{},{},{}\n", index++, e.time, e.ball,
        e.with_wall ? "wall" : "ball", e.partner, e.approach_speed, e.slip_speed, e.milling_dose,
        e.wall_work);
  return text;
}

}  // namespace edmill
