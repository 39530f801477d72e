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
  double change = 1;  ///< scale of the number, its unit in a fit, SI
  std::function<void(Assumed&, double)> set;
  /// A wrong unit (1e3, pi/180) or a diameter in place of a radius changes it by a factor.
  bool has_unit = false, is_diameter = false;
  /// Speed of a periodic motion: a fit that starts far away may converge to a wrong period.
  bool is_speed = false;
  double cycle = 0;           ///< period of a phase, in the unit of the number; 0 for others
  std::string equation = {};  ///< of docs/theory.md that a term belongs to; empty for a number of the case
  bool of_impacts = true;     ///< false if only rows of flights depend on it
  double prior = 0;           ///< cost in Schwarz's criterion, as for a choice among parts of the log
  /// For a number of another contact law: the law that the case has in its place; `value` is nan.
  std::string in_place_of = {};
  std::vector<double> first_values = {};  ///< starting values of such a number or of a mistake
  std::string mistake =
      {};                  ///< "R_x(gamma) R_z(theta) in place of R_z(theta) R_x(gamma)"; empty for a number
  bool by_factor = false;  ///< mistake that multiplies a number, like a wrong unit
  bool of_motion = false;  ///< mistake that replaces the mill, and with it the numbers of the case's mill

  bool is_of_case() const { return first_values.empty(); }
  /// False for a mistake, which has no value.
  bool is_fitted() const { return mistake.empty(); }
  bool is_periodic() const { return is_speed || cycle > 0; }
  std::string name() const { return mistake.empty() ? key : key + ": " + mistake; }
  /// True if both cannot be combined: they have the same key, or the other does not exist for such a mill.
  bool excludes(const Assumption& other) const {
    return key == other.key || (of_motion && (other.of_motion || other.key.starts_with("mill.")));
  }
  /// Returns `base` with this value, or with this mistake.
  Assumed on(Assumed base, double x) const {
    set(base, x);
    return base;
  }
  /// Trial values to start fits from. They cover several orders of magnitude for a number, and for a term
  /// also its reversal and absence; one cycle for a phase; for a speed they are close enough to miss no turn.
  /// @param end  time of the last event that is used [s]
  std::vector<double> trial_values(double end) const;
};

/// An assumption with its fitted value; 1 for a mistake.
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

/// "reversed", "left out", "doubled" or "halved" if the interval of a factor is narrow and contains such a
/// value; otherwise empty.
std::string word_for(double factor, double half_width);
/// "100.500 +- 0.001 mm", or "100 mm": in the usual unit of its dimension.
std::string value_text(Dimension dimension, double value, double half_width = 0);

}  // namespace edmill::identify
