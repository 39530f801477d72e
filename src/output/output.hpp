// One entry [[output]] at work.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "casefile/case_spec.hpp"
#include "engine/simulation.hpp"
#include "io/output_folder.hpp"
#include "model/impact_facts.hpp"
#include "output/file_note.hpp"
#include "output/output_timer.hpp"
#include "output/table_file.hpp"
#include "output/variable_values.hpp"

namespace edmill::output {

/// What outputs know of the run that they record.
template <class Real>
struct RunFacts {
  Real start;                       ///< initial time [s]
  std::optional<Real> powder_mass;  ///< [kg]
  casefile::Colour vessel_colour{};
  std::vector<casefile::Colour> ball_colours;  ///< of each ball
  std::vector<FileNote> notes;                 ///< where the run comes from
};

/// One impact as an output sees it.
template <class Real>
struct Seen {
  const model::ImpactFacts<Real>& facts;
  const engine::Impact<Real>& impact;
  const engine::Simulation<Real>& simulation;
};

/// The vessel at the impact.
template <class Real>
model::VesselPose<Real> pose_of(const Seen<Real>& seen) {
  return model::pose_at<Real>(seen.simulation.mill().motion, seen.impact.time.offset);
}
/// The contact point in the vessel frame [m].
template <class Real>
Vec3<Real> own_contact_point(const Seen<Real>& seen, const model::VesselPose<Real>& pose) {
  const Vec3<Real> at_rest = Vec3<Real>::Zero();
  return model::to_vessel_frame<Real>(pose, seen.simulation.mill().motion.arm, seen.facts.contact_point,
                                      at_rest)
      .position;
}

/// A timer and restrictions. Types derive from it and say what they do with an impact.
template <class Real>
class Output {
 public:
  Output(const casefile::OutputSpec& spec, const RunFacts<Real>& run)
      : timer_(spec.timer, run.start), appends_(spec.append) {
    for (const auto& r : spec.only) only_.push_back({variable_formula<Real>(r.variable), Real(r.value)});
  }
  virtual ~Output() = default;

  void on_impact(const Seen<Real>& seen) {
    const auto& f = seen.facts;
    const bool recorded = timer_.admits(f.time, f.index);
    if (timer_.is_open()) before(seen);
    if (!recorded) return;
    for (const auto& r : only_)
      if (r.formula(f) != r.value) return;
    record(seen);
  }
  /// At the end of the run, whatever ended it.
  void finish(const engine::Simulation<Real>& simulation) {
    const Real end = simulation.seconds();
    if (timer_.recorded(end)) end_of_record(simulation, timer_.until(end));
  }
  /// Puts what was written in place.
  virtual void commit() = 0;
  /// Its state and how far its files are written, for a checkpoint.
  virtual void archive(Archive& a) {
    a(timer_);
    archive_record(a);
  }
  /// Whether its rows go behind those of other runs.
  bool appends() const { return appends_; }

 protected:
  /// What it has gathered and not yet written; what follows from the case is not part of it.
  virtual void archive_record(Archive& a) = 0;
  /// An impact of the record.
  virtual void record(const Seen<Real>& seen) = 0;
  /// Any impact, before it is recorded: for rows that are due since the one before.
  virtual void before(const Seen<Real>&) {}
  virtual void end_of_record(const engine::Simulation<Real>&, const Real& /*until*/) {}

  const OutputTimer<Real>& timer() const { return timer_; }

 private:
  struct Restriction {
    VariableFormula<Real> formula;
    Real value;
  };
  OutputTimer<Real> timer_;
  bool appends_;
  std::vector<Restriction> only_;
};

/// An output that is one table: a file of text, or HDF5 when its name ends in .h5.
template <class Real>
class TableOutput : public Output<Real> {
 public:
  TableOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
              const RunFacts<Real>& run)
      : Output<Real>(spec, run), file_(folder / spec.folder / spec.file, spec.append) {
    if (spec.hdf5()) notes_ = run.notes;
  }
  void commit() override {
    if (notes_) file_.stream() << table_image(text_.str(), *notes_, meanings_);
    file_.commit();
  }
  void archive(Archive& a) override {
    Output<Real>::archive(a);
    a(file_);
    std::string text = text_.str();
    a(text);
    if (a.loading()) text_.str({}), text_ << text;
  }

 protected:
  std::ostream& out() { return notes_ ? text_ : file_.stream(); }
  /// What a column shows, for HDF5, where its name does not tell.
  void describe(const std::string& column, std::string_view meaning) { meanings_[column] = meaning; }
  /// "# from 0.5 s to 10 s: 9.5 s", which rates are per; the line is the caller's to end.
  void write_window(const Real& until) {
    const Real &from = this->timer().from(), duration = until - from;
    out() << "# from " << to_text<Real>(from) << " s to " << to_text<Real>(until)
          << " s: " << to_text<Real>(duration) << " s";
  }

 private:
  io::AtomicFile file_;
  std::optional<std::vector<FileNote>> notes_;  ///< of HDF5, made of the text at the end
  std::ostringstream text_;
  std::map<std::string, std::string> meanings_;
};

/// All outputs of a case, as one observer.
template <class Real>
class Outputs : public engine::Observer<Real> {
 public:
  /// Opens the files. @throws InputError when one cannot be written
  Outputs(const casefile::CaseSpec& spec, const std::filesystem::path& folder, const Real& start);
  ~Outputs() override;

  void on_impact(const engine::Impact<Real>& impact, engine::Simulation<Real>& simulation) override;
  void on_end(const engine::Simulation<Real>& simulation) override;
  void archive(Archive& a) override;
  /// Puts all files in place. A run that goes on later adds its rows to files of other runs only then.
  void commit(bool goes_on);

 private:
  std::vector<std::unique_ptr<Output<Real>>> outputs_;
  Real previous_;  ///< time of the last impact of any ball [s]
};

}  // namespace edmill::output
