// Numbers as certificates write them. docs/certificates.md
#pragma once

#include <string>

#include "casefile/quantity.hpp"
#include "prove/enclosure.hpp"

namespace edmill::prove {

/// Encloses an exact quantity, to the bits in force.
Enclosure enclosure_of(const casefile::Quantity& quantity);

/// "1a2b -8c 3ff -98": midpoint and radius, each a whole number times a power of two, all in hexadecimal, as
/// Arb writes them.
std::string text_of(const Enclosure& value);

/// A slightly wider enclosure with few digits: the midpoint goes 20 bits beyond the radius, one of an exact
/// number to `bits`; the radius grows by 2^-20 and is rounded up to ten bits.
Enclosure rounded_out(const Enclosure& value, slong bits);

/// "2.560368941527883137177675704e-03 +/- 1.2e-40", for readers: the midpoint to `digits` places and a radius
/// that encloses `value` about what is printed.
struct DecimalText {
  std::string middle, radius;
};
DecimalText decimal_of(const Enclosure& value, int digits);

}  // namespace edmill::prove
