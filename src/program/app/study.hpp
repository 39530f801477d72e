// Sweeps and optimisations: many runs of a case, on threads and on ranks of MPI.
#pragma once

#include <atomic>
#include <optional>
#include <string>

#include "study/study.hpp"

namespace edmill::app {

struct StudyOptions {
  std::string file;       ///< the sweep or the optimisation
  std::string folder;     ///< of the outputs; out/<name of the file> when empty
  int jobs = 0;           ///< threads; 0 for all cores
  bool quiet = false;     ///< no progress line on standard error
  bool estimate = false;  ///< only say how long it will take
  std::atomic<bool>* interrupt = nullptr;
};

struct StudyResult {
  study::StudyCounts counts;
  bool interrupted = false;
  std::string folder;
  std::string optimum;   ///< what an optimisation found, as text
  std::string estimate;  ///< how long it will take, as text, where only that is asked for
};

/// @return nothing on ranks that only do runs of rank 0
/// @throws InputError
std::optional<StudyResult> sweep(const StudyOptions& options);
std::optional<StudyResult> optimize(const StudyOptions& options);

}  // namespace edmill::app
