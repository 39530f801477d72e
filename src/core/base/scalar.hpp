// Requirements on a scalar type; base/scalar_list.hpp lists the scalars.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

namespace edmill {

/// Name of a scalar in case files and records, "double" for example. For a scalar whose digits are
/// chosen at run time, the part of the name before the digits.
template <class Real> struct ScalarName;

/// Least and largest number of digits that can be chosen.
inline constexpr unsigned fewest_digits = 20, most_digits = 1'000'000;
/// Numbers of digits that have a short name: "mpfr50" for "mpfr:50".
inline constexpr unsigned named_digits[] = {50, 100, 200};
/// The digits in a scalar's name: 3000 for "mpfr:3000", 50 for "mpfr50"; 0 for all other names.
inline unsigned chosen_digits_of(std::string_view name) {
  for (const unsigned digits : named_digits)
    if (name == "mpfr" + std::to_string(digits)) return digits;
  constexpr std::string_view begin = "mpfr:";
  if (!name.starts_with(begin) || name.size() > begin.size() + 7) return 0;
  unsigned digits = 0;
  for (const char c : name.substr(begin.size())) {
    if (c < '0' || c > '9') return 0;
    digits = 10 * digits + static_cast<unsigned>(c - '0');
  }
  return digits >= fewest_digits && digits <= most_digits ? digits : 0;
}

/// The whole name, e.g. "mpfr:3000".
template <class Real> std::string scalar_name() { return std::string(ScalarName<Real>::value); }

template <> struct ScalarName<double> { static constexpr std::string_view value = "double"; };

/// The next wider scalar of the decision ladder; void where the ladder ends.
template <class Real> struct WiderScalar : std::type_identity<void> {};

template <class Real> using Wider = typename WiderScalar<Real>::type;

/// Decimal text with enough digits to round-trip.
template <class Real> std::string to_text(const Real& value);

/// Nearest scalar to a decimal text written by to_text.
/// @throws std::invalid_argument when the text is not a finite number
template <class Real> Real from_text(const std::string& text);

/// |x|, without a library function.
template <class Real> Real magnitude(const Real& x) { return x < 0 ? Real(-x) : x; }

/// 2^-20: far above the rounding of a few operations in any scalar, far below the slack of bounds.
template <class Real> Real rounding_margin() { return Real(1) / 1048576; }

/// Distance from 1 to the next scalar.
template <class Real> Real epsilon() { return std::numeric_limits<Real>::epsilon(); }

template <class Real> constexpr int binary_digits() { return std::numeric_limits<Real>::digits; }

/// A type for hints and bounds, which need few digits but the scalar's range towards small numbers.
/// For scalars whose digits are chosen at run time, see also `double_hints`.
template <class Real> struct HintOf : std::type_identity<double> {};
template <class Real> using Hint = typename HintOf<Real>::type;
/// True if the range of double suffices for such numbers.
template <class Real> constexpr bool double_hints() { return true; }

/// For a scalar whose digits are chosen at run time: stores those of the thread at construction;
/// `use` chooses them again for a scope. Empty for other scalars.
template <class Real> struct ChosenDigits {
  struct Scope {
    ~Scope() {}  // so that it counts as used
  };
  Scope use() const { return {}; }
};

/// A scope where sums of x with narrower numbers lose no digits, whatever the thread's precision.
template <class Real> typename ChosenDigits<Real>::Scope with_all_digits_of(const Real&) {
  return {};
}

}  // namespace edmill
