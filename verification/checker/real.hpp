// Arb's balls with operators, vectors of them, and numbers as a certificate writes them.
#pragma once

#include <arb.h>
#include <flint/fmpq.h>

#include <array>
#include <sstream>
#include <stdexcept>
#include <string>

namespace checker {
inline slong precision = 128;  ///< bits of all arithmetic
struct AtPrecision {
  slong before = precision;
  explicit AtPrecision(slong bits) { precision = bits; }
  ~AtPrecision() { precision = before; }
};

struct Real {
  arb_t x;
  Real(slong n = 0) { arb_init(x), arb_set_si(x, n); }  // NOLINT
  Real(const Real& o) { arb_init(x), arb_set(x, o.x); }
  Real(Real&& o) noexcept { arb_init(x), arb_swap(x, o.x); }
  Real& operator=(Real o) noexcept { return arb_swap(x, o.x), *this; }
  ~Real() { arb_clear(x); }
  bool positive() const { return arb_is_positive(x); }
  bool negative() const { return arb_is_negative(x); }
  bool zero() const { return arb_is_zero(x); }
};
/// The result of one of Arb's functions.
template <class Function, class... More>
Real made(Function function, const More&... more) {
  Real r;
  return function(r.x, more...), r;
}
inline Real operator+(const Real& a, const Real& b) { return made(arb_add, a.x, b.x, precision); }
inline Real operator-(const Real& a, const Real& b) { return made(arb_sub, a.x, b.x, precision); }
inline Real operator*(const Real& a, const Real& b) { return made(arb_mul, a.x, b.x, precision); }
inline Real operator/(const Real& a, const Real& b) { return made(arb_div, a.x, b.x, precision); }
inline bool operator<(const Real& a, const Real& b) { return arb_lt(a.x, b.x); }
inline bool operator>=(const Real& a, const Real& b) { return arb_ge(a.x, b.x); }
inline Real root(const Real& a) { return made(arb_sqrtpos, a.x, precision); }
inline Real pi() { return made(arb_const_pi, precision); }
inline Real middle(const Real& a) { return made(arb_get_mid_arb, a.x); }
/// The ends of an interval, exact.
inline Real end(const Real& a, int side) {
  const Real radius = made(arb_get_rad_arb, a.x);
  return made(side < 0 ? arb_sub : arb_add, middle(a).x, radius.x, ARF_PREC_EXACT);
}

using Vec = std::array<Real, 3>;
inline Vec operator+(const Vec& a, const Vec& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vec operator-(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vec operator*(const Vec& a, const Real& s) { return {a[0] * s, a[1] * s, a[2] * s}; }
inline Vec operator/(const Vec& a, const Real& s) { return {a[0] / s, a[1] / s, a[2] / s}; }
inline Real dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vec cross(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
[[noreturn]] inline void no_number(const std::string& s) { throw std::invalid_argument("no number: " + s.substr(0, 60)); }
inline slong small_number(const std::string& text) {
  const bool digits = text.find_first_not_of("0123456789", text[0] == '-') == std::string::npos;
  if (text.empty() || text == "-" || text.size() > 7 || !digits) no_number(text);
  return std::stol(text);
}
/// "119/25000", "-2", "1/12*pi", "55*pi^-1"
inline Real exact_number(const std::string& text) {
  const auto star = text.find("*pi");
  fmpq_t rational;
  fmpq_init(rational);
  const bool bad = text.size() > 100000 || text.find_first_not_of("-0123456789/*pi^") != text.npos ||
                   fmpq_set_str(rational, text.substr(0, star).c_str(), 10) != 0 || fmpz_is_zero(fmpq_denref(rational));
  Real value = bad ? Real() : made(arb_set_fmpq, rational, precision);
  fmpq_clear(rational);
  const auto power = star == std::string::npos ? "^0" : text.substr(star + 3);
  if (bad || (!power.empty() && power[0] != '^')) no_number(text);
  const slong k = power.empty() ? 1 : small_number(power.substr(1));
  if (std::abs(k) > 16) no_number(text);
  for (slong i = 0; i < std::abs(k); ++i) value = k > 0 ? value * pi() : value / pi();
  return value;
}
/// "1a2b -8c 3ff -98": midpoint and radius, each a whole number times a power of two, all in hexadecimal.
inline Real enclosure(const std::string& text) {
  std::istringstream in(text);
  std::string word[4], more;
  bool good = in >> word[0] >> word[1] >> word[2] >> word[3] && !(in >> more);
  for (std::size_t k = 0; k < 4 && good; ++k) {  // Arb aborts on a radius of more than 30 bits, and on zeros with exponents
    const auto digits = word[k].substr(word[k][0] == '-' && k != 2);
    good = !digits.empty() && digits.size() <= std::array<std::size_t, 4>{25000, 6, 7, 6}[k] &&
           digits.find_first_not_of("0123456789abcdef") == digits.npos;
    if (k % 2 == 0 && digits[0] == '0') good = good && word[k] == "0" && word[k + 1] == "0";
  }
  Real value;
  if (!good || arb_load_str(value.x, text.c_str()) != 0) no_number(text);
  return value;
}

}  // namespace checker
