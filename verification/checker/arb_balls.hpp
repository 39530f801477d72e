// Enclosures by Arb.
#pragma once

#include <arb.h>
#include <flint/fmpq.h>

#include <optional>
#include <string>
#include <utility>

#include "precision.hpp"

namespace checker {

/// An enclosure: all real numbers within a radius of a midpoint.
/// The result of an operation holds the results for all numbers of its operands. A comparison is
/// true if it is true for all of them; if it is false, it may be undecided.
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

inline Real operator+(const Real& a, const Real& b) {
  return result_of(arb_add, a.arb, b.arb, precision);
}
inline Real operator-(const Real& a, const Real& b) {
  return result_of(arb_sub, a.arb, b.arb, precision);
}
inline Real operator*(const Real& a, const Real& b) {
  return result_of(arb_mul, a.arb, b.arb, precision);
}
inline Real operator/(const Real& a, const Real& b) {
  return result_of(arb_div, a.arb, b.arb, precision);
}
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
inline bool contains(const Real& outer, const Real& inner) {
  return arb_contains(outer.arb, inner.arb);
}

/// Adds 2^-bits to the radius.
inline void widen(Real& a, slong bits) { arb_add_error_2exp_si(a.arb, -bits); }

/// A fraction of integers, "119/25000" or "-2"; nothing for another text.
inline std::optional<Real> fraction(const std::string& text) {
  fmpq_t value;
  fmpq_init(value);
  std::optional<Real> enclosed;
  if (fmpq_set_str(value, text.c_str(), 10) == 0 && !fmpz_is_zero(fmpq_denref(value)))
    enclosed = result_of(arb_set_fmpq, value, precision);
  fmpq_clear(value);
  return enclosed;
}

/// Midpoint and radius of four words in hexadecimal. @pre they are what numbers.cpp lets pass
inline std::optional<Real> midpoint_and_radius(const std::string& words) {
  Real value;
  if (arb_load_str(value.arb, words.c_str()) != 0) return std::nullopt;
  return value;
}

}  // namespace checker
