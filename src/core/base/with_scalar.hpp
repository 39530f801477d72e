// From the name of a scalar to code that is compiled for it.
#pragma once

#include <string>
#include <string_view>

#include "base/errors.hpp"
#include "base/scalar_list.hpp"

namespace edmill {

/// Calls `function.operator()<Real>()` with the scalar of this name.
/// @throws ContractError when there is none: names are checked where they are read
template <class Function>
auto with_scalar(std::string_view name, const Function& function) {
  if (name == ScalarName<double>::value) return function.template operator()<double>();
  if (name == ScalarName<float128>::value) return function.template operator()<float128>();
#if !defined(EDMILL_WITHOUT_MPFR)
  if (const unsigned chosen = chosen_digits_of(name)) {
    const mpfr::Digits digits(chosen);
    return function.template operator()<mpfr>();
  }
#endif
  throw ContractError("no scalar named " + std::string(name));
}

}  // namespace edmill
