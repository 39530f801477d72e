// The collision log. docs/files.md
#pragma once

#include "casefile/section.hpp"
#include "io/atomic_file.hpp"
#include "output/output.hpp"
#include "run/collision_log.hpp"

namespace edmill::output {

/// Whether a log holds the bodies' states before and after.
struct StatesKey {
  bool states;
};

inline constexpr casefile::KeyText states_keys[] = {
    {"states", "true or false", "false", "also the places and velocities before and after each impact"}};

inline void read_states_key(casefile::Section& s, const casefile::CaseSpec&, casefile::OutputSpec& output) {
  output.own = StatesKey{s.flag("states")};
}

inline void read_collisions(casefile::Section& s, const casefile::CaseSpec& spec,
                            casefile::OutputSpec& output) {
  s.require(!output.hdf5(), "file", "a name ending in .csv; `events` is the log as HDF5");
  read_states_key(s, spec, output);
}

/// Text alone, line by line: the log as HDF5 is another type, `events`.
template <class Real>
class CollisionsOutput : public Output<Real> {
 public:
  CollisionsOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                   const RunContext<Real>& run)
      : Output<Real>(spec, run),
        states_(spec.own_keys<StatesKey>().states),
        file_(folder / spec.folder / spec.file, spec.append) {
    file_.stream() << run::collision_log_header << (states_ ? run::collision_log_states : "") << '\n';
  }

  void complete() override { file_.complete(); }
  void commit() override { file_.commit(); }
  std::vector<std::filesystem::path> places() const override { return file_.places(); }

 protected:
  void archive_record(Archive& a) override { a(file_); }
  void record(const Seen<Real>& seen) override {
    file_.stream() << run::collision_line<Real>(seen.impact, seen.simulation, states_) << '\n';
  }

 private:
  bool states_;
  io::AtomicFile file_;
};

}  // namespace edmill::output
