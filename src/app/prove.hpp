// The first events of a case, proven in ball arithmetic, with what is written of them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "casefile/case_spec.hpp"
#include "prove/proof.hpp"

namespace edmill::app {

struct ProveOptions : prove::ProofOptions {
  std::string file, certificate;  ///< of the events and of the certificate; none when empty
  bool compare = false;           ///< how many events each scalar gets right
};

struct Proven {
  prove::Proof proof;
  double seconds = 0;
  std::vector<std::pair<std::string, std::size_t>> right;  ///< by scalar: events before its first wrong one
};

/// Nothing is written where the events cannot be proven, or the proof is interrupted.
Proven prove(const casefile::CaseSpec& spec, const ProveOptions& options);

/// Where the header of a certificate tells of another case, a line each. @throws InputError for what is none
std::vector<std::string> check_certificate(const casefile::CaseSpec& spec, const std::string& certificate);

}  // namespace edmill::app
