// Checks a certificate of proven events, rule by rule: docs/certificates.md.
#pragma once

#include <istream>
#include <string>

#include "verdict.hpp"

namespace checker {

/// @return "accepted: ...", with the numbers of events, balls and bits
/// @throws Rejected, or another std::exception for a file that is no certificate
std::string check(std::istream& in);

}  // namespace checker
