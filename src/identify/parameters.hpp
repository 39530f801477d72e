// The numbers of a case that can be fitted to a log.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "identify/assumptions.hpp"

namespace edmill::identify {

/// A number that a log may have been made with another value of.
struct Parameter {
  std::string key;      ///< as in the case file, "mill.arm"
  std::string meaning;  ///< "l, from the fulcrum to the vessel's centre"
  Dimension dimension;
  double value;   ///< of the case, SI
  double change;  ///< that is small against what matters, SI: the unit of a fit
  std::function<void(Assumptions&, double)> set;
  /// A wrong unit (1e3, pi/180) or a diameter in place of a radius changes it by a factor.
  bool has_unit = false, is_diameter = false;
  /// A periodic motion's speed or phase: a fit from afar may go to a wrong period.
  bool is_speed = false, is_phase = false;
};

/// All numbers of the mill, the vessel, gravity, the contact laws and the balls.
std::vector<Parameter> parameters_of(const Assumptions& nominal);

/// "100.500 +- 0.001 mm": in the usual unit of its dimension.
std::string value_text(Dimension dimension, double value, double half_width);
/// "100 mm"
std::string value_text(Dimension dimension, double value);

}  // namespace edmill::identify
