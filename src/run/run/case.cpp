#include "edmill/case.hpp"

#include <utility>

#include "base/standard_arithmetic.hpp"
#include "base/version.hpp"
#include "casefile/case_spec.hpp"
#include "edmill/version.hpp"

namespace edmill {

std::string library_version() { return version(); }

Case::Case(casefile::CaseSpec spec)
    : spec_(std::make_shared<casefile::CaseSpec>(std::move(spec))) {}

Case Case::read(const std::string& path, const std::vector<std::string>& settings) {
  const StandardArithmetic scope;
  return Case(casefile::read_case(path, settings));
}
Case Case::parse(
    const std::string& text, const std::string& name, const std::vector<std::string>& settings) {
  const StandardArithmetic scope;
  return Case(casefile::parse_case(text, name, settings));
}

const std::string& Case::digest() const { return spec_->digest; }
const std::string& Case::precision() const { return spec_->precision; }
int Case::ball_count() const { return static_cast<int>(spec_->ball_count()); }

}  // namespace edmill
