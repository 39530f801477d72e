// The numbers of a case that can be fitted to a log, and mistakes that it may be made with.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "identify/assumptions.hpp"

namespace edmill::identify {

/// What a log may have been made with otherwise than the case says: a number with another value, or a
/// mistake.
struct Parameter {
  std::string key;  ///< as in the case file, "mill.arm"; of a mistake "mill, order of rotations"
  Dimension dimension = Dimension::none;
  double value = 0;   ///< of the case, SI
  double change = 1;  ///< that is small against what matters, SI: the unit of a fit
  std::function<void(Assumptions&, double)> set;
  /// A wrong unit (1e3, pi/180) or a diameter in place of a radius changes it by a factor.
  bool has_unit = false, is_diameter = false;
  /// A periodic motion's speed: a fit from afar may go to a wrong period.
  bool is_speed = false;
  double cycle = 0;           ///< of a phase, after which the motion is the same [its unit]; else 0
  std::string equation = {};  ///< of docs/theory.md that a term belongs to; empty for a number of the case
  bool of_impacts = true;     ///< or rows of flights alone depend on it
  double prior = 0;           ///< what the choice among parts of the log costs in Schwarz's criterion
  /// Of a number of another contact law: what the case has in its place. `value` is not a number.
  std::string in_place_of = {};
  std::vector<double> first_values = {};  ///< of such a number, and of a mistake: to begin with
  std::string mistake =
      {};                  ///< "R_x(gamma) R_z(theta) in place of R_z(theta) R_x(gamma)"; empty for a number
  bool by_factor = false;  ///< a mistake of a number, as a wrong unit makes it
  bool of_motion = false;  ///< a mistake that makes another mill, which has not the numbers of the case's

  bool is_of_case() const { return first_values.empty(); }
  bool is_periodic() const { return is_speed || cycle > 0; }
  std::string name() const { return mistake.empty() ? key : key + ": " + mistake; }
  /// Whether the other one says the same, or cannot be said of such a mill.
  bool excludes(const Parameter& other) const {
    return key == other.key || (of_motion && (other.of_motion || other.key.starts_with("mill.")));
  }
  /// The assumptions with this value, or this mistake.
  Assumptions on(Assumptions base, double x) const {
    set(base, x);
    return base;
  }
  /// Values over decades at which a number that is far off, or a term that is reversed or left out, shows;
  /// over the cycle of a phase; of a speed, so close together that none of its turns is missed.
  /// @param end  of the events that show them [s]
  std::vector<double> trial_values(double end) const;
};

/// All numbers of the mill, the vessel, gravity, the contact laws and the balls.
std::vector<Parameter> parameters_of(const Assumptions& nominal);

/// The same in a part of the log alone. @param choices  number of parts that were tried
Parameter restricted_to(const SharedSubset& part, const Parameter& parameter, std::size_t choices);

/// Mistakes other than wrong numbers that can be told apart in a log with these columns: orders, signs,
/// directions, units, and what columns stand for.
std::vector<Parameter> mistakes_of(const Assumptions& nominal, const std::vector<Parameter>& parameters,
                                   const audit::Available& has);

/// "reversed", "left out", "doubled", "halved", where an interval holds such a factor and little else; else
/// empty.
std::string word_for(double factor, double half_width);
/// "100.500 +- 0.001 mm", or "100 mm": in the usual unit of its dimension.
std::string value_text(Dimension dimension, double value, double half_width = 0);

}  // namespace edmill::identify
