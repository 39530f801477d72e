// Implementation of to_text and from_text; included by the instantiation files only.
#pragma once

#include <fmt/format.h>

#include <cstdlib>
#include <stdexcept>

#include "base/scalar_list.hpp"

namespace edmill {

template <class Real> std::string to_text(const Real& value) {
  if constexpr (std::is_same_v<Real, double>)
    return fmt::format("{}", value);  // the shortest text that round-trips
  else if constexpr (std::numeric_limits<Real>::digits > 0)
    return value.str(std::numeric_limits<Real>::max_digits10);
  else
    return value.str(static_cast<int>(Real::shown()));
}

template <class Real> Real from_text(const std::string& text) {
  const auto first = text.find_first_not_of(" \t");
  const bool number = first != std::string::npos &&
      text.find_first_not_of("0123456789+-.eE \t\r") == std::string::npos &&
      text.find_first_of("0123456789") != std::string::npos;
  if (!number) throw std::invalid_argument("not a number: '" + text + "'");
  const std::string trimmed = text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
  if constexpr (std::is_same_v<Real, double>) {
    char* end = nullptr;
    const double value = std::strtod(trimmed.c_str(), &end);
    if (*end != '\0' || !std::isfinite(value))
      throw std::invalid_argument("not a number: '" + text + "'");
    return value;
  } else {
    try {
      return Real(trimmed);
    } catch (const std::exception&) {
      throw std::invalid_argument("not a number: '" + text + "'");
    }
  }
}

}  // namespace edmill
