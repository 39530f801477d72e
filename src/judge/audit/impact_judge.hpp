// Checks a single impact: the contact law, conservation, and the values logged with it.
#pragma once

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

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
  void tell(Kind kind, const LoggedEvent& event, double size, double found, double expected,
            const char* note = "") {
    findings_.add({event, kind, size, found, expected, note});
  }
  double radius_of(int ball) const { return case_.balls[ball].radius; }

  const model::Case<double>& case_;
  const Available& available_;
  Tolerances tolerances_;
  Findings& findings_;
};

/// What friction does in an impact, docs/theory.md, section 6; either, where the log does not tell how long
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
    const double flight = time - ball.time, off = 2 * Tolerances::time(time) + relative * std::abs(flight);
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

/// An impact and where it takes place.
struct Scene {
  LoggedImpact impact;  ///< with the right velocity of the wall
  VesselFrame nested, printed;
  bool displaced = false;  ///< checked in the printed frame, where that code has its walls
  Friction friction = Friction::acts;
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
  explicit ImpactJudge(const Judge& shared);

  /// Judges an impact by the states of the bodies.
  void judge(Scene scene);
  /// At the end of the log.
  void finish();

  const Energies& energies() const { return energies_; }

 private:
  /// Residuals of the impact in each equation [m/s].
  struct Residuals {
    double normal = 0, tangential = 0, momentum = 0, spin = 0;
    double restitution_tangential = 1;  ///< that applies
    double largest() const { return std::max({normal, tangential, momentum, spin}); }
  };
  /// A mistake that reproduces a violating impact.
  struct Explanation {
    Kind kind;
    const char* note;
    Suspicion* mistake;
    LoggedImpact impact;  ///< as that code saw it
    double off, left;     ///< without the mistake and with it [m/s]
  };
  struct Known {
    bool velocities, spins;  ///< before and after, of all bodies
  };
  /// What an impact may be off by.
  struct Allowed {
    double speed;   ///< [m/s]
    double slack;   ///< the same with what friction makes of it [m/s]
    double energy;  ///< [J]
  };

  Residuals residuals(const LoggedImpact& impact, const Known& known, bool parting) const;
  /// The known mistake that reproduces the logged outcome, if one does. What does not is noted, also of an
  /// impact that is not violated.
  std::optional<Explanation> explaining(const Scene& scene, double allowed, bool violated);
  bool fits_without_friction(const LoggedImpact& impact, const Known& known) const;
  bool tell_broken_equations(const LoggedImpact& impact, const Residuals& off, double allowed,
                             Findings& plain);
  void tell_normal(const LoggedImpact& impact, double off, double allowed, Findings& plain);
  void see_separation(const LoggedImpact& impact, double allowed);
  std::optional<double> other_wall_speed(const LoggedImpact& impact, const Residuals& off,
                                         double allowed) const;
  bool judge_outcome(const Scene& scene, const Known& known, const Allowed& allowed, LoggedImpact& theirs);
  void judge_speeds(const LoggedImpact& impact);
  void judge_logged_speeds(const LoggedImpact& impact, const Known& known, double allowed,
                           bool wall_velocity_told);
  void judge_energies(const LoggedImpact& right, const LoggedImpact& theirs, double allowed);
  void judge_dose(const LoggedImpact& right, const LoggedImpact& theirs, double allowed);
  void tell_dose(const LoggedEvent& event, double off, double expected, double allowed, double left,
                 double changes, Suspicion& mistake, const char* note);
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
  std::vector<Suspicion> suspicions_;  ///< by known mistake
  std::uint64_t explained_impacts_ = 0;
  /// Other laws of the speed at which bodies separate.
  struct SeparationSuspicions {
    explicit SeparationSuspicions(std::size_t examples) : least(examples), always(examples) {}
    Suspicion least;   ///< another least speed than the case's: the one of the first impact that has one
    Suspicion always;  ///< the case's least speed after every impact
    double speed = std::numeric_limits<double>::infinity(), g_n = 0;
  };
  /// Number of the law of an impact: of balls, with walls, pairs of materials.
  std::ptrdiff_t number_of_law(const LoggedImpact& impact) const {
    const auto& mill = case_.mill;
    if (impact.law == &mill.ball_ball) return 0;
    return impact.law == &mill.ball_wall ? 1 : 2 + (impact.law - mill.pairs.laws.data());
  }
  std::map<std::ptrdiff_t, SeparationSuspicions> separations_;  ///< by number of the law
  Suspicion net_dose_, dose_without_rule_;
};

}  // namespace edmill::audit
