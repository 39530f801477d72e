// The scalars of a run by their names in case files and commands.
#pragma once

#include <string>
#include <vector>

namespace edmill::casefile {

class Section;

/// Those of a fixed number of digits, the narrowest first: "double", "float128", "mpfr50"...
const std::vector<std::string>& precisions();

/// Whether it is one of these, or "mpfr:DIGITS".
bool is_precision(const std::string& name);

/// What is expected, for messages.
std::string choices_of_precision();

/// Decimal digits of a scalar. @pre is_precision(precision)
double digits_of(const std::string& precision);

/// Reports a value of the key `precision` that is not known, and puts "double" in its place.
void check_precision(Section& section, std::string& name);

}  // namespace edmill::casefile
