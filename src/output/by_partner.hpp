// What tables count for each partner: the walls by id, other balls, and their total.
#pragma once

#include <array>
#include <cstdint>
#include <ostream>

#include "base/compensated_sum.hpp"
#include "base/scalar.hpp"
#include "model/impact_facts.hpp"
#include "model/vessel.hpp"
#include "output/titles.hpp"

namespace edmill::output {

/// Place of an impact's partner in arrays of model::partner_kinds.
template <class Real>
int partner_of(const model::ImpactFacts<Real>& f) {
  return f.ball_ball ? model::ball_ball : f.partner;
}

/// ",wall_0 energy [J],...,total energy [J]"
inline std::string partner_titles(const std::string& name, const std::string& unit) {
  std::string titles;
  for (const std::string partner : {"wall_0", "wall_1", "wall_2", "ball_ball", "total"})
    titles += "," + title_of(partner + " " + name, unit);
  return titles;
}

/// Impacts and an energy [J] of each partner.
template <class Real>
struct PartnerTally {
  std::array<std::uint64_t, model::partner_kinds> impacts{};
  std::array<numerics::CompensatedSum<Real>, model::partner_kinds> energy;

  void add(int partner, const Real& joule) {
    ++impacts[partner];
    energy[partner] += joule;
  }
  void add(const PartnerTally& other) {
    for (int k = 0; k < model::partner_kinds; ++k) {
      impacts[k] += other.impacts[k];
      energy[k] += other.energy[k].value();
    }
  }
  void archive(Archive& a) { a(impacts, energy); }
};

/// ",value" of each partner and of their total.
/// @param value_of  of a place
template <class Value, class ValueOf>
void write_partners(std::ostream& out, ValueOf&& value_of) {
  Value total{0};
  const auto write = [&](const Value& value) {
    if constexpr (std::is_integral_v<Value>)
      out << ',' << value;
    else
      out << ',' << to_text<Value>(value);
  };
  for (int k = 0; k < model::partner_kinds; ++k) {
    const Value value = value_of(k);
    write(value);
    total += value;
  }
  write(total);
}

}  // namespace edmill::output
