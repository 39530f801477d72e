// What tables count for each partner: the walls by id, other balls, and their total.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/scalar.hpp"
#include "base/sums.hpp"
#include "io/table.hpp"
#include "model/parts/partners.hpp"
#include "output/impact_facts.hpp"

namespace edmill::output {

/// What a list with an entry for each partner has for that of an impact.
template <class Real, class List>
auto& of_partner(const ImpactFacts<Real>& f, List& list) {
  return f.impact.with_wall ? list[f.impact.partner] : list.back();
}

/// A partner, or several together, as columns of tables count them.
struct PartnerColumn {
  std::string name, meaning;
};
inline PartnerColumn column_of(const model::PartnerInfo& partner) { return {partner.key, partner.meaning}; }
inline const PartnerColumn walls_column{"walls", "with all walls"}, total_column{"total", "of all impacts"};

/// Adds "wall_0 energy [J]" and so on to "total energy [J]".
inline void add_partner_columns(std::vector<io::Column>& columns, const model::Partners& partners,
                                const io::Column& of_each) {
  for (int place = 0; place <= partners.count(); ++place) {
    const auto [partner, meaning] = place < partners.count() ? column_of(partners[place]) : total_column;
    columns.push_back(
        {partner + " " + of_each.name, of_each.type, of_each.unit, of_each.description + ", " + meaning});
  }
}

/// Impacts with one partner and an energy of them [J].
template <class Real>
struct Tally {
  std::uint64_t impacts = 0;
  numerics::CompensatedSum<Real> energy;

  void add(const Real& joule) {
    ++impacts;
    energy += joule;
  }
  void add(const Tally& other) {
    impacts += other.impacts;
    energy += other.energy.value();
  }
  void archive(Archive& a) { a(impacts, energy); }
};
/// With each partner.
template <class Real>
using PartnerTally = std::vector<Tally<Real>>;

/// Calls `put` with the value of each partner and with their total.
/// @param value_of  of what the list has for a partner
template <class Value, class List, class ValueOf, class Put>
void put_partners(const List& list, ValueOf&& value_of, Put&& put) {
  Value total{0};
  for (const auto& partner : list) {
    const Value value = value_of(partner);
    put(value);
    total += value;
  }
  put(total);
}

}  // namespace edmill::output
