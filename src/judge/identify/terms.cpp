#include <cmath>

#include "identify/parameters.hpp"

namespace edmill::identify {

namespace {

/// To add a term, add a member to Terms, a factor in its equation in residuals.cpp, and a row here.
struct TermRow {
  const char* name;      ///< "torque of the friction"
  const char* equation;  ///< of docs/theory.md
  double Terms::*member;
  Dimension shift = Dimension::none;  ///< of what is 0 if right; else a factor, 1 if right
  bool of_flights = false;            ///< else of impacts
};
constexpr TermRow term_rows[] = {
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

}  // namespace

std::vector<Parameter> term_parameters() {
  std::vector<Parameter> list;
  for (const auto& row : term_rows) {
    const bool is_factor = row.shift == Dimension::none;
    const double change = is_factor ? 1.0 : row.shift == Dimension::time ? 1e-5 : 1e-4;
    list.push_back({.key = row.name,
                    .dimension = row.shift,
                    .value = is_factor ? 1.0 : 0.0,
                    .change = change,
                    .set = [member = row.member](Assumptions& a, double x) { a.terms.*member = x; },
                    .equation = row.equation,
                    .of_impacts = !row.of_flights,
                    .of_flights = row.of_flights,
                    .prior = 1});  // of two that fit alike, a number of the case comes first
  }
  return list;
}

Parameter restricted_to(const SharedSubset& part, const Parameter& parameter, std::size_t choices) {
  Parameter p = parameter;
  p.key += ", " + part->name;
  p.set = [part, set = parameter.set](Assumptions& a, double x) {
    a.restricted.push_back({part, [set, x](Assumptions& here) { set(here, x); }});
  };
  p.prior = parameter.prior + 2 * std::log(static_cast<double>(choices));
  return p;
}

std::string word_for(double factor, double half_width) {
  constexpr std::pair<double, const char*> words[] = {
      {-1, "reversed"}, {0, "left out"}, {2, "doubled"}, {0.5, "halved"}};
  for (const auto& [of, text] : words)
    if (std::abs(factor - of) <= half_width && half_width < 0.1) return text;
  return "";
}

}  // namespace edmill::identify
