// Shares as texts.
#pragma once

#include <fmt/format.h>

#include <string>

namespace edmill {

/// "0.5 %", "7.1 %", "100 %".
inline std::string percent(double share) {
  const double hundredths = 100 * share;
  return hundredths < 99.5 ? fmt::format("{:.2g} %", hundredths) : fmt::format("{:.0f} %", hundredths);
}

}  // namespace edmill
