// Base classes of outputs: one output for each entry [[output]].
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "base/errors.hpp"
#include "casefile/case_spec.hpp"
#include "casefile/output_entry.hpp"
#include "engine/simulation.hpp"
#include "io/atomic_file.hpp"
#include "io/table.hpp"
#include "model/parts/surface.hpp"
#include "output/impact_facts.hpp"
#include "output/output_timer.hpp"

namespace edmill::output {

using casefile::CaseSpec, casefile::OutputSpec, casefile::OwnKeys, casefile::Parameter,
    casefile::Quantity, casefile::Range, casefile::Section, casefile::TimerSpec;
using casefile::ColumnReader, casefile::ColumnSpec, casefile::Statistic, casefile::statistic_name;
using casefile::columns_key, casefile::contact_point_key, casefile::interval_key,
    casefile::max_rows_key, casefile::table_size;
using engine::Simulation;

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
