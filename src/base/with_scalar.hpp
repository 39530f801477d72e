// From the name of a scalar to code that is compiled for it.
#pragma once

#include <string>
#include <string_view>

#include "base/errors.hpp"
#include "base/scalar_list.hpp"

namespace edmill {

template <class... Reals>
struct Scalars {};

namespace detail {

template <class First, class... Others, class Function>
auto with_one_of(Scalars<First, Others...>, std::string_view name, const Function& function) {
#if !defined(EDMILL_WITHOUT_MPFR)
  if constexpr (std::is_same_v<First, mpfr>) {
    if (const unsigned chosen = chosen_digits_of(name)) {
      const mpfr::Digits digits(chosen);
      return function.template operator()<mpfr>();
    }
  } else
#endif
      if (name == ScalarName<First>::value)
    return function.template operator()<First>();
  if constexpr (sizeof...(Others) > 0)
    return with_one_of(Scalars<Others...>{}, name, function);
  else
    throw ContractError("no scalar named " + std::string(name));
}

template <class Nothing, class... Reals>
struct Listed {
  using type = Scalars<Reals...>;
};
#define EDMILL_LISTED(Real) , Real
using AllScalars = Listed<void EDMILL_FOR_EACH_SCALAR(EDMILL_LISTED)>::type;
#undef EDMILL_LISTED

}  // namespace detail

/// Calls `function.operator()<Real>()` with the scalar of this name.
/// @throws ContractError when there is none: names are checked where they are read
template <class Function>
auto with_scalar(std::string_view name, const Function& function) {
  return detail::with_one_of(detail::AllScalars{}, name, function);
}

}  // namespace edmill
