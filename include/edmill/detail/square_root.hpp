// Correctly rounded square root of a float128. libquadmath rounds it incorrectly for a quarter of
// its arguments.
#pragma once

#include <quadmath.h>

#include <boost/multiprecision/float128.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace edmill::detail {

/// x - r^2, exact if r is within one unit in the last place of the root: each partial product of
/// the square has at most 112 bits.
inline __float128 rest_of_square(__float128 x, __float128 r) {
  const __float128 shifted = r * (__float128(0x1p57) + 1);
  const __float128 high = shifted - (shifted - r), low = r - high;
  return ((x - high * high) - 2 * high * low) - low * low;
}

/// 2^k for the normal number 2^k <= r < 2^(k+1).
inline __float128 leading_bit(__float128 r) {
  std::uint64_t words[2];
  std::memcpy(words, &r, sizeof r);
  words[0] = 0;
  words[1] &= 0x7fff'0000'0000'0000;
  std::memcpy(&r, words, sizeof r);
  return r;
}

/// @pre 2^-400 < x < 2^400: nothing underflows in double
inline __float128 square_root_of(__float128 x) {
  // One step of Newton's method of second order from the root in double, whose square is exact.
  const double near = std::sqrt(static_cast<double>(x));
  const __float128 start = near, step = (x - start * start) / (2 * start);
  const double bend = static_cast<double>(step);
  const __float128 more = step - __float128(bend * bend / (2 * near));
  __float128 r = start + more;
  // `more` is accurate to 150 bits of the root, so the sum is the nearest number unless it is close
  // to halfway between two numbers.
  const __float128 lost = more - (r - start), first = leading_bit(r),
                   above = first * __float128(0x1p-112);
  if (lost < above * __float128(0x1.ffffffp-2) && lost > above * __float128(-0x1.ffffffp-3))
    return r;
  const __float128 rest = rest_of_square(x, r), below = r == first ? above / 2 : above;
  if (rest > r * above)
    r += above;
  else if (rest <= -r * below)
    r -= below;
  return r;
}

inline __float128 square_root(__float128 x) {
  if (x > __float128(0x1p-400) && x < __float128(0x1p400)) return square_root_of(x);
  if (!(x > 0 && x - x == 0)) return sqrtq(x);  // itself, or not a number
  int exponent;
  x = frexpq(x, &exponent);
  const int odd = exponent & 1;
  return ldexpq(square_root_of(odd ? 2 * x : x), (exponent - odd) / 2);
}

}  // namespace edmill::detail

namespace boost::multiprecision {
/// Overload resolution prefers this to the template, which calls libquadmath.
inline float128 sqrt(const float128& x) {
  return float128(edmill::detail::square_root(x.backend().value()));
}
}  // namespace boost::multiprecision
