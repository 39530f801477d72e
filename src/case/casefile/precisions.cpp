#include "casefile/precisions.hpp"

#include <fmt/format.h>

#include "base/scalar.hpp"
#include "casefile/section.hpp"

namespace edmill::casefile {

const std::vector<std::string>& precisions() {
  static const auto names = [] {
    std::vector<std::string> all{"double", "float128"};
#if !defined(EDMILL_WITHOUT_MPFR)
    for (const unsigned digits : named_digits) all.push_back("mpfr" + std::to_string(digits));
#endif
    return all;
  }();
  return names;
}

std::string choices_of_precision() {
  return fmt::format("one of \"{}\", \"mpfr:DIGITS\" with {} to {} digits", fmt::join(precisions(), "\", \""),
                     fewest_digits, most_digits);
}

bool is_precision(const std::string& name) {
  return name == "double" || name == "float128" || chosen_digits_of(name) > 0;
}

double digits_of(const std::string& precision) {
  if (precision == "double") return 15.95;
  if (precision == "float128") return 34.02;
  return chosen_digits_of(precision);
}

void check_precision(Section& section, std::string& name) {
  if (is_precision(name)) return;
  section.require(false, "precision", choices_of_precision());
  name = precisions().front();
}

}  // namespace edmill::casefile
