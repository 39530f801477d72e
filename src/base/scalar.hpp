// What the core asks of a scalar. The scalars themselves are listed in base/scalar_list.hpp.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <string_view>

namespace edmill {

/// Name of a scalar as the case file and the records spell it, e.g. "double", "mpfr50".
template <class Real>
struct ScalarName;

template <>
struct ScalarName<double> {
  static constexpr std::string_view value = "double";
};

/// The next wider scalar of the decision ladder; void where the ladder ends.
template <class Real>
struct WiderScalar {
  using type = void;
};

template <class Real>
using Wider = typename WiderScalar<Real>::type;

/// Decimal text in as many digits as round-trip.
template <class Real>
std::string to_text(const Real& value);

/// Nearest scalar to a decimal text written by to_text.
/// @throws std::invalid_argument when the text is not a finite number
template <class Real>
Real from_text(const std::string& text);

/// Exact when `To` is wider than `From`; otherwise rounded.
template <class To, class From>
To scalar_cast(const From& value) {
  return static_cast<To>(value);
}

/// Far above the rounding of a few operations in any scalar, far below what bounds leave to spare: 2^-20.
template <class Real>
Real rounding_margin() {
  return Real(1) / 1048576;
}

/// Distance from 1 to the next scalar.
template <class Real>
Real epsilon() {
  return std::numeric_limits<Real>::epsilon();
}

}  // namespace edmill
