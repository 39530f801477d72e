// When an output records, and base classes of outputs: one for each entry [[output]].
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "base/archive.hpp"
#include "base/errors.hpp"
#include "casefile/output_entry.hpp"
#include "engine/simulation.hpp"
#include "io/atomic_file.hpp"
#include "io/table.hpp"
#include "model/parts/surface.hpp"
#include "output/impact_facts.hpp"

namespace edmill::output {

using casefile::CaseSpec, casefile::OutputSpec, casefile::OwnKeys, casefile::Parameter,
    casefile::Quantity, casefile::Range, casefile::Section, casefile::TimerSpec;
using casefile::ColumnReader, casefile::ColumnSpec, casefile::Statistic, casefile::statistic_name;
using casefile::columns_key, casefile::contact_point_key, casefile::interval_key,
    casefile::max_rows_key, casefile::table_size;
using engine::Simulation;

/// Opens at the first of its starts that is met, closes at the first end. Times are inclusive.
template <class Real> class OutputTimer {
 public:
  /// @param run_start  initial time of the run [s]
  OutputTimer(const TimerSpec& spec, const Real& run_start)
      : on_(spec.on), start_collision_(spec.start_collision), collisions_(spec.collisions) {
    const auto seconds = [](const std::optional<Quantity>& q) {
      return q ? std::optional<Real>(q->to<Real>()) : std::nullopt;
    };
    start_time_ = seconds(spec.start_time);
    end_time_ = seconds(spec.end_time);
    duration_ = seconds(spec.duration);
    if (!start_time_ && !start_collision_) start_time_ = run_start;
    if (start_time_ && *start_time_ < run_start) start_time_ = run_start;
    if (!start_collision_)
      open(*start_time_);  // known at once: rows can be due before the first impact
  }

  /// True if an impact is recorded. Must be called once for each impact, in order.
  bool admits(const Real& time, std::uint64_t index) {
    if (!on_ || closed_) return false;
    if (!from_) {
      if (start_time_ && time >= *start_time_)
        open(*start_time_);
      else if (index >= *start_collision_)
        open(time);
    }
    if (!from_ || time < *from_) return false;
    if (until_ && time > *until_) {
      closed_ = true;
      return false;
    }
    if (collisions_ && ++recorded_ == *collisions_) {
      closed_ = true;
      until_ = time;
    }
    return true;
  }

  /// True if the start of the record is known.
  bool is_open() const { return from_.has_value(); }
  /// Start of the record [s]. @pre is_open()
  const Real& from() const { return *from_; }
  /// End of the record if the run continues to `run_end` [s].
  Real until(const Real& run_end) const { return until_ && *until_ < run_end ? *until_ : run_end; }
  /// True if the record has ended before or at `time`.
  bool ends_by(const Real& time) const { return until_ && *until_ <= time; }
  /// True if a run that ends at `run_end` has a record.
  bool recorded(const Real& run_end) const { return on_ && from_ && *from_ <= run_end; }

  void archive(Archive& a) { a(closed_, recorded_, from_, until_); }
 private:
  void open(const Real& time) {
    from_ = time;
    for (const auto& end :
        {end_time_, duration_ ? std::optional<Real>(time + *duration_) : std::nullopt})
      if (end && (!until_ || *end < *until_)) until_ = end;
  }

  bool on_, closed_ = false;
  std::optional<Real> start_time_, end_time_, duration_;
  std::optional<std::uint64_t> start_collision_, collisions_;
  std::uint64_t recorded_ = 0;
  std::optional<Real> from_, until_;  ///< of the record, where they are known
};

/// The ends of a record's intervals, one after the other.
template <class Real> class IntervalClock {
 public:
  explicit IntervalClock(const TimerSpec& spec)
      : interval_(spec.interval ? spec.interval->to<Real>() : Real(0)), rows_(spec.max_rows) {}

  /// Calls `row(begin, end)` for each interval that ends at `time` or before; the one that ends
  /// with the record stays open, since an impact at that very instant belongs to it.
  template <class Row> void pass(const OutputTimer<Real>& timer, const Real& time, Row&& row) {
    const Real& from = timer.from();
    for (;;) {
      const Real end = from + interval_ * Real(passed_ + 1);
      if (end > time || timer.ends_by(end) || full()) return;
      row(Real(from + interval_ * Real(passed_)), end);
      ++passed_;
    }
  }
  /// Calls `row` for the remaining intervals up to the end of the record. The last one may be
  /// shorter; one that exists only by rounding is omitted.
  template <class Row> void finish(const Real& from, const Real& until, Row&& row) {
    for (Real begin = from + interval_ * Real(passed_);
         until - begin > interval_ / 1000000000 && !full();
         begin = from + interval_ * Real(++passed_)) {
      const Real end = from + interval_ * Real(passed_ + 1);
      row(begin, end < until ? end : until);
    }
  }
  bool full() const { return rows_ && passed_ >= *rows_; }

  void archive(Archive& a) { a(passed_); }
 private:
  Real interval_;
  std::optional<std::uint64_t> rows_;
  std::uint64_t passed_ = 0;
};

/// Data about the run that outputs need.
template <class Real> struct RunContext {
  std::filesystem::path folder;       ///< into which it writes
  Real start;                         ///< initial time [s]
  model::Partners partners;           ///< of the balls
  std::optional<Real> powder_mass{};  ///< [kg]
  casefile::Colour vessel_colour{};
  std::vector<casefile::Colour> ball_colours;  ///< of each ball
  std::vector<model::WallSurface<Real>>
      walls;                              ///< by id, in the vessel frame; empty for a CurvedVessel
  std::vector<model::Body<Real>> bodies;  ///< the walls after these
  std::vector<casefile::Colour> body_colours{};  ///< of each body
  std::vector<io::FileNote> notes;               ///< where the run comes from

  /// The walls, for outputs that map or draw them.
  /// @throws InputError when the vessel's walls have no coordinates
  const std::vector<model::WallSurface<Real>>& surfaces(const OutputSpec& spec) const {
    if (walls.empty())
      throw InputError("output of type '" + spec.type +
          "': found a vessel of the program's own with curved walls, expected one whose walls "
          "have coordinates");
    return walls;
  }
};

/// The run at the time of a row or a frame.
template <class Real> struct Moment {
  /// @param time  not before the last impact, not after that of `f`
  Moment(const ImpactFacts<Real>& f, const Real& time)
      : simulation(f.simulation), time(time), impacts(f.impact.index),
        state_of([&f, time](int ball) { return f.state_before(ball, time); }) {}
  /// @param time  not before the last impact
  Moment(const Simulation<Real>& s, const Real& time)
      : simulation(s), time(time), impacts(s.counts().impacts),
        state_of([&s, when = s.instant_of(time)](int ball) { return s.state_at(ball, when); }) {}

  const Simulation<Real>& simulation;
  Real time;
  std::uint64_t impacts;                                ///< up to then
  std::function<model::BallState<Real>(int)> state_of;  ///< by the ball's id
};

/// Base of outputs: a timer and filters. A derived type defines what it records of an impact.
template <class Real> class Output {
 public:
  Output(const OutputSpec& spec, const RunContext<Real>& run)
      : spec(spec), run(run), timer_(spec.timer, run.start) {
    for (const auto& r : spec.only)
      only_.push_back({variable_formula<Real>(r.variable), Real(r.value)});
  }
  virtual ~Output() = default;

  void on_impact(const ImpactFacts<Real>& f) {
    every(f);
    const bool recorded = timer_.admits(f.time, f.impact.index);
    if (timer_.is_open()) before(f);
    if (!recorded) return;
    for (const auto& r : only_)
      if (r.formula(f) != r.value) return;
    record(f);
  }
  /// Must be called at the end of the run, whatever ended it.
  void finish(const Simulation<Real>& simulation) {
    const Real end = simulation.seconds();
    if (timer_.recorded(end)) end_of_record(simulation, timer_.until(end));
  }
  /// Writes all remaining data, so that no later step can fail for lack of disk space.
  /// @return its files, which are to be put in place in this order
  virtual std::vector<io::WholeFile*> complete() = 0;
  /// Saves or loads its state and the progress of its files, for a checkpoint.
  virtual void archive(Archive& a) {
    a(timer_);
    archive_record(a);
  }
  /// True if it appends to a table shared by several runs.
  bool appends() const { return spec.append; }
 protected:
  const OutputSpec spec;  ///< its entry in the case
  const RunContext<Real> run;

  std::filesystem::path place() const { return run.folder / spec.folder / spec.file; }
  const OutputTimer<Real>& timer() const { return timer_; }

  /// Saves or loads the data gathered and not yet written, without what follows from the case.
  virtual void archive_record(Archive&) {}
  /// Called for each impact of the record.
  virtual void record(const ImpactFacts<Real>&) {}
  /// Called for each impact of the run, in the record or not.
  virtual void every(const ImpactFacts<Real>&) {}
  /// Called for each impact before it is recorded, to write rows due since the previous one.
  virtual void before(const ImpactFacts<Real>&) {}
  virtual void end_of_record(const Simulation<Real>&, const Real& /*until*/) {}
 private:
  struct Restriction {
    VariableFormula<Real> formula;
    Real value;
  };
  OutputTimer<Real> timer_;
  std::vector<Restriction> only_;
};

/// An output that is one file, to which each impact adds.
template <class Real, class File, class Base = Output<Real>> class OneFileOutput : public Base {
 public:
  /// @param arguments  of the file's constructor, after its place
  template <class... Arguments>
  OneFileOutput(const OutputSpec& spec, const RunContext<Real>& run, Arguments&&... arguments)
      : Base(spec, run), file_(this->place(), std::forward<Arguments>(arguments)...) {}

  std::vector<io::WholeFile*> complete() override {
    file_.complete();
    return {&file_};
  }
  void archive(Archive& a) override {
    Base::archive(a);
    a(file_);
  }
 protected:
  File file_;
};

}  // namespace edmill::output
