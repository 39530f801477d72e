#include <cmath>

#include "base/scalar_text.hpp"
#include "base/wide_trigonometry.hpp"

// Serialisation of float128 where it is a class of Boost.
#if !defined(EDMILL_NATIVE_FLOAT128)
namespace edmill {

namespace {

constexpr int bias = 16383, fraction_bits = 112, largest = 0x7fff;
constexpr auto leading = std::uint64_t{1} << 48, fraction = leading - 1;  // of the upper word

/// Lower and upper word of the IEEE binary128 encoding.
std::array<std::uint64_t, 2> words_of(const float128& value) {
  const std::uint64_t sign = signbit(value) ? std::uint64_t{1} << 63 : 0;
  const auto with_exponent = [&](int exponent) {
    return sign | static_cast<std::uint64_t>(exponent) << 48;
  };
  if (isnan(value)) return {1, with_exponent(largest)};
  if (isinf(value)) return {0, with_exponent(largest)};
  if (value == 0) return {0, sign};
  int exponent;
  frexp(value, &exponent);  // 2^(exponent - 1) is the leading bit
  const int least = std::max(exponent - 1, 1 - bias);
  const float128 whole = ldexp(float128(abs(value)), fraction_bits - least);  // below 2^113
  const float128 upper = floor(float128(ldexp(whole, -64)));
  const auto high = static_cast<std::uint64_t>(upper);
  const auto low = static_cast<std::uint64_t>(float128(whole - ldexp(upper, 64)));
  return {
      low, (high & leading ? with_exponent(least + bias) : with_exponent(0)) | (high & fraction)};
}

float128 float128_of(const std::array<std::uint64_t, 2>& words) {
  const int exponent = static_cast<int>(words[1] >> 48 & largest);
  const bool negative = words[1] >> 63;
  float128 value;
  if (exponent == largest) {
    value = (words[1] & fraction) != 0 || words[0] != 0 ? std::numeric_limits<float128>::quiet_NaN()
                                                        : std::numeric_limits<float128>::infinity();
  } else {
    const std::uint64_t high = (words[1] & fraction) | (exponent > 0 ? leading : 0);
    const float128 whole = ldexp(float128(high), 64) + float128(words[0]);
    value = ldexp(whole, std::max(exponent, 1) - bias - fraction_bits);
  }
  return negative ? float128(-value) : value;
}

}  // namespace

void archive_value(Archive& a, float128& value) {
  auto words = words_of(value);
  a(words);
  value = float128_of(words);
}

}  // namespace edmill
#endif

#define EDMILL_TEXT(Real)                                  \
  template std::string edmill::to_text<Real>(const Real&); \
  template Real edmill::from_text<Real>(const std::string&);
EDMILL_FOR_EACH_SCALAR(EDMILL_TEXT)
template std::string edmill::to_text<edmill::mpfr50>(const edmill::mpfr50&);
