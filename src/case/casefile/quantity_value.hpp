// Implementation of Quantity::to; included by the instantiation files only.
#pragma once

#include "base/instant.hpp"
#include "base/scalar_list.hpp"
#include "base/wide_trigonometry.hpp"
#include "casefile/rational.hpp"

namespace edmill::casefile {

namespace detail {

#if defined(EDMILL_WITHOUT_MPFR)
/// With twice the digits of a scalar and `more`.
template <class Real, unsigned more>
using Wide = mpfr_of<2 * std::numeric_limits<Real>::digits10 + more>;
template <class Real>
struct WideDigits {
  explicit WideDigits(unsigned) {}
  Real rounded(const auto& value) const { return static_cast<Real>(value); }
};
#else
template <class Real, unsigned more>
using Wide = mpfr;
/// Chooses twice the digits of a scalar and `more` for a scope.
template <class Real>
struct WideDigits {
  explicit WideDigits(unsigned more) : wide(2 * std::numeric_limits<Real>::digits10 + more) {}
  Real rounded(const mpfr& value) const { return static_cast<Real>(value); }
  mpfr::Digits wide;
};
template <>
struct WideDigits<mpfr> {
  explicit WideDigits(unsigned more) : wide(2 * narrow.digits + more) {}
  mpfr rounded(const mpfr& value) const {
    const auto scope = narrow.use();
    return value.rounded();
  }
  ChosenDigits<mpfr> narrow;
  mpfr::Digits wide;
};
#endif

}  // namespace detail

template <class Real>
Real Quantity::to() const {
  // Twice the digits and more, so that the last rounding is the only one that counts.
  using Wide = detail::Wide<Real, 20>;
  [[maybe_unused]] const detail::WideDigits<Real> digits(20);
  Wide result = Wide(numerator(rational(*this)).str()) / Wide(denominator(rational(*this)).str());
  const Wide pi = numerics::pi<Wide>();
  for (int k = 0; k < pi_power; ++k) result *= pi;
  for (int k = 0; k > pi_power; --k) result /= pi;
  return digits.rounded(result);
}

/// The instant at `time` on a clock of whole drive periods, reduced exactly: the offset is as sharp at 1e6 s
/// as at the start.
/// @param time    not negative
/// @param period  of the drive
template <class Real>
Instant<Real> instant_at(const Quantity& time, const Quantity& period) {
  if (time.zero()) return {};
  std::int64_t periods;
  Real offset;
  if (time.pi_power == period.pi_power) {
    const Rational count = rational(time / period);
    periods =
        static_cast<std::int64_t>(boost::multiprecision::cpp_int(numerator(count) / denominator(count)));
    offset = quantity_of(rational(time) - periods * rational(period), time.pi_power).to<Real>();
  } else {
    // Up to 1e15 periods lead away that many digits more.
    using Wide = detail::Wide<Real, 40>;
    [[maybe_unused]] const detail::WideDigits<Real> digits(40);
    const Wide length = period.to<Wide>(), seconds = time.to<Wide>();
    const Wide whole = floor(Wide(seconds / length));
    periods = static_cast<std::int64_t>(whole);
    offset = digits.rounded(Wide(seconds - whole * length));
  }
  if (offset < period.to<Real>()) return {periods, offset};
  return {periods + 1, Real(0)};  // it is rounded to a whole period
}

}  // namespace edmill::casefile
