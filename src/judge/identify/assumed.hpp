// The case, the equations and the log's conventions as another code may have had them, in the whole log or in
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
  /// -1 of axes in a mirror.
  int handedness() const { return ((from[1] - from[0] + 3) % 3 == 1 ? 1 : -1) * sign[0] * sign[1] * sign[2]; }
};

/// In which frame a log has its vectors.
enum class LogFrame {
  laboratory,
  axes_of_vessel,  ///< the laboratory's vectors, in components along the vessel's axes
  vessel           ///< as seen from the vessel
};

/// How a log differs from what its header and the conventions say. Factors lead to SI.
struct LogChange {
  double time = 1, positions = 1, velocities = 1, spins = 1, energies = 1, speeds = 1;
  double delay = 0;               ///< [s], added to each time: the phase of the drive
  bool states_exchanged = false;  ///< of the two balls of an impact
  bool reversed_in_time = false;  ///< states before and after an impact exchanged
  Axes axes_of_positions, axes_of_velocities, axes_of_spins;
  LogFrame frame = LogFrame::laboratory;
  std::array<int, 2> exchanged = {-1, -1};  ///< numbers of two balls that are taken for each other

  bool operator==(const LogChange&) const = default;
  /// @param mill  of the vessel whose frame it may be
  void apply(audit::LoggedEvent& event, const model::Mill<double>& mill) const;
};

using audit::Terms;

// Parts of a log to which a cause may be restricted: one wall, one ball, one kind of partner, one branch of
// the law.

/// The event and the body of a row.
struct RowPlace {
  std::size_t event = 0;  ///< place in the log
  int body = -1;          ///< 0 the event's ball, 1 its partner, -1 both
  bool of_flight = false;

  bool operator==(const RowPlace&) const = default;
};

/// The branches of the contact law that an impact took, by its states before.
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
  int walls;               ///< of the case, which the log's walls are
  std::size_t joints = 0;  ///< of the case's mill, which `phases` are of
  Terms terms = {};
  /// Differences of the phases of the mill's joints from the case's [rad], by joint and swing; a rotation's
  /// own angle has the place after its swings.
  std::map<std::array<std::size_t, 2>, double> phases = {};
  std::vector<Restricted> restricted = {};  ///< for parts of the log only

  /// The case of these values; none where its file would be refused, a ball has no room in the vessel, or the
  /// vessel has other walls: a log cannot be of such a mill.
  std::optional<model::Case<double>> built() const;
  /// The case's file with these values.
  casefile::CaseSpec case_file() const;
  /// Whether a case file alone can express it, so that an audit can be made with it.
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
