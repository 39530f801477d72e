// The scalars of a run by their names in case files and commands.
#pragma once

#include <string>
#include <vector>

namespace edmill::casefile {

class Section;

/// The scalars of a fixed number of digits, the narrowest first: "double", "float128"...
const std::vector<std::string>& precisions();

/// True if the name is one of these, or "mpfr:DIGITS".
bool is_precision(const std::string& name);

/// The valid names, for messages.
std::string choices_of_precision();

/// Decimal digits of a scalar. @pre is_precision(precision)
double digits_of(const std::string& precision);

/// Reports an unknown value of the key `precision` and replaces it by "double".
void check_precision(Section& section, std::string& name);

}  // namespace edmill::casefile
