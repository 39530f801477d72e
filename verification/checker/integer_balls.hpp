// Enclosures by integers of any size (Boost's cpp_int, header files only): for where Arb is not,
// and as a second arithmetic under the same rules.
#pragma once

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cstdint>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "precision.hpp"

namespace checker {

using Integer = boost::multiprecision::cpp_int;
using Exponent = std::int64_t;

/// So many bits more have results that are rounded afterwards.
constexpr Exponent spare_bits = 32;

/// Bits of |m|.
inline Exponent bits_of(const Integer& m) {
  return m == 0 ? 0 : static_cast<Exponent>(msb(m < 0 ? Integer(-m) : m)) + 1;
}

/// m 2^up, towards zero for a negative `up`.
inline Integer shifted(const Integer& m, Exponent up) {
  if (up > 1 << 22) throw std::invalid_argument("numbers too far apart");
  if (up >= 0) return m << static_cast<unsigned>(up);
  if (-up > bits_of(m)) return 0;
  const Integer size = (m < 0 ? Integer(-m) : m) >> static_cast<unsigned>(-up);
  return m < 0 ? Integer(-size) : size;
}

/// m 2^e, exact.
struct Dyadic {
  Integer m = 0;
  Exponent e = 0;
};

inline Dyadic operator-(const Dyadic& a) { return {-a.m, a.e}; }
inline Dyadic operator+(const Dyadic& a, const Dyadic& b) {
  if (a.m == 0) return b;
  if (b.m == 0) return a;
  const Exponent e = std::min(a.e, b.e);
  return {shifted(a.m, a.e - e) + shifted(b.m, b.e - e), e};
}
inline Dyadic operator-(const Dyadic& a, const Dyadic& b) { return a + -b; }
inline Dyadic operator*(const Dyadic& a, const Dyadic& b) { return {a.m * b.m, a.e + b.e}; }
inline Dyadic size_of(const Dyadic& a) { return a.m < 0 ? -a : a; }
inline bool operator<(const Dyadic& a, const Dyadic& b) { return (b - a).m > 0; }

/// A number of at most 30 bits that is not below one that is not negative.
inline Dyadic rounded_up(const Dyadic& a) {
  const Exponent surplus = bits_of(a.m) - 30;
  if (surplus <= 0) return a;
  return {shifted(a.m, -surplus) + 1, a.e + surplus};
}

/// An upper bound of a / b for a that is not negative and a positive b.
inline Dyadic quotient_rounded_up(const Dyadic& a, const Dyadic& b) {
  const Exponent up = std::max<Exponent>(0, 32 + bits_of(b.m) - bits_of(a.m));
  return a.m == 0 ? a : rounded_up({shifted(a.m, up) / b.m + 1, a.e - b.e - up});
}

/// An enclosure: all real numbers within a radius of a midpoint; or all there are.
/// The result of an operation holds the results for all numbers of its operands. A comparison is
/// true if it is true for all of them; if it is false, it may be undecided.
struct Real {
  Dyadic midpoint, radius;
  bool unbounded = false;

  Real(long n = 0) : midpoint{n, 0} {}  // implicit, for the integers in formulas
  /// Rounds the midpoint to the nearest of the precision.
  Real(const Dyadic& m, const Dyadic& r) : midpoint(m), radius(rounded_up(r)) {
    const Exponent surplus = bits_of(m.m) - precision;
    if (surplus <= 0) return;
    const Integer half = shifted(1, surplus - 1);
    midpoint = {
        shifted(m.m < 0 ? Integer(m.m - half) : Integer(m.m + half), -surplus), m.e + surplus};
    if ((m - midpoint).m != 0) radius = rounded_up(radius + Dyadic{1, m.e + surplus - 1});
  }
  static Real exact(const Dyadic& m, const Dyadic& r = {}) {
    Real value;
    value.midpoint = m, value.radius = r;
    return value;
  }
  static Real any() {
    Real value;
    value.unbounded = true;
    return value;
  }

  Dyadic lower() const { return midpoint - radius; }
  Dyadic upper() const { return midpoint + radius; }
  bool positive() const { return !unbounded && lower().m > 0; }
  bool negative() const { return !unbounded && upper().m < 0; }
  bool zero() const { return !unbounded && midpoint.m == 0 && radius.m == 0; }
};

inline Real operator+(const Real& a, const Real& b) {
  if (a.unbounded || b.unbounded) return Real::any();
  return {a.midpoint + b.midpoint, a.radius + b.radius};
}
inline Real operator-(const Real& a) {
  Real value = a;
  value.midpoint = -a.midpoint;
  return value;
}
inline Real operator-(const Real& a, const Real& b) { return a + -b; }
inline Real operator*(const Real& a, const Real& b) {
  if (a.unbounded || b.unbounded) return Real::any();
  return {a.midpoint * b.midpoint,
      rounded_up(size_of(a.midpoint)) * b.radius + rounded_up(size_of(b.midpoint)) * a.radius +
          a.radius * b.radius};
}
inline Real operator/(const Real& a, const Real& b) {
  const Dyadic divisor = size_of(b.midpoint), least = divisor - b.radius;
  if (a.unbounded || b.unbounded || least.m <= 0) return Real::any();
  const Exponent up =
      std::max<Exponent>(0, precision + spare_bits + bits_of(divisor.m) - bits_of(a.midpoint.m));
  Dyadic quotient{0, a.midpoint.e - b.midpoint.e - up};
  Integer rest;
  divide_qr(shifted(a.midpoint.m, up), b.midpoint.m, quotient.m, rest);
  const Dyadic cut_off{rest == 0 ? 0 : 1, quotient.e};
  // |x/y - a/b| <= (r_a |b| + r_b |a|) / (|b| (|b| - r_b))
  const Dyadic spread =
      quotient_rounded_up(a.radius * divisor + b.radius * size_of(a.midpoint), divisor * least);
  return {quotient, spread + cut_off};
}

inline bool operator<(const Real& a, const Real& b) {
  return !a.unbounded && !b.unbounded && a.upper() < b.lower();
}
inline bool operator>=(const Real& a, const Real& b) {
  return !a.unbounded && !b.unbounded && !(a.lower() < b.upper());
}

/// The midpoint, exact.
inline Real middle(const Real& a) { return a.unbounded ? a : Real::exact(a.midpoint); }

/// The radius, exact.
inline Real radius(const Real& a) { return a.unbounded ? a : Real::exact(a.radius); }

/// The lower end of an enclosure, exact.
inline Real lower_end(const Real& a) { return a.unbounded ? a : Real::exact(a.lower()); }

/// The upper end of an enclosure, exact.
inline Real upper_end(const Real& a) { return a.unbounded ? a : Real::exact(a.upper()); }

inline Real hull(const Dyadic& from, const Dyadic& to) {
  return {(from + to) * Dyadic{1, -1}, (to - from) * Dyadic{1, -1}};
}

/// All numbers from one to another.
inline Real interval(const Real& from, const Real& to) {
  if (from.unbounded || to.unbounded) return Real::any();
  return hull(std::min(from.lower(), to.lower()), std::max(from.upper(), to.upper()));
}

/// Whether one enclosure lies within another.
inline bool contains(const Real& outer, const Real& inner) {
  return outer.unbounded ||
      (!inner.unbounded && !(inner.lower() < outer.lower()) && !(outer.upper() < inner.upper()));
}

/// Adds 2^-bits to the radius.
inline void widen(Real& a, long bits) { a.radius = rounded_up(a.radius + Dyadic{1, -bits}); }

/// The square root of what is not negative, though its enclosure may reach below zero.
inline Real square_root(const Real& a) {
  if (a.unbounded || a.upper().m < 0) return Real::any();
  // The integer below the root of m 2^up, of at least as many bits as the precision.
  const auto below = [](const Dyadic& x) -> Dyadic {
    if (x.m <= 0) return {};
    Exponent up = std::max<Exponent>(0, 2 * (precision + spare_bits) - bits_of(x.m));
    if ((x.e - up) % 2 != 0) ++up;
    return {sqrt(shifted(x.m, up)), (x.e - up) / 2};
  };
  const Dyadic high = below(a.upper());
  const bool square = (high * high - a.upper()).m == 0;
  return hull(below(a.lower()), square ? high : high + Dyadic{1, high.e});
}

/// Fixed-point numbers: integers in units of 2^-bits. Cut off at each operation, far below the
/// precision.
namespace fixed {

inline Exponent bits() { return precision + spare_bits; }

/// 2^-16 times the last bit of the precision: the errors of 2^15 operations.
inline Dyadic error() { return {1, -precision - spare_bits / 2}; }

/// The arctangent of 1/n.
inline Integer arctangent_of_inverse(unsigned n) {
  Integer power = shifted(1, bits()) / n, sum = power;
  for (unsigned k = 3; power != 0; k += 2) {
    power /= n * n;
    sum += k % 4 == 3 ? Integer(-power / k) : Integer(power / k);
  }
  return sum;
}

/// By Machin's formula, once for each precision.
inline const Integer& pi() {
  static std::map<Exponent, Integer> known;
  const auto found = known.find(bits());
  if (found != known.end()) return found->second;
  Integer value = 16 * arctangent_of_inverse(5) - 4 * arctangent_of_inverse(239);
  return known.emplace(bits(), std::move(value)).first->second;
}

/// Of an angle of at most pi/4, by Taylor's series.
inline std::pair<Integer, Integer> sine_and_cosine(const Integer& angle) {
  Integer term = shifted(1, bits()), sine = 0, cosine = term;
  for (unsigned k = 1; term != 0; ++k) {
    term = shifted(term * angle, -bits()) / k;
    Integer& sum = k % 2 == 0 ? cosine : sine;
    if (k % 4 < 2)
      sum += term;
    else
      sum -= term;
  }
  return {sine, cosine};
}

}  // namespace fixed

inline Real pi() { return {{fixed::pi(), -fixed::bits()}, fixed::error()}; }

/// Sine and cosine of pi a.
inline std::pair<Real, Real> sine_and_cosine_of_pi(const Real& a) {
  const Dyadic spread = a.radius * Dyadic{3373259427, -30};  // pi, and 1e-9 more
  const Real whole_range = Real::exact({}, {1, 0});
  if (a.unbounded || Dyadic{1, 0} < spread) return {whole_range, whole_range};
  // The nearest number of quarter turns, and what is left, from -1/4 to 1/4.
  const Dyadic twice = a.midpoint * Dyadic{1, 1} + Dyadic{1, -1};
  Integer quarters = shifted(twice.m, twice.e);
  if (twice.m < 0 && (twice - Dyadic{quarters, 0}).m != 0) --quarters;  // downwards
  const Dyadic rest = a.midpoint - Dyadic{quarters, -1};
  const Integer angle =
      shifted(fixed::pi() * shifted(rest.m, rest.e + fixed::bits()), -fixed::bits());
  const auto [s, c] = fixed::sine_and_cosine(angle);
  const Dyadic error = rest.m == 0 ? Dyadic{} : fixed::error();  // 0 and 1 are exact
  // |sin(x + d) - sin x| <= |cos x| |d| + d^2 / 2, and the same with the two exchanged.
  const auto within = [&](const Integer& derivative) {
    const Dyadic slope = size_of({derivative, -fixed::bits()}) + error;
    return rounded_up(slope) * spread + spread * spread * Dyadic{1, -1} + error;
  };
  const Real sine({s, -fixed::bits()}, within(c)), cosine({c, -fixed::bits()}, within(s));
  switch (static_cast<int>(((quarters % 4) + 4) % 4)) {
    case 0: return {sine, cosine};
    case 1: return {cosine, -sine};
    case 2: return {-sine, -cosine};
    default: return {-cosine, sine};
  }
}

/// A fraction of integers, "119/25000" or "-2"; nothing for another text.
inline std::optional<Real> fraction(const std::string& text) {
  const auto integer = [](const std::string& word) -> std::optional<Integer> {
    const std::size_t sign = word[0] == '-';
    if (word.size() == sign || word.find_first_not_of("0123456789", sign) != std::string::npos)
      return std::nullopt;
    const auto first = std::min(word.find_first_not_of('0', sign), word.size() - 1);
    const Integer size(word.substr(first));  // a zero in front would make it octal
    return sign == 1 ? Integer(-size) : size;
  };
  const auto slash = text.find('/');
  const auto above = integer(text.substr(0, slash)),
             below = slash == std::string::npos ? Integer(1) : integer(text.substr(slash + 1));
  if (!above || !below || *below == 0) return std::nullopt;
  return Real::exact({*above, 0}) / Real::exact({*below, 0});
}

/// Midpoint and radius of four words in hexadecimal. @pre they are what numbers.cpp lets pass
inline std::optional<Real> midpoint_and_radius(const std::string& words) {
  std::istringstream in(words);
  const auto integer = [&] {
    std::string word;
    in >> word;
    const bool negative = word[0] == '-';
    const Integer size("0x" + word.substr(negative));
    return negative ? Integer(-size) : size;
  };
  const auto dyadic = [&]() -> Dyadic {
    const Integer m = integer();
    return {m, static_cast<Exponent>(integer())};
  };
  const Dyadic midpoint = dyadic();
  return Real::exact(midpoint, dyadic());
}

}  // namespace checker
