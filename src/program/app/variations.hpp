// Finds what decides the dose rate of a run: repeats the run with other values of uncertain parameters.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "casefile/case_spec.hpp"
#include "study/run_record.hpp"

namespace edmill::app {

/// A run of the case with one change.
struct Variation {
  std::string what;              ///< "restitution - 0.1"
  std::string number;            ///< that it varies: "restitution"; empty for the case as it is
  study::RunRecord record = {};  ///< none where the case allows no such value, or the run did not end
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

/// Repeats a run on all cores with another seed, half of the least separation speed, restitution and friction
/// smaller and larger. Without outputs: nothing is written.
/// @param own  record of the run itself, which is not repeated
/// @param uncertainty  of restitution and friction, above 0
Variations vary(const casefile::CaseSpec& spec, const std::string& precision, const study::RunRecord& own,
                double uncertainty, const std::atomic<bool>* interrupt);

/// The text for a run that has reached its end and has an interval; empty for other runs, or after an
/// interrupt.
std::string what_decides(const casefile::CaseSpec& spec, const std::string& precision, const io::Facts& run,
                         double uncertainty, const std::atomic<bool>* interrupt);

}  // namespace edmill::app
