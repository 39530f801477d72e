// An output that is one table, and helpers for the names of its columns.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "io/atomic_file.hpp"
#include "io/table_hdf5.hpp"
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
