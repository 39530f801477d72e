// Accumulators of tables: statistics of a variable, and counts for each partner, which are the
// walls by id, other balls, and their total.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/scalar.hpp"
#include "base/sums.hpp"
#include "casefile/output_spec.hpp"
#include "io/table.hpp"
#include "model/parts/partners.hpp"
#include "output/impact_facts.hpp"

namespace edmill::output {

using casefile::Statistic;

/// Running statistics of one variable.
template <class Real> class Accumulator {
 public:
  void add(const Real& value) {
    if (count_ == 0 || value < least_) least_ = value;
    if (count_ == 0 || value > largest_) largest_ = value;
    sum_ += value;
    ++count_;
  }
  /// Adds all values of another accumulator.
  void add(const Accumulator& other) {
    if (other.count_ == 0) return;
    if (count_ == 0 || other.least_ < least_) least_ = other.least_;
    if (count_ == 0 || other.largest_ > largest_) largest_ = other.largest_;
    sum_ += other.sum_.value();
    count_ += other.count_;
  }

  Real sum() const { return sum_.value(); }

  void archive(Archive& a) { a(count_, sum_, least_, largest_); }

  /// The value of a statistic; empty if it is undefined, such as the average of no values.
  /// @param duration  time for rates [s]
  /// @param whole     total for percentages
  std::optional<Real> value(Statistic s, const Real& duration, const Real& whole) const {
    switch (s) {
      case Statistic::sum: return sum();
      case Statistic::average:
        return io::value_if(count_ > 0, [&] { return Real(sum() / Real(count_)); });
      case Statistic::minimum: return io::value_if(count_ > 0, [&] { return least_; });
      case Statistic::maximum: return io::value_if(count_ > 0, [&] { return largest_; });
      case Statistic::rate:
        return io::value_if(duration > 0, [&] { return Real(sum() / duration); });
      case Statistic::percentage:
        return io::value_if(whole != 0, [&] { return Real(100 * sum() / whole); });
    }
    return std::nullopt;
  }
 private:
  std::uint64_t count_ = 0;
  numerics::CompensatedSum<Real> sum_;
  Real least_{0}, largest_{0};
};

/// The entry for the partner of an impact, in a list with one entry for each partner.
template <class Real, class List> auto& of_partner(const ImpactFacts<Real>& f, List& list) {
  return f.impact.with_wall ? list[f.impact.partner] : list.back();
}

/// Headings of columns that count several partners.
inline const model::PartnerInfo walls_column{"walls", "", "with all walls"},
    total_column{"total", "", "of all impacts"};

/// A column for several consecutive partners.
struct PartnerGroup {
  model::PartnerInfo column;
  int first, last;  ///< of the partners that it counts
};

/// Each wall, all walls, other balls, all partners.
inline std::vector<PartnerGroup> groups_of(const model::Partners& partners, bool each_wall) {
  std::vector<PartnerGroup> list;
  const int balls = partners.ball_ball();
  if (each_wall)
    for (int wall = 0; wall < balls; ++wall) list.push_back({partners[wall], wall, wall});
  list.push_back({walls_column, 0, balls - 1});
  list.push_back({partners[balls], balls, balls});
  list.push_back({total_column, 0, balls});
  return list;
}

/// Adds a column for each partner and their total: "wall_0 energy [J]" to "total energy [J]".
inline void add_partner_columns(
    std::vector<io::Column>& columns, const model::Partners& partners, const io::Column& of_each) {
  for (int place = 0; place <= partners.count(); ++place) {
    const auto& partner = place < partners.count() ? partners[place] : total_column;
    columns.push_back({partner.key + " " + of_each.name, of_each.type, of_each.unit,
        of_each.description + ", " + partner.meaning});
  }
}

/// The bin of a value: 0 below all edges, k from edge k - 1 to below edge k, edges.size() above.
template <class Real> std::size_t bin_of(const std::vector<Real>& edges, const Real& value) {
  return static_cast<std::size_t>(
      std::upper_bound(edges.begin(), edges.end(), value) - edges.begin());
}

/// Number of impacts with one partner, and the sum of one of their energies [J].
template <class Real> struct Tally {
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
/// A tally for each partner.
template <class Real> using PartnerTally = std::vector<Tally<Real>>;

/// Calls `put` with the value of each partner and with their total.
/// @param value_of  function that extracts the value from the tally of a partner
template <class Real>
void put_partners(const PartnerTally<Real>& list, auto&& put, auto&& value_of) {
  decltype(value_of(list.front())) total{0};
  for (const auto& partner : list) {
    const auto value = value_of(partner);
    put(value);
    total += value;
  }
  put(total);
}

}  // namespace edmill::output
