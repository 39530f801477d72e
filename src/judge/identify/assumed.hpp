// Assumptions about the code that wrote a log: ways in which it may differ from its case.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <span>

#include "audit/mechanics.hpp"
#include "casefile/build_case.hpp"

namespace edmill::identify {

using audit::Available, audit::Case, audit::LoggedEvent, audit::LoggedImpact, audit::Mill,
    audit::Terms, audit::Vec, audit::dot, audit::size, audit::unknown;
using casefile::CaseSpec, casefile::Quantity;

/// Axes of vectors, permuted and turned: component k is sign[k] times component from[k] of the log.
struct Axes {
  std::array<int, 3> from{0, 1, 2}, sign{1, 1, 1};

  bool operator==(const Axes&) const = default;
  Vec of(const Vec& v) const;
  /// 1, or -1 for a mirror image of the axes.
  int handedness() const {
    return ((from[1] - from[0] + 3) % 3 == 1 ? 1 : -1) * sign[0] * sign[1] * sign[2];
  }
};

/// Frame of the vectors in a log.
enum class LogFrame {
  laboratory,
  axes_of_vessel,  ///< the laboratory's vectors, in components along the vessel's axes
  vessel           ///< relative to the vessel, and along its axes
};

/// Deviations of a log from its header and conventions. Factors convert to SI.
struct LogChange {
  double time = 1, positions = 1, velocities = 1, spins = 1, energies = 1, speeds = 1;
  double delay = 0;               ///< [s], added to each time: the phase of the drive
  bool states_exchanged = false;  ///< of the two balls of an impact
  bool reversed_in_time = false;  ///< states before and after an impact exchanged
  Axes axes_of_positions, axes_of_velocities, axes_of_spins;
  LogFrame frame = LogFrame::laboratory;
  std::array<int, 2> exchanged = {-1, -1};  ///< numbers of two balls that the log exchanges

  bool operator==(const LogChange&) const = default;
  /// @param mill  gives the vessel frame, if the log uses it
  void apply(LoggedEvent& event, const Mill& mill) const;
};

// Parts of a log to which a cause may be restricted: a wall, a ball, a branch of the law.

struct RowPlace {
  std::size_t event = 0;  ///< index in the log
  int body = -1;          ///< 0 the event's ball, 1 its partner, -1 both
  bool of_flight = false;

  bool operator==(const RowPlace&) const = default;
};

/// Branches of the contact law in an impact, determined from the states before it.
struct Branches {
  bool known = false, sticks = false, at_least_separation = false;
};

struct Subset {
  std::string name;  ///< "at wall 0 (cap -y)", "on ball 3"
  std::function<bool(const RowPlace&)> contains;
  bool of_flights = false;  ///< has rows of flights as well as of impacts
};
using SharedSubset = std::shared_ptr<const Subset>;

/// @param branches  by event; both must outlive the subsets
std::vector<SharedSubset> subsets_of(const CaseSpec& spec, const Case& the_case,
    const std::vector<LoggedEvent>& events, const std::vector<Branches>& branches);

struct Assumed;

struct Restricted {
  SharedSubset part;
  std::function<void(Assumed&)> make;
};

/// Values that may explain a log. The balls are those of the built case; the mill follows from the
/// file's exact quantities, so that every mill, vessel and law is varied by its own parameters.
struct Assumed {
  CaseSpec spec;
  std::vector<model::BallProperties<double>> balls;
  LogChange log;
  int walls;               ///< number of walls of the case, and so of the log
  std::size_t joints = 0;  ///< number of joints of the case's mill, for `phases`
  Terms terms = {};
  /// Phases of the joints minus the case's [rad], by joint and swing; last a rotation's own angle.
  std::map<std::array<std::size_t, 2>, double> phases = {};
  std::vector<Restricted> restricted = {};  ///< for parts of the log only

  /// The case with these values; nothing if its file is refused, a ball does not fit or walls
  /// differ.
  std::optional<Case> built() const;
  CaseSpec case_file() const;
  /// True if a case file can express all but the log's conventions: an audit can test it.
  bool is_case() const { return restricted.empty() && terms == Terms{}; }
};

/// @pre the spec can be built
Assumed assumed_of(const CaseSpec& spec);

Quantity exactly(double value);

/// Balls of each entry of the case, [first, last): explicit balls, then batches.
struct BallGroup {
  std::string key;  ///< "ball.0", "balls.1"
  std::size_t first, last;
  const casefile::BallSpec* spec;
};
std::vector<BallGroup> ball_groups(const CaseSpec& spec);

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
  std::string equation = {};  ///< in docs/theory.md, of a term; empty for a number of the case
  bool of_impacts = true;     ///< false if only rows of flights depend on it
  double prior = 0;  ///< cost in Schwarz's criterion, as for a choice among parts of the log
  /// For a number of another contact law: the law that the case has in its place; `value` is nan.
  std::string in_place_of = {};
  std::vector<double> first_values = {};  ///< starting values of such a number or of a mistake
  std::string mistake = {};  ///< "R_x(gamma) R_z(theta) in place of ..."; empty for a number
  bool by_factor = false;    ///< mistake that multiplies a number, like a wrong unit
  bool of_motion = false;    ///< mistake that replaces the mill, and with it its numbers

  bool is_of_case() const { return first_values.empty(); }
  /// False for a mistake, which has no value.
  bool is_fitted() const { return mistake.empty(); }
  bool is_periodic() const { return is_speed || cycle > 0; }
  std::string name() const { return mistake.empty() ? key : key + ": " + mistake; }
  /// True if both cannot be combined: they have one key, or such a mill does not have the other.
  bool excludes(const Assumption& other) const {
    return key == other.key || (of_motion && (other.of_motion || other.key.starts_with("mill.")));
  }
  Assumed on(Assumed base, double x) const {
    set(base, x);
    return base;
  }
  /// Trial values to start fits from. They cover orders of magnitude of a number, the reversal and
  /// absence of a term, one cycle of a phase; those of a speed miss no turn.
  /// @param end  time of the last event that is used [s]
  std::vector<double> trial_values(double end) const;
};

using Assumptions = std::vector<Assumption>;

/// An assumption with its fitted value; 1 for a mistake.
struct Found {
  Assumption what;
  double value = 1, half_width = 0;  ///< SI; contains 99.7 % of normal noise, and a common shift
};

/// The fitted numbers of a hypothesis or a cause, in which mistakes come first.
auto fitted(auto& of) {
  std::size_t mistakes = 0;
  while (mistakes < of.found.size() && !of.found[mistakes].what.is_fitted()) ++mistakes;
  return std::span<std::remove_reference_t<decltype(of.found[0])>>(
      of.found.data() + mistakes, of.found.size() - mistakes);
}

/// All numbers of the mill, the vessel, gravity, the contact laws and the balls.
Assumptions numbers_of(const Assumed& nominal);

/// An assumption about a part of the log only. @param choices  number of parts that were tried
Assumption restricted_to(const SharedSubset& part, const Assumption& what, std::size_t choices);

/// Mistakes other than wrong numbers that a log with these columns can reveal.
Assumptions mistakes_of(const Assumed& nominal, const Assumptions& numbers, const Available& has);

/// "reversed", "left out", "doubled", "halved" if the narrow interval contains it; else "".
std::string word_for(double factor, double half_width);
/// "100.500 +- 0.001 mm", or "100 mm": in the usual unit of its dimension.
std::string value_text(Dimension dimension, double value, double half_width = 0);

}  // namespace edmill::identify
