// Real numbers as Arb encloses them, a midpoint and a radius each, and vectors of them.
#pragma once

#include <arb.h>

#include <array>
#include <utility>

namespace checker {

/// They suffice for most inequalities, and cost less than the bits of a certificate.
constexpr slong few_bits = 128;

/// Bits of all arithmetic.
inline slong precision = few_bits;

/// Sets the precision until the end of a block.
class WithPrecision {
 public:
  explicit WithPrecision(slong bits) : before_(precision) { precision = bits; }
  WithPrecision(const WithPrecision&) = delete;
  WithPrecision& operator=(const WithPrecision&) = delete;
  ~WithPrecision() { precision = before_; }

 private:
  slong before_;
};

/// An enclosure: all real numbers within a radius of a midpoint.
/// The result of an operation holds the results for all numbers of its operands. A comparison is true if it
/// is true for all of them; if it is false, it may be undecided.
struct Real {
  arb_t arb;

  Real(slong n = 0) {  // implicit, for the integers in formulas
    arb_init(arb);
    arb_set_si(arb, n);
  }
  Real(const Real& other) {
    arb_init(arb);
    arb_set(arb, other.arb);
  }
  Real(Real&& other) noexcept {
    arb_init(arb);
    arb_swap(arb, other.arb);
  }
  Real& operator=(Real other) noexcept {
    arb_swap(arb, other.arb);
    return *this;
  }
  ~Real() { arb_clear(arb); }

  bool positive() const { return arb_is_positive(arb); }
  bool negative() const { return arb_is_negative(arb); }
  bool zero() const { return arb_is_zero(arb); }
};

/// The result of one of Arb's functions.
template <class Function, class... Arguments>
Real result_of(Function function, const Arguments&... arguments) {
  Real result;
  function(result.arb, arguments...);
  return result;
}

inline Real operator+(const Real& a, const Real& b) { return result_of(arb_add, a.arb, b.arb, precision); }
inline Real operator-(const Real& a, const Real& b) { return result_of(arb_sub, a.arb, b.arb, precision); }
inline Real operator*(const Real& a, const Real& b) { return result_of(arb_mul, a.arb, b.arb, precision); }
inline Real operator/(const Real& a, const Real& b) { return result_of(arb_div, a.arb, b.arb, precision); }
inline Real operator-(const Real& a) { return 0 - a; }

inline bool operator<(const Real& a, const Real& b) { return arb_lt(a.arb, b.arb); }
inline bool operator>=(const Real& a, const Real& b) { return arb_ge(a.arb, b.arb); }

inline Real pi() { return result_of(arb_const_pi, precision); }

/// The square root of what is not negative, though its enclosure may reach below zero.
inline Real square_root(const Real& a) { return result_of(arb_sqrtpos, a.arb, precision); }

/// Sine and cosine of pi a.
inline std::pair<Real, Real> sine_and_cosine_of_pi(const Real& a) {
  std::pair<Real, Real> result;
  arb_sin_cos_pi(result.first.arb, result.second.arb, a.arb, precision);
  return result;
}

/// The midpoint, exact.
inline Real middle(const Real& a) { return result_of(arb_get_mid_arb, a.arb); }

/// The radius, exact.
inline Real radius(const Real& a) { return result_of(arb_get_rad_arb, a.arb); }

/// The lower end of an enclosure, exact.
inline Real lower_end(const Real& a) {
  return result_of(arb_sub, middle(a).arb, radius(a).arb, ARF_PREC_EXACT);
}

/// The upper end of an enclosure, exact.
inline Real upper_end(const Real& a) {
  return result_of(arb_add, middle(a).arb, radius(a).arb, ARF_PREC_EXACT);
}

/// All numbers from one to another.
inline Real interval(const Real& from, const Real& to) {
  return result_of(arb_union, from.arb, to.arb, precision);
}

/// Whether one enclosure lies within another.
inline bool contains(const Real& outer, const Real& inner) { return arb_contains(outer.arb, inner.arb); }

/// Adds 2^-bits to the radius.
inline void widen(Real& a, slong bits) { arb_add_error_2exp_si(a.arb, -bits); }

using Vec = std::array<Real, 3>;

inline Vec operator+(const Vec& a, const Vec& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vec operator-(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vec operator*(const Vec& a, const Real& s) { return {a[0] * s, a[1] * s, a[2] * s}; }
inline Vec operator/(const Vec& a, const Real& s) { return {a[0] / s, a[1] / s, a[2] / s}; }
inline Vec operator-(const Vec& a) { return Vec{} - a; }

inline Real dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

inline Real length(const Vec& a) { return square_root(dot(a, a)); }

inline Vec cross(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace checker
