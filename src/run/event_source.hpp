// The events of a run in order, in a number type that holds the values of every scalar.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "base/scalar_list.hpp"
#include "casefile/case_spec.hpp"

namespace edmill::run {

/// Holds a number of any scalar exactly.
#if defined(EDMILL_WITHOUT_MPFR)
using Number = mpfr_of<200>;
#else
using Number = mpfr;
#endif

/// The quantities of an impact that are compared, in SI.
enum Quantity : int { time, approach_speed, slip_speed, milling_dose, wall_work, quantity_count };
const char* name_of(Quantity quantity);
const char* unit_of(Quantity quantity);

/// One impact of a run. Of two balls the lower number comes first.
struct Event {
  int ball = 0;
  bool with_wall = false;
  int partner = 0;  ///< ball or wall id
  std::array<Number, quantity_count> values;
  bool by_rule = false;  ///< another contact has the same time, and a rule put this one first

  bool same_bodies(const Event& other) const {
    return ball == other.ball && with_wall == other.with_wall && partner == other.partner;
  }
};

/// A run that delivers its events on request.
class EventSource {
 public:
  virtual ~EventSource() = default;
  /// The next `count` events; fewer at the end of the run.
  /// @throws UndecidedError
  virtual std::vector<Event> next(std::size_t count) = 0;
  /// Positions, velocities and spins of all balls, ball by ball, at the instant up to which it has come.
  virtual std::vector<Number> states() const = 0;
};

/// @param spec     the balls are placed in this scalar, from the exact quantities of the case
/// @param to_end   whether the run ends at the case's end time; otherwise it continues on request
template <class Real>
std::unique_ptr<EventSource> make_source(const casefile::CaseSpec& spec, bool to_end);

}  // namespace edmill::run
