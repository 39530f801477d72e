// The induction over the events of a certificate: docs/certificates.md, "What a checker verifies".
#pragma once

#include <optional>
#include <vector>

#include "impact.hpp"
#include "lines.hpp"
#include "motion.hpp"

namespace checker {

/// Up to the last event that was taken, each ball is proven to be on the flights of the file.
class Induction {
 public:
  /// The balls at the start.
  Induction(const Json& header, Bits bits);

  Index balls() const { return motion_.flights.size(); }

  /// How many events were taken.
  long events() const { return events_; }

  /// Takes the line of the next event.
  /// @throws Violation of a rule; another std::exception for what is no line of a certificate
  void take_event(const Json& line);

  /// Takes the last line.
  /// @throws as take_event
  void take_end(const Json& line) const;
 private:
  Contact read_contact(const Json& line) const;
  void require_no_walls(
      Index ball, const Json& windows, const Real& until, std::optional<Index> last) const;
  void require_no_balls(
      Index ball, std::optional<Index> partner, const Real& until, long event) const;
  std::vector<State> after_impact(const Contact& contact, const Real& bracket);
  void begin_flight(Index ball, const State& state, const Contact& contact, const Real& bracket);

  Motion motion_;
  Stalls stalls_;
  Real end_;  ///< upper end of the last event's bracket
  long events_ = 0;
};

}  // namespace checker
