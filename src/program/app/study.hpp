// Many runs of a case: sweeps and optimisations, on threads and on ranks of MPI; phases of a ball's
// impacts against a parameter; variations of uncertain parameters: what decides the dose rate.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "casefile/case_spec.hpp"
#include "study/run_record.hpp"
#include "study/study.hpp"

namespace edmill::app {

struct StudyOptions {
  std::string file;       ///< the sweep or the optimisation
  std::string folder;     ///< of the outputs; out/<name of the file> when empty
  int jobs = 0;           ///< threads; 0 for all cores
  bool quiet = false;     ///< no progress line on standard error
  bool estimate = false;  ///< only say how long it will take
  std::atomic<bool>* interrupt = nullptr;
  study::Study::Progress progress = nullptr;  ///< in place of the line, when it is quiet
};

struct StudyResult {
  study::StudyCounts counts;
  bool interrupted = false;
  std::string folder;
  std::string optimum;   ///< what the points, an optimisation, or several seeds have shown, as text
  std::string estimate;  ///< how long it will take, as text, where only that is asked for
};

/// @return nothing on ranks that only do runs of rank 0. @throws InputError
std::optional<StudyResult> sweep(const StudyOptions& options);
std::optional<StudyResult> optimize(const StudyOptions& options);

struct SeedsOptions : StudyOptions {  ///< the file is the case, the folder is required
  std::vector<std::string> settings;  ///< over the case
  std::string precision;              ///< of all runs; empty for the case's own
  std::uint64_t count = 0;
};

/// Runs a case with successive seeds; the result is in `optimum` and on a page. @throws InputError
std::optional<StudyResult> seeds(const SeedsOptions& options);

struct BifurcationOptions {
  std::string over;         ///< key of a number that the case gives
  double from = 0, to = 0;  ///< in its unit
  std::size_t steps = 400;
  std::size_t skip = 1000;    ///< impacts of ball 0 with walls before the first phase
  std::size_t keep = 100;     ///< of which phases are kept
  double least_approach = 0;  ///< slower impacts do not count [m/s]
  std::string file;           ///< SVG; the points are written beside it as CSV
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(std::size_t step)> progress = [](auto) {};
};

/// An impact in a run with one value of the number.
struct PhasePoint {
  double value;  ///< of the number
  double phase;  ///< of the drive, in periods from 0 to 1
  int wall;
};

struct Bifurcation {
  std::string unit;  ///< of the number
  std::vector<PhasePoint> points;
  std::size_t ended = 0;  ///< runs that ended before they had all phases
  bool interrupted = false;
};

/// Runs the case in double once for each value. @throws InputError for a key without a number
Bifurcation bifurcation(const casefile::CaseSpec& spec, const BifurcationOptions& options);

/// A run of the case with one change.
struct Variation {
  std::string what;              ///< "restitution - 0.1"
  std::string number;            ///< that it varies: "restitution"; empty for the case as it is
  study::RunRecord record = {};  ///< none where there is no such case, or it did not end
  bool known = false;            ///< precise enough to show a difference of 5 %
  bool differs = false;          ///< from the case as it is, by more than both intervals
};

struct Variations {
  double uncertainty = 0;       ///< of restitution and friction
  std::vector<Variation> runs;  ///< first the case as it is
  bool interrupted = false;

  /// A table, and what decides the number in a sentence.
  std::string text() const;
};

/// Repeats a run on all cores with another seed, half of the least separation speed, restitution
/// and friction smaller and larger. Nothing is written.
/// @param own  record of the run itself, which is not repeated
Variations vary(const casefile::CaseSpec& spec, const std::string& precision,
    const study::RunRecord& own, double uncertainty, const std::atomic<bool>* interrupt);

/// The text for a run to its end that has an interval; empty for others, or after an interrupt.
std::string what_decides(const casefile::CaseSpec& spec, const std::string& precision,
    const io::Facts& run, double uncertainty, const std::atomic<bool>* interrupt);

}  // namespace edmill::app
