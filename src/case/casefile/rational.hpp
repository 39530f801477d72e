// The rational number in a Quantity: a heavy header, for more arithmetic than Quantity has.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>

#include "casefile/quantity.hpp"

namespace edmill::casefile {

using Rational = boost::multiprecision::cpp_rational;

struct Quantity::Exact {
  Rational value;
};

inline const Rational& rational(const Quantity& quantity) { return quantity.exact().value; }

inline Quantity quantity_of(Rational value, int pi_power = 0) {
  return Quantity(
      std::make_shared<const Quantity::Exact>(Quantity::Exact{std::move(value)}), pi_power);
}

/// The number in SI units: exact without a power of pi, otherwise correct to more than `bits`.
Rational value_of(const Quantity& quantity, int bits);

}  // namespace edmill::casefile
