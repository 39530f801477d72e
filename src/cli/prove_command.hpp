// `edmill prove`: the first events of a case as a theorem.
#pragma once

#include <atomic>
#include <string>

#include "casefile/case_spec.hpp"

namespace edmill::cli {

struct ProveOptions {
  std::size_t collisions = 0;
  std::string file, certificate;  ///< of the events and of the certificate; empty for none
  std::string checked;  ///< a certificate whose header is to be that of the case; else one is proven
  long most_bits = 16384;
  bool compare = false;  ///< how many events each scalar gets right
  bool quiet = false;
  const std::atomic<bool>* interrupt = nullptr;
};

/// @return an exit code; `undecided` when the model does not say what comes next, or bits do not suffice
int run_prove(const casefile::CaseSpec& spec, const ProveOptions& options);

}  // namespace edmill::cli
