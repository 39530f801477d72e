#include "identify/terms.hpp"

#include <cmath>

namespace edmill::identify {

std::span<const TermRow> term_rows() {
  static constexpr TermRow rows[] = {
      {"impulse of the friction", "(2.28')", &Terms::friction},
      {"change of the velocity by the friction", "(2.34')", &Terms::friction_on_velocity},
      {"torque of the friction", "(2.35)", &Terms::torque},
      {"share M/m of the impulse", "(2.28')", &Terms::share},
      {"c - 1 in the limit of sliding", "(2.24')", &Terms::compliance_in_limit},
      {"c - 1 in the impulse of the friction", "(2.28')", &Terms::compliance_in_impulse},
      {"lever arm R in the velocity of the contact point", "(2.27)", &Terms::arm},
      {"velocity of the wall", "(2.27)", &Terms::wall_velocity},
      {"delay of the wall's velocity", "(2.27)", &Terms::wall_velocity_delay, Dimension::time},
      {"work of the wall, column wall_work", "(A.82)", &Terms::wall_work},
      {"dose, column milling_dose", "(2.36')", &Terms::dose},
      {"energy of the spin in the dose", "(2.36')", &Terms::spin_in_dose},
      {"work of the wall in the dose", "(2.36')", &Terms::work_in_dose},
      {"supplied energy in the dose", "(2.36')", &Terms::supply_in_dose},
      {"column approach_speed", "(2.27)", &Terms::approach_speed},
      {"column slip_speed", "(2.27)", &Terms::slip_speed},
      {"gap at which bodies meet", "(2.17')", &Terms::contact_gap, Dimension::length},
      {"gravity in flights", "(2.1)", &Terms::gravity, Dimension::none, true},
      {"gravity in the places of flights", "(2.1)", &Terms::gravity_in_places, Dimension::none, true},
      {"gravity in the velocities of flights", "(2.1)", &Terms::gravity_in_velocities, Dimension::none, true},
      {"spin in flights", "(2.1)", &Terms::spin_in_flight, Dimension::none, true},
      {"time of flight, too long by", "(2.1)", &Terms::time_of_flight, Dimension::time, true},
      {"age of the velocities before impacts", "(2.1)", &Terms::age_of_velocities, Dimension::time, true}};
  return rows;
}

std::string word_for(double factor, double half_width) {
  struct Word {
    double factor;
    const char* text;
  };
  constexpr Word words[] = {{-1, "reversed"}, {0, "left out"}, {2, "doubled"}, {0.5, "halved"}};
  for (const auto& word : words)
    if (std::abs(factor - word.factor) <= half_width && half_width < 0.1) return word.text;
  return "";
}

}  // namespace edmill::identify
