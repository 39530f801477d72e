// pi and joint sine and cosine for the wide scalars.
#pragma once

#include <array>
#include <boost/math/constants/constants.hpp>
#include <cstdint>

#include "base/scalar_list.hpp"
#include "base/trigonometry.hpp"

namespace edmill::numerics {

/// By additions and multiplications alone, which every binary128 rounds alike.
template <>
struct Trigonometry<float128> {
  static float128 pi() {
    static const float128 value = bits(pi_words[0], 0x1p-62) + bits(pi_words[1] >> 15, 0x1p-111);
    return value;
  }
  /// The angle is a multiple of pi/32, of which a table has sine and cosine, and a rest, for which Taylor's
  /// polynomials are short.
  static SinCos<float128> sin_cos(const float128& angle) {
    static const Tables tables;
    const int parts = detail::nearest(static_cast<double>(angle) * 10.185916357881302);
    const float128 rest = parts == 0 ? angle : float128((angle - parts * tables.high) - parts * tables.low);
    const auto small = tables.taylor<16>(rest);
    const auto& large = tables.multiples[static_cast<std::size_t>(parts & 63)];
    return {large.sin * small.cos + large.cos * small.sin, large.cos * small.cos - large.sin * small.sin};
  }

 private:
  /// pi 2^62, and 128 bits after the point.
  static constexpr std::uint64_t pi_words[] = {0xc90f'daa2'2168'c234, 0xc4c6'628b'80dc'1cd1,
                                               0x2902'4e08'8a67'cc74};
  static float128 bits(std::uint64_t word, double unit) { return float128(word) * float128(unit); }

  struct Tables {
    /// pi/32 in two parts: products of the first, 80 bits, with integers are exact.
    float128 high = bits(pi_words[0], 0x1p-67) + bits(pi_words[1] >> 48, 0x1p-83);
    float128 low = bits(pi_words[1] & 0xffff'ffff'ffff, 0x1p-131) + bits(pi_words[2], 0x1p-195);
    std::array<float128, 33> series;             ///< of sine and cosine: +-1/k!
    std::array<SinCos<float128>, 64> multiples;  ///< of pi/32

    Tables() {
      float128 factorial(1);  // exact: 32! has 31 factors of two
      for (int k = 0; k < 33; ++k) {
        if (k > 0) factorial *= k;
        series[static_cast<std::size_t>(k)] = float128(k % 4 < 2 ? 1 : -1) / factorial;
      }
      for (int k = 0; k < 64; ++k) {
        const int quarters = (k + 8) / 16, rest = k - 16 * quarters;
        auto value = taylor<32>(rest * pi() / 32);
        for (int quarter = 0; quarter < quarters; ++quarter) value = {value.cos, -value.sin};
        multiples[static_cast<std::size_t>(k)] = value;
      }
    }
    template <int degree>
    SinCos<float128> taylor(const float128& x) const {
      const float128 square = x * x;
      float128 sine = series[degree - 1], cosine = series[degree];
      for (std::size_t k = degree - 3; k >= 3; k -= 2) sine = series[k] + square * sine;
      for (std::size_t k = degree - 2; k >= 2; k -= 2) cosine = series[k] + square * cosine;
      return {x + x * (square * sine), 1 + square * cosine};
    }
  };
};

template <unsigned digits>
struct Trigonometry<mpfr_of<digits>> {
  using Real = mpfr_of<digits>;
#if defined(EDMILL_WITHOUT_MPFR)
  static Real pi() { return boost::math::constants::pi<Real>(); }
  static SinCos<Real> sin_cos(const Real& angle) { return {sin(angle), cos(angle)}; }
#else
  static Real pi() {
    static const Real value = [] {
      Real p;
      mpfr_const_pi(p.backend().data(), MPFR_RNDN);
      return p;
    }();
    return value;
  }
  static SinCos<Real> sin_cos(const Real& angle) {
    SinCos<Real> result;
    mpfr_sin_cos(result.sin.backend().data(), result.cos.backend().data(), angle.backend().data(), MPFR_RNDN);
    return result;
  }
#endif
};

#if !defined(EDMILL_WITHOUT_MPFR)
template <>
struct Trigonometry<mpfr> {
  static const mpfr& pi() {
    static thread_local mpfr value;
    if (mpfr_get_prec(value.data()) != mpfr::bits()) {
      value.set_precision(mpfr::bits());
      mpfr_const_pi(value.data(), MPFR_RNDN);
    }
    return value;
  }
  static SinCos<mpfr> sin_cos(const mpfr& angle) {
    SinCos<mpfr> result;
    result.sin.set_precision(mpfr::bits());
    result.cos.set_precision(mpfr::bits());
    mpfr_sin_cos(result.sin.data(), result.cos.data(), angle.data(), MPFR_RNDN);
    return result;
  }
};
#endif

}  // namespace edmill::numerics
