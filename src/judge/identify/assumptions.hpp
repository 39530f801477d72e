// The table of assumptions: ways in which a log may differ from its case.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "identify/assumed.hpp"

namespace edmill::identify {

/// A row of the table: a number with another value, which is fitted, or a mistake.
struct Assumption {
  std::string key;  ///< as in the case file, "mill.arm"; of a mistake "mill, order of rotations"
  Dimension dimension = Dimension::none;
  double value = 0;   ///< of the case, SI
  double change = 1;  ///< that is small against what matters, SI: the unit of a fit
  std::function<void(Assumed&, double)> set;
  /// A wrong unit (1e3, pi/180) or a diameter in place of a radius changes it by a factor.
  bool has_unit = false, is_diameter = false;
  /// A periodic motion's speed: a fit from afar may go to a wrong period.
  bool is_speed = false;
  double cycle = 0;           ///< of a phase, after which the motion is the same [its unit]; else 0
  std::string equation = {};  ///< of docs/theory.md that a term belongs to; empty for a number of the case
  bool of_impacts = true;     ///< or rows of flights alone depend on it
  double prior = 0;           ///< what the choice among parts of the log costs in Schwarz's criterion
  /// For a number of another contact law: the law that the case has in its place; `value` is nan.
  std::string in_place_of = {};
  std::vector<double> first_values = {};  ///< of such a number, and of a mistake: to begin with
  std::string mistake =
      {};                  ///< "R_x(gamma) R_z(theta) in place of R_z(theta) R_x(gamma)"; empty for a number
  bool by_factor = false;  ///< a mistake of a number, as a wrong unit makes it
  bool of_motion = false;  ///< a mistake that makes another mill, which has not the numbers of the case's

  bool is_of_case() const { return first_values.empty(); }
  /// Or it is a mistake, which has no value.
  bool is_fitted() const { return mistake.empty(); }
  bool is_periodic() const { return is_speed || cycle > 0; }
  std::string name() const { return mistake.empty() ? key : key + ": " + mistake; }
  /// Whether the other one concerns the same key, or does not exist for such a mill.
  bool excludes(const Assumption& other) const {
    return key == other.key || (of_motion && (other.of_motion || other.key.starts_with("mill.")));
  }
  /// The assumptions with this value, or this mistake.
  Assumed on(Assumed base, double x) const {
    set(base, x);
    return base;
  }
  /// Values over decades, at which a number far from the case's, or a reversed or missing term, has an
  /// effect; over the cycle of a phase; of a speed, so close together that none of its turns is missed.
  /// @param end  of the events that show them [s]
  std::vector<double> trial_values(double end) const;
};

/// An assumption with the value that a log has for it; of a mistake 1.
struct Found {
  Assumption what;
  double value = 1, half_width = 0;  ///< SI; the interval contains 99.7 % of normal noise, and a common shift
};

/// The fitted numbers of a hypothesis or a cause, in which mistakes come first.
auto fitted(auto& of) {
  std::size_t mistakes = 0;
  while (mistakes < of.found.size() && !of.found[mistakes].what.is_fitted()) ++mistakes;
  return std::span<std::remove_reference_t<decltype(of.found[0])>>(of.found.data() + mistakes,
                                                                   of.found.size() - mistakes);
}

/// All numbers of the mill, the vessel, gravity, the contact laws and the balls.
std::vector<Assumption> numbers_of(const Assumed& nominal);

/// An assumption that applies to a part of the log only. @param choices  number of parts that were tried
Assumption restricted_to(const SharedSubset& part, const Assumption& parameter, std::size_t choices);

/// Mistakes other than wrong numbers that a log with these columns can reveal: orders, signs,
/// directions, units, and the meaning of columns.
std::vector<Assumption> mistakes_of(const Assumed& nominal, const std::vector<Assumption>& parameters,
                                    const audit::Available& has);

/// "reversed", "left out", "doubled", "halved", if an interval contains such a factor and little else;
/// otherwise empty.
std::string word_for(double factor, double half_width);
/// "100.500 +- 0.001 mm", or "100 mm": in the usual unit of its dimension.
std::string value_text(Dimension dimension, double value, double half_width = 0);

}  // namespace edmill::identify
