// All scalars of the core. Slow to compile: include it only where wide scalars are named.
#pragma once

#include <boost/math/tools/precision.hpp>
#include <boost/multiprecision/eigen.hpp>
#if defined(EDMILL_WITHOUT_MPFR)
#include <boost/multiprecision/cpp_bin_float.hpp>
#else
#include <boost/multiprecision/mpfr.hpp>
#endif

#include "base/archive.hpp"
#include "base/scalar.hpp"
#include "edmill/scalars.hpp"

namespace edmill {

template <> struct ScalarName<float128> { static constexpr std::string_view value = "float128"; };
/// A scalar with a fixed number of digits, for the top of the decision ladder and for conversions.
template <unsigned digits>
using mpfr_of = boost::multiprecision::number<
#if defined(EDMILL_WITHOUT_MPFR)
    boost::multiprecision::cpp_bin_float<digits>,
#else
    boost::multiprecision::mpfr_float_backend<digits, boost::multiprecision::allocate_stack>,
#endif
    boost::multiprecision::et_off>;
/// The widest scalar of the decision ladder.
using mpfr50 = mpfr_of<50>;
template <> struct ScalarName<mpfr50> { static constexpr std::string_view value = "mpfr50"; };

#if defined(EDMILL_NATIVE_FLOAT128)
/// Saves or loads the IEEE binary128 encoding.
inline void archive_value(Archive& a, float128& value) {
  a.raw(&value.backend().value(), sizeof value.backend().value());  // x86-64 has the order of files
}
#else
void archive_value(Archive& a, float128& value);
#endif
#if !defined(EDMILL_WITHOUT_MPFR)
/// Saves or loads precision, sign, exponent and all limbs, so that no bit depends on a conversion.
inline void archive_value(Archive& a, mpfr& value) {
  std::int64_t bits = mpfr_get_prec(value.data());
  a(bits);
  if (a.loading()) {
    if (bits < 1 || bits > 10'000'000)
      throw InputError("the saved state contains a number of impossible precision");
    value.set_precision(static_cast<mpfr_prec_t>(bits));
  }
  mpfr_ptr number = value.data();
  std::int64_t exponent = number->_mpfr_exp;
  a(number->_mpfr_sign, exponent);
  number->_mpfr_exp = static_cast<mpfr_exp_t>(exponent);
  for (std::int64_t limb = 0; limb * mp_bits_per_limb < bits; ++limb) a(number->_mpfr_d[limb]);
}

template <unsigned digits> struct MpfrConversion<mpfr_of<digits>> {
  static mpfr exact(const mpfr_of<digits>& value) { return mpfr(value.backend().data()); }
  static mpfr_of<digits> rounded(const mpfr& value) {
    mpfr_of<digits> result;
    mpfr_set(result.backend().data(), value.data(), MPFR_RNDN);
    return result;
  }
};
template <> struct MpfrConversion<float128> {
  static mpfr exact(float128 value) {
    mpfr sum;
    sum.set_precision(113);
    mpfr_set_zero(sum.data(), 1);
    for (int part = 0; part < 3; ++part) {  // doubles of 53 bits
      const auto leading = static_cast<double>(value);
      mpfr_add_d(sum.data(), sum.data(), leading, MPFR_RNDN);
      value -= leading;
    }
    return sum;
  }
  static float128 rounded(const mpfr& value) {
    if (!isfinite(value) || value == mpfr(0)) return float128(static_cast<double>(value));
    mpfr rest;
    rest.set_precision(113);
    mpfr_set(rest.data(), value.data(), MPFR_RNDN);
    const long exponent = exponent_of(rest);
    mpfr_mul_2si(rest.data(), rest.data(), -exponent, MPFR_RNDN);
    float128 sum(0);
    for (int part = 0; part < 3; ++part) {
      const double leading = mpfr_get_d(rest.data(), MPFR_RNDN);
      sum += leading;
      mpfr_sub_d(rest.data(), rest.data(), leading, MPFR_RNDN);
    }
    return ldexp(sum, static_cast<int>(exponent));
  }
};

template <> struct ScalarName<mpfr> { static constexpr std::string_view value = "mpfr"; };
template <> inline std::string scalar_name<mpfr>() {
  const auto digits = std::to_string(mpfr::digits()), name = "mpfr" + digits;
  return chosen_digits_of(name) > 0 ? name : "mpfr:" + digits;
}
template <> inline mpfr epsilon<mpfr>() {
  return ldexp(mpfr(1), static_cast<int>(1 - mpfr::bits()));
}
template <> inline int binary_digits<mpfr>() { return static_cast<int>(mpfr::bits()); }
template <> struct HintOf<mpfr> : std::type_identity<mpfr> {};
template <> inline bool double_hints<mpfr>() { return mpfr::digits() <= 200; }
template <> struct ChosenDigits<mpfr> {
  unsigned digits = mpfr::digits(), shown = mpfr::shown();
  mpfr::Digits use() const { return mpfr::Digits(digits, shown); }
};
inline mpfr::Digits with_all_digits_of(const mpfr& x) {
  return mpfr::Digits(static_cast<unsigned>(mpfr_get_prec(x.data()) / 3 + 20));
}
#endif

template <> struct WiderScalar<double> : std::type_identity<float128> {};
template <> struct WiderScalar<float128> : std::type_identity<mpfr50> {};

/// Calls `function.operator()<Real>()` with the scalar of this name.
/// @throws ContractError when there is none: names are checked where they are read
template <class Function> auto with_scalar(std::string_view name, const Function& function) {
  if (name == ScalarName<double>::value) return function.template operator()<double>();
  if (name == ScalarName<float128>::value) return function.template operator()<float128>();
#if !defined(EDMILL_WITHOUT_MPFR)
  if (const unsigned chosen = chosen_digits_of(name)) {
    const mpfr::Digits digits(chosen);
    return function.template operator()<mpfr>();
  }
#else
  if (chosen_digits_of(name) > 0)
    throw InputError(
        std::string(name) + " needs MPFR, which this build of edmill does not contain");
#endif
  throw ContractError("no scalar named " + std::string(name));
}

}  // namespace edmill

#if !defined(EDMILL_WITHOUT_MPFR)
template <> struct Eigen::NumTraits<edmill::mpfr> : Eigen::GenericNumTraits<edmill::mpfr> {
  enum { ReadCost = 20, AddCost = 40, MulCost = 80 };
  static Real epsilon() { return edmill::epsilon<edmill::mpfr>(); }
  static Real dummy_precision() { return 1000 * epsilon(); }
};
namespace boost::math::tools {
template <> inline edmill::mpfr epsilon<edmill::mpfr>() { return edmill::epsilon<edmill::mpfr>(); }
template <> inline edmill::mpfr min_value<edmill::mpfr>() {
  return std::numeric_limits<double>::min();
}
template <> inline edmill::mpfr max_value<edmill::mpfr>() {
  return std::numeric_limits<double>::max();
}
}  // namespace boost::math::tools
#endif

/// Applies `MACRO(Real)` to every scalar that a run can have.
#if defined(EDMILL_WITHOUT_MPFR)
#define EDMILL_FOR_EACH_SCALAR(MACRO) MACRO(double) MACRO(::edmill::float128)
#else
#define EDMILL_FOR_EACH_SCALAR(MACRO) MACRO(double) MACRO(::edmill::float128) MACRO(::edmill::mpfr)
#endif
