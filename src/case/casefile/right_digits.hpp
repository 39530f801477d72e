// How many digits of a number stand in files and texts.
#pragma once

#include "base/scalar_list.hpp"
#include "casefile/case_spec.hpp"

namespace edmill::casefile {

/// For a scope: the digits that the case asks for and a few more, and not all of the scalar's. Nothing for
/// scalars of a fixed number of digits, and cases that name a precision.
template <class Real>
auto only_right_digits(const CaseSpec& spec) {
  auto digits = ChosenDigits<Real>();
  if constexpr (requires { digits.shown; })
    if (spec.digits) digits.shown = static_cast<unsigned>(*spec.digits) + 3;
  return digits.use();
}

}  // namespace edmill::casefile
