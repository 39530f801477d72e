// The scalars of the core, in one place. Heavy: include it only where wide scalars are named.
#pragma once

#include <array>
#include <boost/multiprecision/eigen.hpp>

#include "base/archive.hpp"
#include "base/scalar.hpp"
#include "edmill/scalars.hpp"

namespace edmill {

template <>
struct ScalarName<float128> {
  static constexpr std::string_view value = "float128";
};
/// "mpfr50"
template <unsigned digits>
struct ScalarName<mpfr_of<digits>> {
  static constexpr std::array<char, 7> text = [] {
    std::array<char, 7> name{'m', 'p', 'f', 'r'};
    unsigned place = digits < 100 ? 5 : 6;
    for (unsigned rest = digits; rest > 0; rest /= 10) name[place--] = static_cast<char>('0' + rest % 10);
    return name;
  }();
  static constexpr std::string_view value{text.data(), digits < 100 ? 6 : 7};
};

#if defined(EDMILL_NATIVE_FLOAT128)
/// As IEEE's binary128.
inline void archive_value(Archive& a, float128& value) {
  a.raw(&value.backend().value(), sizeof value.backend().value());  // x86-64 has the order of files
}
#else
void archive_value(Archive& a, float128& value);
#endif
#if !defined(EDMILL_WITHOUT_MPFR)
/// All limbs, so that no bit depends on a conversion.
template <unsigned digits>
void archive_value(Archive& a, mpfr_of<digits>& value) {
  const auto number = value.backend().data();
  std::int64_t exponent = number->_mpfr_exp;
  a(number->_mpfr_sign, exponent);
  number->_mpfr_exp = static_cast<mpfr_exp_t>(exponent);
  const auto bits = static_cast<std::size_t>(mpfr_get_prec(number));
  for (std::size_t limb = 0; limb * mp_bits_per_limb < bits; ++limb) a(number->_mpfr_d[limb]);
}
#endif

template <>
struct WiderScalar<double> {
  using type = float128;
};
template <>
struct WiderScalar<float128> {
  using type = mpfr50;
};

}  // namespace edmill

/// Applies `MACRO(Real)` to every scalar. Another number of MPFR's digits takes a line here, one in
/// edmill/scalars.hpp, and a file each in src/instances and src/instances/tools.
#if defined(EDMILL_WITHOUT_MPFR)
#define EDMILL_FOR_EACH_SCALAR(MACRO) \
  MACRO(double)                       \
  MACRO(::edmill::float128)
#else
#define EDMILL_FOR_EACH_SCALAR(MACRO) \
  MACRO(double)                       \
  MACRO(::edmill::float128)           \
  MACRO(::edmill::mpfr50)             \
  MACRO(::edmill::mpfr100)            \
  MACRO(::edmill::mpfr200)
#endif
