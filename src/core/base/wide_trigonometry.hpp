// pi and joint sine and cosine for the wide scalars.
#pragma once

#include <array>
#include <boost/math/constants/constants.hpp>
#include <cstdint>

#include "base/scalar_list.hpp"
#include "base/trigonometry.hpp"

namespace edmill::numerics {

namespace detail {

/// Sine and cosine by additions and multiplications alone. The angle is split into a multiple of
/// pi/32, whose sine and cosine are tabulated, and a remainder with short Taylor polynomials.
template <class Real, int rest_degree, int table_degree> class SinCosTables {
 public:
  /// @param high, low  of pi/32, in two parts: products of the first with integers are exact
  SinCosTables(const Real& pi, const Real& high, const Real& low) : high_(high), low_(low) {
    Real factorial(1);  // exact: so many of its factors are two
    for (int k = 0; k <= table_degree; ++k) {
      if (k > 0) factorial *= k;
      series_[static_cast<std::size_t>(k)] = Real(k % 4 < 2 ? 1 : -1) / factorial;
    }
    for (int k = 0; k < 64; ++k) {
      const int quarters = (k + 8) / 16, rest = k - 16 * quarters;
      auto value = taylor<table_degree>(rest * pi / 32);
      for (int quarter = 0; quarter < quarters; ++quarter) value = {value.cos, -value.sin};
      multiples_[static_cast<std::size_t>(k)] = value;
    }
  }
  SinCos<Real> operator()(const Real& angle) const {
    const int parts = nearest(static_cast<double>(angle) * 10.185916357881302);
    const Real rest = parts == 0 ? angle : Real((angle - parts * high_) - parts * low_);
    const auto [s, c] = taylor<rest_degree>(rest);
    const auto& large = multiples_[static_cast<std::size_t>(parts & 63)];
    return {large.sin * c + large.cos * s, large.cos * c - large.sin * s};
  }
 private:
  template <int degree> SinCos<Real> taylor(const Real& x) const {
    const Real square = x * x;
    Real sine = series_[degree - 1], cosine = series_[degree];
    for (std::size_t k = degree - 3; k >= 3; k -= 2) sine = series_[k] + square * sine;
    for (std::size_t k = degree - 2; k >= 2; k -= 2) cosine = series_[k] + square * cosine;
    return {x + x * (square * sine), 1 + square * cosine};
  }

  Real high_, low_;
  std::array<Real, table_degree + 1> series_;  ///< of sine and cosine: +-1/k!
  std::array<SinCos<Real>, 64> multiples_;     ///< of pi/32
};

}  // namespace detail

/// Uses only operations that every implementation of binary128 rounds in the same way.
template <> struct Trigonometry<float128> {
  static float128 pi() {
    static const float128 value = bits(pi_words[0], 0x1p-62) + bits(pi_words[1] >> 15, 0x1p-111);
    return value;
  }
  static SinCos<float128> sin_cos(const float128& angle) {
    static const detail::SinCosTables<float128, 16, 32> tables(pi(),
        bits(pi_words[0], 0x1p-67) + bits(pi_words[1] >> 48, 0x1p-83),
        bits(pi_words[1] & 0xffff'ffff'ffff, 0x1p-131) + bits(pi_words[2], 0x1p-195));
    return tables(angle);
  }
 private:
  /// pi 2^62, and 128 bits after the point.
  static constexpr std::uint64_t pi_words[] = {
      0xc90f'daa2'2168'c234, 0xc4c6'628b'80dc'1cd1, 0x2902'4e08'8a67'cc74};
  static float128 bits(std::uint64_t word, double unit) { return float128(word) * float128(unit); }
};

/// Gives the same values with and without MPFR, in about MPFR's time.
template <> struct Trigonometry<mpfr50> {
  static const mpfr50& pi() { return boost::math::constants::pi<mpfr50>(); }
  static SinCos<mpfr50> sin_cos(const mpfr50& angle) {
    static const auto tables = [] {
      const mpfr_of<100> wide = boost::math::constants::pi<mpfr_of<100>>() / 32;
      const mpfr_of<100> high = ldexp(floor(ldexp(wide, 140)), -140);
      return detail::SinCosTables<mpfr50, 24, 44>(pi(), mpfr50(high), mpfr50(wide - high));
    }();
    return tables(angle);
  }
};

template <unsigned digits> struct Trigonometry<mpfr_of<digits>> {
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
    const auto data = [](auto& x) { return x.backend().data(); };
    SinCos<Real> result;
    mpfr_sin_cos(data(result.sin), data(result.cos), data(angle), MPFR_RNDN);
    return result;
  }
#endif
};

#if !defined(EDMILL_WITHOUT_MPFR)
template <> struct Trigonometry<mpfr> {
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
