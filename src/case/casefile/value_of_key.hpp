// A number of a case as its file or a setting gives it, and the case with another one.
#pragma once

#include <string>

#include "casefile/case_spec.hpp"

namespace edmill::casefile {

/// "12.7 mm": digits and unit as they are written.
struct WrittenNumber {
  std::string number, unit;

  /// The number and sign 10^-digits more, exactly, with its unit.
  std::string plus(int sign, unsigned digits) const;
};

/// @param key  "contact.restitution", "balls.0.diameter"
/// @throws InputError when the case gives no such number
WrittenNumber value_of_key(const CaseSpec& spec, const std::string& key);

/// The case with another value of a key, read anew.
CaseSpec with_value(const CaseSpec& spec, const std::string& key, const std::string& value);

/// The same where the value may be of any size, 1e-380 too: a case close to this one, to derive by.
CaseSpec with_close_value(const CaseSpec& spec, const std::string& key, const std::string& value);

/// Reads a case with other settings whose quantities may be of any size.
CaseSpec parse_close_case(const CaseSpec& spec, const std::vector<std::string>& settings);

}  // namespace edmill::casefile
