// Assumptions about the code that wrote a log: its case, equations and conventions, for the whole log or for
// a part of it.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "audit/mechanics.hpp"
#include "casefile/build_case.hpp"

namespace edmill::identify {

/// Axes of vectors, permuted and turned: component k is sign[k] times component from[k] of the log.
struct Axes {
  std::array<int, 3> from{0, 1, 2}, sign{1, 1, 1};

  bool operator==(const Axes&) const = default;
  Vec3<double> of(const Vec3<double>& v) const;
  /// 1, or -1 for a mirror image of the axes.
  int handedness() const { return ((from[1] - from[0] + 3) % 3 == 1 ? 1 : -1) * sign[0] * sign[1] * sign[2]; }
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
  void apply(audit::LoggedEvent& event, const model::Mill<double>& mill) const;
};

using audit::Terms;

// Parts of a log to which a cause may be restricted: one wall, one ball, one kind of partner, one branch of
// the law.

/// The event and the body of a row.
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
std::vector<SharedSubset> subsets_of(const casefile::CaseSpec& spec, const model::Case<double>& the_case,
                                     const std::vector<audit::LoggedEvent>& events,
                                     const std::vector<Branches>& branches);

struct Assumed;

/// An assumption that applies to a part of a log only.
struct Restricted {
  SharedSubset part;
  std::function<void(Assumed&)> make;
};

/// Values that may explain a log. The balls are those of the built case; the mill follows from the file's
/// exact quantities, so that every mill, vessel and law is varied by its own parameters.
struct Assumed {
  casefile::CaseSpec spec;
  std::vector<model::BallProperties<double>> balls;
  LogChange log;
  int walls;               ///< number of walls of the case, and so of the log
  std::size_t joints = 0;  ///< number of joints of the case's mill, for `phases`
  Terms terms = {};
  /// Differences of the phases of the mill's joints from the case's [rad], by joint and swing; a rotation's
  /// own angle has the index after its swings.
  std::map<std::array<std::size_t, 2>, double> phases = {};
  std::vector<Restricted> restricted = {};  ///< for parts of the log only

  /// Builds the case with these values. Returns nothing if the log cannot be of such a mill: its file would
  /// be refused, a ball does not fit into the vessel, or the vessel has other walls.
  std::optional<model::Case<double>> built() const;
  /// The case's file with these values.
  casefile::CaseSpec case_file() const;
  /// True if a case file can express the assumptions, apart from the log's conventions: an audit can test it.
  bool is_case() const { return restricted.empty() && terms == Terms{}; }
};

/// @pre the spec can be built
Assumed assumed_of(const casefile::CaseSpec& spec);

/// The number as an exact quantity.
casefile::Quantity exactly(double value);

/// Balls of each entry of the case, [first, last): explicit balls, then batches.
struct BallGroup {
  std::string key;  ///< "ball.0", "balls.1"
  std::size_t first, last;
  const casefile::BallSpec* spec;
};
std::vector<BallGroup> ball_groups(const casefile::CaseSpec& spec);

}  // namespace edmill::identify
