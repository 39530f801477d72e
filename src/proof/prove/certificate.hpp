// The file that anybody can check. docs/certificates.md
#pragma once

#include <istream>
#include <ostream>
#include <string>
#include <vector>

#include "prove/proof.hpp"

namespace edmill::prove {

/// JSON lines: the exact case, the events, the flights at the end.
void write_certificate(std::ostream& out, const Proof& proof);

/// Where the header of a certificate tells of another case than this one, a line each: "/balls/0/radius:
/// found "1/250", expected "119/25000"". The name of the case, its digest, the bits and the number of events
/// do not count: what is proven follows from the other numbers.
/// @param name  of the file, for messages
/// @throws InputError for what is no certificate, or has a key of the header twice
std::vector<std::string> other_case(std::istream& certificate, const std::string& name,
                                    const ExactCase& exact);

/// CSV for readers: index, time, bodies, approach and slip speed, each with its radius.
void write_events(std::ostream& out, const Proof& proof, int digits);

}  // namespace edmill::prove
