// Access from a public Case to its parsed contents, for edmill's own programs.
#pragma once

#include "casefile/case_spec.hpp"
#include "edmill/case.hpp"

namespace edmill {

struct CaseAccess {
  static Case make(casefile::CaseSpec spec) { return Case(std::move(spec)); }
  static const casefile::CaseSpec& spec(const Case& c) { return *c.spec_; }
};

}  // namespace edmill
