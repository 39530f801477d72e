// Rates with their intervals, in tables and charts that compare some.
#pragma once

#include <optional>
#include <string>

#include "plot/chart.hpp"

namespace edmill::report {

/// A rate of a run, or of several.
struct RateOf {
  double value;
  std::optional<double> half_width;  ///< of the 95 % interval
};

/// "27.92 ± 0.23"
std::string text_of(const RateOf& rate);

/// A short line at the rate, within its interval.
/// @param half_length  of the line, in units of x
void add_point(plot::Chart& chart, double x, double half_length, const RateOf& rate, const std::string& name,
               const std::string& colour);

}  // namespace edmill::report
