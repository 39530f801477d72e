// An output that is one table, names of its columns, and accumulators: statistics of a variable,
// and counts for each partner, which are the walls by id, other balls, and their total.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/scalar.hpp"
#include "base/sums.hpp"
#include "io/table_hdf5.hpp"
#include "model/parts/partners.hpp"
#include "model/variables.hpp"
#include "output/output.hpp"

namespace edmill::output {

using io::Column;
using enum Column::Type;

/// Unit of a statistic of a variable with that unit.
inline std::string statistic_unit(Statistic s, std::string_view unit) {
  if (s == Statistic::rate) return unit == "J" ? "W" : std::string(unit) + "/s";
  return s == Statistic::percentage ? "%" : std::string(unit);
}

/// The label of a column, or else the name of its variable.
inline std::string name_of(const ColumnSpec& column, std::string_view variable) {
  return column.label.empty() ? std::string(variable) : column.label;
}

/// The name of a column and a statistic; the label alone where there is only one statistic.
inline std::string name_of(const ColumnSpec& column, std::string_view variable, Statistic s) {
  const bool alone = !column.label.empty() && column.statistics.size() == 1;
  return alone ? column.label : name_of(column, variable) + " " + statistic_name(s);
}

/// Flags and counts are integers.
inline Column::Type type_of(const model::ImpactVariable& variable) {
  return variable.kind == model::VariableKind::number ? number : integer;
}

/// The meaning of a variable of an impact, by its name.
inline std::string meaning_of(std::string_view variable) {
  return std::string(model::impact_variables[*model::find_variable(variable)].meaning);
}

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
    std::vector<Column>& columns, const model::Partners& partners, const Column& of_each) {
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

/// One table: CSV, written row by row, or HDF5 if the file's name ends in .h5, at the end.
template <class Real> class TableOutput : public OneFileOutput<Real, io::AtomicFile> {
  using Base = OneFileOutput<Real, io::AtomicFile>;
  using Base::file_;
 public:
  TableOutput(const OutputSpec& spec, const RunContext<Real>& run) : Base(spec, run, spec.append) {}
  std::vector<io::WholeFile*> complete() override {
    if (this->spec.hdf5()) file_.stream() << io::hdf5_columns(table_, this->run.notes);
    return Base::complete();
  }
  void archive(Archive& a) override {
    Base::archive(a);
    a(table_);
  }
 protected:
  /// To be called once: in the constructor when rows come during the run, else before the first.
  void begin(std::vector<io::Column> columns, std::vector<std::string> comments = {}) {
    table_ = io::Table<Real>(std::move(columns), std::move(comments));
    if (!this->spec.hdf5()) file_.stream() << table_.csv_head();
  }
  /// The next cells of the row, from left to right; a vector is three of them.
  void put(const auto&... cells) { (put_one(cells), ...); }
  /// The number of a bin from 1, or below or above all, and its edges.
  /// @param bin  as returned by `bin_of`
  void put_bin(const std::vector<Real>& edges, std::size_t bin) {
    const bool below = bin == 0, above = bin == edges.size();
    put(below       ? "below"
            : above ? "above"
                    : std::to_string(bin),
        io::value_if(!below, [&] { return edges[bin - 1]; }),
        io::value_if(!above, [&] { return edges[bin]; }));
  }
  void put_variable(int variable, const Real& value) {
    if (type_of(model::impact_variables[variable]) == integer)
      put(static_cast<std::uint64_t>(value));
    else
      put(value);
  }
  /// The window that rates refer to, as text: "from 0.5 s to 10 s: 9.5 s".
  std::string window(const Real& until) const {
    const Real &from = this->timer().from(), duration = until - from;
    return "from " + to_text<Real>(from) + " s to " + to_text<Real>(until) +
        " s: " + to_text<Real>(duration) + " s";
  }
 private:
  void put_one(const auto& cell) {
    table_.put(cell);
    if (!table_.at_row_end() || this->spec.hdf5()) return;
    file_.stream() << table_.csv_rows();
    table_.clear_rows();
  }
  void put_one(const Vec3<Real>& vector) {
    for (int axis = 0; axis < 3; ++axis) put_one(Real(vector[axis]));
  }

  io::Table<Real> table_;
};

/// A table with a row at the end of each interval of the record, where it has intervals.
template <class Real> class IntervalOutput : public TableOutput<Real> {
 public:
  IntervalOutput(const OutputSpec& spec, const RunContext<Real>& run)
      : TableOutput<Real>(spec, run), clock_(spec.timer) {}
  void archive(Archive& a) override {
    TableOutput<Real>::archive(a);
    a(clock_);
  }
 protected:
  virtual void write_row(const Real& begin, const Moment<Real>& end) = 0;

  void before(const ImpactFacts<Real>& f) override {
    if (!this->spec.timer.interval) return;
    clock_.pass(this->timer(), f.time, [&](const Real& begin, const Real& end) {
      write_row(begin, {f, end});
    });
  }
  void end_of_record(const Simulation<Real>& simulation, const Real& until) override {
    if (!this->spec.timer.interval) return;
    clock_.finish(this->timer().from(), until, [&](const Real& begin, const Real& end) {
      write_row(begin, {simulation, end});
    });
  }
 private:
  IntervalClock<Real> clock_;
};

}  // namespace edmill::output
