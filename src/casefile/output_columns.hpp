// Keys that several types of output have.
#pragma once

#include "casefile/section.hpp"

namespace edmill::casefile {

using Rational = boost::multiprecision::cpp_rational;

/// What a type of output allows in its columns.
struct ColumnRules {
  bool flags, counts, numbers;
  std::vector<Statistic> of_flags, of_numbers;  ///< none: the type shows single values
};

/// Reads `columns`, each with a variable of an impact.
void read_columns(Section& s, const ColumnRules& rules, OutputSpec& output);

/// Reads `variable`; place in impact_variables, or nothing when it is wrong, which is reported.
std::optional<int> read_variable(Section& s, bool flags, bool counts, bool numbers);

/// Reads `statistics`.
std::vector<Statistic> read_statistics(Section& s, const std::vector<Statistic>& allowed);

/// Reads `interval` and `max_rows`.
void read_interval(Section& s, TimerSpec& timer, const std::optional<Quantity>& fallback = std::nullopt);

/// Reads the size of a table: at least 1 and not beyond reason.
std::uint64_t read_size(Section& s, const char* key, std::uint64_t fallback);

/// Reads `contact_point`.
void read_contact_point(Section& s, OutputSpec& output);

/// The dimension in which a unit of the variables is given in a case.
Dimension dimension_of(std::string_view unit);

/// Size of a quantity, for comparisons between them.
double size_of(const Quantity& quantity);

/// "a, b, c", for messages.
std::string listed(const std::vector<std::string>& names);

}  // namespace edmill::casefile
