// Numbers as a certificate writes them: docs/certificates.md, "The file".
#pragma once

#include <string>

#include "real.hpp"

namespace checker {

// The functions here throw std::invalid_argument for any other text.

/// An integer of at most seven characters.
long small_integer(const std::string& text);

/// A rational times a power of pi: "119/25000", "-2", "1/12*pi", "55*pi^-1".
Real exact_number(const std::string& text);

/// Midpoint and radius, each an integer times a power of two, the four in hexadecimal: "1a2b -8c
/// 3ff -98".
Real enclosure(const std::string& text);

}  // namespace checker
