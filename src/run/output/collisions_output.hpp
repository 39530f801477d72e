// The collision log. docs/files.md
#pragma once

#include "casefile/section.hpp"
#include "io/atomic_file.hpp"
#include "output/collision_log.hpp"
#include "output/one_file_output.hpp"

namespace edmill::output {

/// Whether a log holds the bodies' states before and after.
struct StatesKey {
  bool states = false;

  static void keys(auto& k, auto&& row) {
    row(casefile::Parameter{"states", Dimension::none,
                            "also the positions and velocities before and after each impact",
                            casefile::Range::any, "false"},
        k.states);
  }
};

inline void read_collisions(casefile::Section& s, const casefile::CaseSpec& spec,
                            casefile::OutputSpec& output) {
  s.require(!output.hdf5(), "file", "a name ending in .csv; `events` is the log as HDF5");
  casefile::read_own<StatesKey>(s, spec, output);
}

/// Text alone, line by line: the log as HDF5 is another type, `events`.
template <class Real>
class CollisionsOutput : public OneFileOutput<Real, io::AtomicFile> {
 public:
  CollisionsOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                   const RunContext<Real>& run)
      : OneFileOutput<Real, io::AtomicFile>(spec, folder, run, spec.append),
        states_(spec.own_keys<StatesKey>().states) {
    this->file_.stream() << collision_log_header(states_) << '\n';
  }

 protected:
  void record(const ImpactFacts<Real>& f) override {
    this->file_.stream() << collision_line<Real>(f.impact, f.simulation, states_) << '\n';
  }

 private:
  bool states_;
};

}  // namespace edmill::output
