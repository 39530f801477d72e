// Implementation of Quantity::to; included by the instantiation files only.
#pragma once

#include "base/dyadic.hpp"
#include "base/instant.hpp"
#include "casefile/rational.hpp"

namespace edmill::casefile {

namespace detail {

/// The nearest scalar; of two that are as near, the even one.
template <class Real>
Real nearest(const Rational& value) {
  using boost::multiprecision::cpp_int;
  const cpp_int above = abs(numerator(value)), below = denominator(value);
  if (above == 0) return Real(0);
  const auto digits = static_cast<unsigned>(binary_digits<Real>());
  // The quotient has one or two bits more than the scalar; a last bit says whether there is a remainder.
  int exponent = static_cast<int>(msb(above)) - static_cast<int>(msb(below)) - static_cast<int>(digits) - 1;
  cpp_int quotient, remainder;
  divide_qr(exponent < 0 ? cpp_int(above << -exponent) : above,
            exponent > 0 ? cpp_int(below << exponent) : below, quotient, remainder);
  quotient = (quotient << 1) | (remainder != 0 ? 1 : 0);
  const unsigned spare = static_cast<unsigned>(msb(quotient)) + 1 - digits;
  const cpp_int half = cpp_int(1) << (spare - 1), rest = quotient & (2 * half - 1);
  quotient >>= spare;
  if (rest > half || (rest == half && bit_test(quotient, 0))) ++quotient;
  return Dyadic(value < 0 ? cpp_int(-quotient) : quotient, exponent - 1 + static_cast<int>(spare)).to<Real>();
}

/// Of pi, so that the last rounding is the only one that counts.
template <class Real>
int bits_for() {
  return 2 * binary_digits<Real>() + 64;
}

}  // namespace detail

template <class Real>
Real Quantity::to() const {
  return detail::nearest<Real>(value_of(*this, detail::bits_for<Real>()));
}

/// The instant at `time` on a clock of whole drive periods, reduced exactly: the offset is as sharp at 1e6 s
/// as at the start.
/// @param time    not negative
/// @param period  of the drive
template <class Real>
Instant<Real> instant_at(const Quantity& time, const Quantity& period) {
  if (time.zero()) return {};
  const int bits = detail::bits_for<Real>() + 64;  // as many periods as an integer holds
  const Rational seconds = value_of(time, bits), length = value_of(period, bits), count = seconds / length;
  const auto periods =
      static_cast<std::int64_t>(boost::multiprecision::cpp_int(numerator(count) / denominator(count)));
  const auto offset = detail::nearest<Real>(seconds - periods * length);
  if (offset < period.to<Real>()) return {periods, offset};
  return {periods + 1, Real(0)};  // it is rounded to a whole period
}

}  // namespace edmill::casefile
