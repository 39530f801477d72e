// The 24 cases of the thesis's chapter 5 (Ward et al. 2005), recognised by their parameters.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "casefile/case_spec.hpp"

namespace edmill::report {

/// A row of regression/ward/thesis.csv.
struct WardCase {
  std::string powder, charge_ratio, diameter;  ///< [g], [1], [mm], as printed
  int balls = 0;
  std::string restitution;
  double inverse_dose_rate = 0;          ///< table 5.5 [s/J]
  std::optional<double> collision_rate;  ///< table 5.6 [1/s]
};

std::vector<WardCase> ward_cases();

/// The case of the thesis with exactly the same mill, vessel, gravity, contact law, balls and powder. The
/// least separation speed, which the thesis does not have, the seed, times and the placement of the balls are
/// free.
std::optional<WardCase> ward_case_of(const casefile::CaseSpec& spec);

}  // namespace edmill::report
