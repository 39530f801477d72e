// The first events of a case, proven in ball arithmetic, with what is written of them.
#pragma once

#include <string>
#include <vector>

#include "casefile/case_spec.hpp"
#include "prove/proof.hpp"

namespace edmill::app {

struct ProveOptions : prove::ProofOptions {
  std::string file, certificate;  ///< of the events and of the certificate; none when empty
};

struct Proven {
  prove::Proof proof;
  double seconds = 0;
};

/// Nothing is written where the events cannot be proven, or the proof is interrupted.
Proven prove(const casefile::CaseSpec& spec, const ProveOptions& options);

/// How many of the proven events a scalar gets right, from the first on.
std::size_t right_events(const std::string& precision, const casefile::CaseSpec& spec,
                         const prove::Proof& proof);

/// Where the header of a certificate tells of another case, a line each. @throws InputError for what is none
std::vector<std::string> check_certificate(const casefile::CaseSpec& spec, const std::string& certificate);

}  // namespace edmill::app
