// The numbers of a case that can be fitted to a log, and mistakes that it may be made with.
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
  /// A periodic motion's speed: a fit from afar may go to a wrong period.
  bool is_speed = false;
  double cycle = 0;           ///< of a phase, after which the motion is the same [its unit]; else 0
  std::string equation = {};  ///< of docs/theory.md that a term belongs to; empty for a number of the case
  bool of_impacts = true,
       of_flights = true;  ///< the rows that depend on it, which a part of the log may restrict
  double prior = 0;        ///< what the choice among parts of the log costs in Schwarz's criterion
  /// Of a number of another contact law: what the case has in its place, and values to begin with. `value` is
  /// not a number.
  std::string in_place_of = {};
  std::vector<double> first_values = {};

  bool is_of_case() const { return in_place_of.empty(); }
  /// Values over decades at which a number that is far off, or a term that is reversed or left out, shows.
  std::vector<double> values_from_afar() const;
};

/// A mistake that is made or not.
struct Mistake {
  std::string key;   ///< "mill, order of rotations"
  std::string text;  ///< "R_x(gamma) R_z(theta) in place of R_z(theta) R_x(gamma)"
  std::function<void(Assumptions&)> make;
  bool by_factor = false;  ///< of a number, as a wrong unit makes it
  bool of_motion = false;  ///< it makes another mill, which has not the numbers of the case's

  /// The assumptions with it.
  Assumptions on(Assumptions base) const {
    make(base);
    return base;
  }
};

/// All numbers of the mill, the vessel, gravity, the contact laws and the balls.
std::vector<Parameter> parameters_of(const Assumptions& nominal);

/// Those of the contact laws, and one number of each other law that may stand in their place.
void add_laws(const Assumptions& nominal, std::vector<Parameter>& list);
/// "vessel.x" of the first of three numbers along axes; the key itself for axis -1.
inline std::string with_axis(const std::string& key, int axis) {
  return axis < 0 ? key : key + "." + std::string(1, "xyz"[axis]);
}
/// With the unit of a fit that its size suggests.
Parameter number(std::string key, std::string meaning, Dimension dimension, double value,
                 std::function<void(Assumptions&, double)> set);

/// The factors and shifts of the terms of the equations.
std::vector<Parameter> term_parameters();
/// The same in a part of the log alone. @param choices  number of parts that were tried
Parameter restricted_to(const SharedSubset& part, const Parameter& parameter, std::size_t choices);

/// Mistakes other than wrong numbers that can be told apart in a log with these columns: orders, signs,
/// directions, units, and what columns stand for.
std::vector<Mistake> mistakes_of(const Assumptions& nominal, const std::vector<Parameter>& parameters,
                                 const audit::Available& has);

/// "reversed", "left out", "doubled", "halved", where an interval holds such a factor and little else; else
/// empty.
std::string word_for(double factor, double half_width);
/// "100.500 +- 0.001 mm": in the usual unit of its dimension.
std::string value_text(Dimension dimension, double value, double half_width);
/// "100 mm"
std::string value_text(Dimension dimension, double value);

}  // namespace edmill::identify
