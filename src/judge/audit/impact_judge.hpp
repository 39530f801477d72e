// Checks a single impact: the contact law, conservation, and the values logged with it.
#pragma once

#include <algorithm>
#include <vector>

#include "audit/finding.hpp"
#include "audit/mechanics.hpp"
#include "audit/tolerances.hpp"
#include "base/sums.hpp"

namespace edmill::audit {

/// What all judges of a log share.
class Judge {
 public:
  Judge(const model::Case<double>& the_case, const Available& available, const Tolerances& tolerances,
        Findings& findings)
      : case_(the_case), available_(available), tolerances_(tolerances), findings_(findings) {}

 protected:
  void report(Kind kind, const LoggedEvent& event, double size, double found, double expected,
              const char* note = "") {
    findings_.add({event, kind, size, found, expected, note});
  }
  /// A check whose quantity is `off` from what is expected.
  void judge(Check check, Kind kind, const LoggedEvent& event, double off, double allowed, double found,
             double expected) {
    findings_.judged(check);
    if (off > allowed) report(kind, event, off, found, expected);
  }
  double radius_of(int ball) const { return case_.balls[ball].radius; }

  const model::Case<double>& case_;
  const Available& available_;
  Tolerances tolerances_;
  Findings& findings_;
};

/// What friction does in an impact, docs/theory.md, section 6; either, where the log leaves open how long
/// the flights before were.
enum class Friction { acts, rests, either };

/// Counts each ball's impacts in a row that came without time to move, between a least and a most number.
class StallHistory {
 public:
  explicit StallHistory(const model::Mill<double>& mill, std::size_t balls)
      : mill_(mill), balls_(balls, Ball{unknown, 0, mill.stall.impacts}) {}

  /// All flights begin at `time`: the log has what follows from then on.
  void begin(double time) { std::fill(balls_.begin(), balls_.end(), Ball{time, 0, 0}); }
  /// Events of the ball are missing.
  void forget(int ball) { balls_[ball] = {unknown, 0, mill_.stall.impacts}; }

  /// The next event. @param relative  tolerance of logged times
  Friction take(const LoggedEvent& event, const model::ContactLaw<double>& law, double relative) {
    const Friction one = count(event.ball, event.time, law, relative);
    if (event.with_wall) return one;
    const Friction other = count(event.partner, event.time, law, relative);
    if (one == Friction::rests || other == Friction::rests) return Friction::rests;
    return one == other ? one : Friction::either;
  }

 private:
  struct Ball {
    double time;      ///< of its last impact; unknown at first [s]
    int least, most;  ///< impacts in a row without time to move
  };

  Friction count(int k, double time, const model::ContactLaw<double>& law, double relative) {
    Ball& ball = balls_[k];
    const int enough = mill_.stall.impacts;
    const double flight = time - ball.time, off = 2 * rounding_of(time) + relative * std::abs(flight);
    const bool may_have_moved =
        std::isnan(flight) || mill_.stall.has_moved(flight + off, law.least_separation);
    const bool has_moved = !std::isnan(flight) && mill_.stall.has_moved(flight - off, law.least_separation);
    const Friction friction = has_moved || ball.most < enough           ? Friction::acts
                              : !may_have_moved && ball.least >= enough ? Friction::rests
                                                                        : Friction::either;
    ball.time = time;
    ball.most = has_moved ? 0 : std::min(ball.most + 1, enough);
    ball.least = may_have_moved ? 0 : std::min(ball.least + 1, enough);
    return friction;
  }

  const model::Mill<double>& mill_;
  std::vector<Ball> balls_;
};

/// Totals over the impacts of a log that have velocities and spins before and after.
struct Energies {
  using Sum = numerics::CompensatedSum<double>;
  std::uint64_t impacts = 0;
  Sum wall_work;                ///< of the logged states [J]
  Sum milling_dose;             ///< as logged, otherwise from the law [J]
  Sum supplied;                 ///< that the case's least separation speed adds [J]
  Sum kinetic_change;           ///< of the logged states [J]
  std::uint64_t supplying = 0;  ///< impacts in which it adds energy
  std::uint64_t creating = 0;   ///< impacts that create more energy than that
  double created = 0;           ///< by them [J]

  /// 0 up to rounding in a log that obeys the law [J].
  double closure() const {
    return (wall_work.value() - milling_dose.value()) + (supplied.value() - kinetic_change.value());
  }
};

class ImpactJudge : Judge {
 public:
  explicit ImpactJudge(const Judge& shared) : Judge(shared) {}

  /// Judges an impact by the states of its bodies, or without them by the logged speeds.
  void judge_impact(LoggedImpact impact, Friction friction);

  const Energies& energies() const { return energies_; }

 private:
  /// LawResiduals of the impact in each equation [m/s].
  struct LawResiduals {
    double normal = 0, tangential = 0, momentum = 0, spin = 0;
    double restitution_tangential = 1;  ///< that applies
    double largest() const { return std::max({normal, tangential, momentum, spin}); }
  };
  struct Known {
    bool velocities, spins;  ///< before and after, of all bodies
  };

  LawResiduals residuals(const LoggedImpact& impact, const Known& known, bool parting) const;
  bool fits_without_friction(const LoggedImpact& impact, const Known& known) const;
  void judge_outcome(const LoggedImpact& impact, const Known& known, double allowed);
  void judge_logged_speeds(const LoggedImpact& impact, const Known& known, double allowed);
  void judge_energies(const LoggedImpact& impact, double allowed);
  void judge_dose(const LoggedImpact& impact, double allowed);
  void judge_speeds(const LoggedImpact& impact);
  void leave_unresolved(const Known& known);
  double by_wall(const LoggedImpact& impact, double scale) const {
    return impact.with_wall()
               ? tolerances_.of_wall(impact.event->time, scale, impact.bend, impact.ball[0].radius)
               : 0;
  }
  /// Of an impact whose dose follows from its speeds [J].
  double allowed_dose(const LoggedImpact& impact, double speed) const {
    return 4 * tolerances_.relative * impact.effective_mass * speed * speed;
  }

  Energies energies_;
};

}  // namespace edmill::audit
