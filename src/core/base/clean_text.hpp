// Cleans texts of any bytes for formats that restrict characters; formats shares and intervals.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace edmill {

/// The text in valid UTF-8 and characters of XML 1.0: U+FFFD replaces each byte of anything else.
std::string clean_text(std::string_view text);

/// A clean text in one line, for comments: blanks replace line ends.
std::string one_line(std::string_view text);

/// The text without leading and trailing blanks, tabs and line ends.
std::string_view trimmed(std::string_view text);

/// A share: "0.5 %", "7.1 %", "100 %".
std::string percent(double share);

/// "1 ball", "28 balls".
std::string counted(std::uint64_t number, std::string_view noun);
/// A number, to the digits of its interval: "27.92 ± 0.26", "(1.167 ± 0.035)e5"; four without one.
std::string with_interval(double value, std::optional<double> half_width);
/// A time in a convenient unit: "20.98 ± 0.29 min", "3.8 ± 0.2 days".
std::string time_with_interval(double seconds, std::optional<double> half_width);
/// An energy to three digits, with the unit that leaves the fewest zeros: "1.44 mJ".
std::string energy_text(double joules);

}  // namespace edmill
