#include <cmath>

#include "identify/parameters.hpp"

namespace edmill::identify {

std::vector<Parameter> term_parameters() {
  std::vector<Parameter> list;
  for (const auto& row : term_rows()) {
    const bool is_factor = row.shift == Dimension::none;
    const double change = is_factor ? 1.0 : row.shift == Dimension::time ? 1e-5 : 1e-4;
    Parameter p{row.name,  "",
                row.shift, is_factor ? 1.0 : 0.0,
                change,    [member = row.member](Assumptions& a, double x) { a.terms.*member = x; }};
    p.equation = row.equation;
    p.prior = 1;  // of two that fit alike, a number of the case comes first
    p.of_flights = row.of_flights, p.of_impacts = !row.of_flights;
    list.push_back(std::move(p));
  }
  return list;
}

Parameter restricted_to(const SharedSubset& part, const Parameter& parameter, std::size_t choices) {
  Parameter p = parameter;
  p.key += ", " + part->name;
  p.set = [part, set = parameter.set](Assumptions& a, double x) {
    a.restricted.push_back({part, [set, x](Assumptions& here) { set(here, x); }});
  };
  p.prior = parameter.prior + 2 * std::log(static_cast<double>(choices));
  return p;
}

}  // namespace edmill::identify
