// What happens between the impacts of a log: whether flights are ballistic, and whether an impact was missed.
#pragma once

#include <optional>
#include <vector>

#include "audit/finding.hpp"
#include "audit/impact_judge.hpp"
#include "dynamics/decision_ladder.hpp"

namespace edmill::audit {

/// A ball since its last impact.
struct Flying {
  dynamics::Flight<double> flight{Vec::Zero(), Vec::Zero(), {}};
  Vec spin{0, 0, 0};
  double start = 0;  ///< of the flight [s]
};

/// The last logged state of a ball.
struct Track : Flying {
  bool state_known = false, spin_known = false;
  double broken_from = 0;  ///< an impact of the flight at this time is not in the log [s]
  bool broken = false;
  struct Pending {  ///< a missed impact with a ball whose flight is now over
    Finding finding;
    double depth;
  };
  std::vector<Pending> pending;
  /// A missed impact with a wall, until the next line is seen not to log it at the same time.
  std::optional<Finding> held;
};

/// The end of a flight as logged by an event.
struct FlightEnd {
  const LoggedEvent* event;
  std::size_t body;        ///< 0 the event's ball, 1 its partner
  bool late = false;       ///< the event is late: its bodies have met before, which is reported
  bool displaced = false;  ///< the walls of the log are displaced, which is reported

  const BodyState& state() const { return event->body[body]; }
  int partner() const { return body == 0 ? event->partner : event->ball; }  ///< ball or wall
};

class Flights : Judge {
 public:
  explicit Flights(const Judge& shared);

  Track& of(int ball) { return tracks_[ball]; }
  const Track& of(int ball) const { return tracks_[ball]; }
  int balls() const { return static_cast<int>(tracks_.size()); }

  /// Position of a ball, extrapolated from its last known state [m]. @pre its state is known
  Vec position_at(int ball, double time) const { return position_of(of(ball), time); }
  VesselFrame nested_at(double time) const { return vessel_at(case_.mill, time, false); }
  VesselFrame printed_at(double time) const { return vessel_at(case_.mill, time, true); }

  /// Checks the flight of a ball that an event ends.
  void judge(int ball, const FlightEnd& end);

  /// At the end of the log.
  void finish();

  /// Begins a new flight.
  void begin(int ball, double time, const BodyState& state, const Available::Body& has);
  void begin_at_start(int ball, const model::BallState<double>& state, double time);

  /// Flights through each wall, for the diagnosis.
  const std::vector<std::uint64_t>& flown_through() const { return flown_through_; }
  /// The walls of the log are those of the printed matrix.
  void set_printed_walls(bool printed) { printed_walls_ = printed; }
  std::uint64_t undecided() const { return undecided_; }

 private:
  struct Contact {
    double time = 0;
    bool with_wall = false;
    int partner = -1;
    double depth = 0;  ///< largest overlap of the bodies later in the flight [m]
  };
  std::optional<Contact> first_wall(int ball, const Track& track, double until, double slack);
  std::optional<Contact> wall_contact(const Flying& own, double radius, double until);
  std::optional<Contact> first_ball(int ball, const Track& track, const FlightEnd& end, double slack);
  bool explained_by_walls(int ball, const Track& track, const FlightEnd& end);
  bool explained_by_ball(int ball, const Contact& contact, const FlightEnd& end) const;
  BodyState before_impact(const Flying& own, double time) const;
  Flying after_impact(const LoggedEvent& event) const;
  bool arrives(const Flying& own, const FlightEnd& end) const;
  void judge_state(int ball, const Track& track, const FlightEnd& end, double& off, bool tell_it);
  void tell_flight(const Track& track, const BodyState& state, const Finding& finding, bool good);
  double look(std::size_t k, const Track& track, const BodyState& state, double dt, double& shows);
  Finding missed_finding(int ball, const Contact& contact, const FlightEnd& end, const char* note,
                         bool explained) const;
  bool report_missed_wall(int ball, Track& track, const Contact& missed, const FlightEnd& end, double off,
                          double& missed_at);
  bool report_missed_ball(int ball, const Contact& pair, const FlightEnd& end, double off, double& missed_at);
  void settle_pending(Track& track, const FlightEnd& end, double off, double missed_at);
  void settle_held(Track& track, const LoggedEvent* next);
  int walls() const { return static_cast<int>(flown_through_.size()); }
  bool stays_in_printed_vessel(int ball, const Track& track, double until, double slack) const;
  double deepest(int ball, const Track& track, int wall, double from, double until) const;

  Vec position_of(const Flying& own, double time) const {
    return dynamics::position_after(own.flight, case_.mill.gravity, time - own.start);
  }
  Vec velocity_of(const Flying& own, double time) const {
    return dynamics::velocity_after(own.flight, case_.mill.gravity, time - own.start);
  }

  DriveClock<double> clock_;
  dynamics::DecisionLadder<double> ladder_;
  double top_speed_;
  std::vector<Track> tracks_;
  std::vector<std::uint64_t> flown_through_;
  std::vector<Suspicion> looks_;  ///< by known mistake of flights
  double step_ = 0;               ///< of an integrator of first order, from the first flight that has one [s]
  bool printed_walls_ = false;
  std::uint64_t undecided_ = 0;
};

}  // namespace edmill::audit
