// `edmill certify` and `edmill run --shadow`: one case in more than one scalar.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "casefile/case_spec.hpp"
#include "run/event_source.hpp"

namespace edmill::cli {

struct CertifyOptions {
  std::string file;  ///< of the certified sequence
  std::size_t collisions = 0;
  int digits = 25;
  bool quiet = false;
  const std::atomic<bool>* interrupt = nullptr;
};

/// Raises the precision until two successive scalars agree on the first events, in order and in the digits
/// required, and writes them with the evidence.
/// @return an exit code; `undecided` when the widest two do not agree
int run_certify(const casefile::CaseSpec& spec, const CertifyOptions& options);

/// The events of a case in the scalar of this name.
std::unique_ptr<run::EventSource> source_in(const std::string& precision, const casefile::CaseSpec& spec,
                                            bool to_end);

/// @throws InputError when `shadow` is not wider than `precision`
void check_shadow(const std::string& precision, const std::string& shadow);

/// Runs the case in both scalars side by side to its end and prints where they diverge: event, time,
/// quantities, and how fast digits are lost.
int run_shadow(const casefile::CaseSpec& spec, const std::string& precision, const std::string& shadow,
               const std::atomic<bool>* interrupt);

}  // namespace edmill::cli
