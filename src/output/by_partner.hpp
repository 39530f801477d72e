// What tables count for each partner: the walls by id, other balls, and their total.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/compensated_sum.hpp"
#include "base/scalar.hpp"
#include "io/table.hpp"
#include "model/impact_facts.hpp"
#include "model/vessel.hpp"

namespace edmill::output {

/// Place of an impact's partner in arrays of model::partner_kinds.
template <class Real>
int partner_of(const model::ImpactFacts<Real>& f) {
  return f.ball_ball ? model::ball_ball : f.partner;
}

/// A partner, or several together, as columns of tables count them.
struct PartnerColumn {
  const char *name, *meaning;
};
inline constexpr PartnerColumn column_of(int place) {
  return {model::partners[place].key, model::partners[place].meaning};
}
inline constexpr PartnerColumn walls_column{"walls", "with all walls"},
    total_column{"total", "of all impacts"};

/// Adds "wall_0 energy [J]" and so on to "total energy [J]".
inline void add_partner_columns(std::vector<io::Column>& columns, const io::Column& of_each) {
  for (int place = 0; place <= model::partner_kinds; ++place) {
    const auto [partner, meaning] = place < model::partner_kinds ? column_of(place) : total_column;
    columns.push_back(
        {partner + (" " + of_each.name), of_each.type, of_each.unit, of_each.description + ", " + meaning});
  }
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

/// Calls `put` with the value of each partner and with their total.
/// @param value_of  of a place
template <class Value, class ValueOf, class Put>
void put_partners(ValueOf&& value_of, Put&& put) {
  Value total{0};
  for (int k = 0; k < model::partner_kinds; ++k) {
    const Value value = value_of(k);
    put(value);
    total += value;
  }
  put(total);
}

}  // namespace edmill::output
