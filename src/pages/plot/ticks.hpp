// Ticks of axes, and numbers formatted for readers.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace edmill::plot {

struct Tick {
  double place;
  std::string label;  ///< empty for a mark between the labelled ones
};

/// Multiples of 1, 2 or 5 times a power of ten inside [low, high], at most `most` of them (and two
/// at least when `most` > 3). @pre low < high
std::vector<Tick> linear_ticks(double low, double high, int most = 6);

/// Linear ticks, but fewer of them if their labels side by side would not fit. @param room  [px]
std::vector<Tick> fitting_ticks(double low, double high, int most, double room);

/// Powers of ten inside [low, high], about `most` of them with labels, and unlabelled multiples 2
/// to 9 between them if there are few decades. @pre 0 < low < high
std::vector<Tick> log_ticks(double low, double high, int most = 7);

/// Width of a label, or of the widest of several, in the largest font of the pages [px].
double width_of(const std::string& label);
double width_of(const std::vector<Tick>& ticks);

/// "0.1803", "1.2 x 10^-5" with a real minus and superscripts, thousands apart: for reading only.
/// @param digits  significant ones
std::string readable(double value, int digits = 4);

/// A value as `readable` writes it, without zeros at the end: "38", "0.5".
std::string brief(double value, int digits = 6);

/// A value and its half-width with the digits that the half-width allows: "5.542" and "0.031".
std::pair<std::string, std::string> with_interval(double value, double half_width);

}  // namespace edmill::plot
