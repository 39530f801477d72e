// Takes the events of a log one by one, with the state that precedes each.
#pragma once

#include "audit/audit.hpp"
#include "audit/delays.hpp"
#include "audit/flights.hpp"

namespace edmill::audit {

class Auditor : Judge {
 public:
  explicit Auditor(const Judge& shared)
      : Judge(shared),
        impacts_(shared),
        flights_(shared),
        stalls_(case_.mill, case_.balls.size()),
        last_(case_.balls.size()),
        with_wall_(case_.mill.vessel.walls().size()),
        rotations_(findings_.examples()) {}

  /// The log begins with these states.
  void begin(const std::vector<model::BallState<double>>& states, double time);
  void take(LoggedEvent& event);
  /// At the end of the log.
  void finish() {
    flights_.finish();
    impacts_.finish();
    findings_.take(rotations_.findings());
  }

  const Energies& energies() const { return impacts_.energies(); }
  const Flights& flights() const { return flights_; }
  /// Logged impacts with each wall, for the diagnosis.
  const std::vector<std::uint64_t>& with_wall() const { return with_wall_; }
  /// How late each event is that is not a graze.
  const DelaysByPartner& delays() const { return delays_; }

 private:
  /// The last event of a ball, to recognise a duplicate.
  struct LastEvent {
    double time = unknown;
    int other = -1;
    double approach_speed = unknown;
    Vec velocity_before{0, 0, 0}, velocity_after{0, 0, 0};
  };
  struct Touch {
    bool late = false, displaced = false, usable = true;
  };

  bool is_repeated(const LoggedEvent& event) const;
  void find_wrong_balls(LoggedEvent& event);
  Touch judge_touch(LoggedEvent& event, Scene& scene);
  Touch judge_wall_touch(LoggedEvent& event, Scene& scene);
  Touch judge_off_the_wall(LoggedEvent& event, Scene& scene, double gap, double allowed);
  bool another_body_is_there(LoggedEvent& event, double allowed, double gap);
  void note_delay(const LoggedEvent& event, const Scene& scene, double depth);

  ImpactJudge impacts_;
  Flights flights_;
  StallHistory stalls_;
  std::vector<LastEvent> last_;
  std::vector<std::uint64_t> with_wall_;
  DelaysByPartner delays_;
  Suspicion rotations_;  ///< the walls are those of the printed matrix
};

}  // namespace edmill::audit
