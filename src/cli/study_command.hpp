// The commands `edmill sweep` and `edmill optimize`.
#pragma once

#include <atomic>
#include <string>

namespace edmill::cli {

struct StudyOptions {
  std::string file;    ///< the sweep or the optimisation
  std::string folder;  ///< of the outputs; out/<name of the file> when empty
  int jobs = 0;        ///< threads; 0 for all cores
  bool quiet = false;
  std::atomic<bool>* interrupt = nullptr;
};

/// @return an exit code; `ok` for an interrupted study too, whose signal the caller knows
int run_sweep(const StudyOptions& options);
int run_optimize(const StudyOptions& options);

}  // namespace edmill::cli
