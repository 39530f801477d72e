// The file that a stranger checks. docs/certificates.md
#pragma once

#include <ostream>

#include "prove/proof.hpp"

namespace edmill::prove {

/// JSON lines: the exact case, the events, the flights at the end.
void write_certificate(std::ostream& out, const Proof& proof);

/// CSV for readers: index, time, bodies, approach and slip speed, each with its radius.
void write_events(std::ostream& out, const Proof& proof, int digits);

}  // namespace edmill::prove
