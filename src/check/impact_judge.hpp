// Checks a single impact: the contact law, conservation, and the values logged with it.
#pragma once

#include <limits>
#include <map>
#include <optional>

#include "base/compensated_sum.hpp"
#include "check/finding.hpp"
#include "check/mechanics.hpp"
#include "check/tolerances.hpp"

namespace edmill::audit {

/// An impact and where it takes place.
struct Scene {
  LoggedImpact impact;  ///< with the right velocity of the wall
  VesselFrame nested, printed;
  bool displaced = false;  ///< checked in the printed frame, where that code has its walls
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

class ImpactJudge {
 public:
  ImpactJudge(const model::Mill<double>& mill, const Available& available, const Tolerances& tolerances,
              Findings& findings)
      : mill_(mill), available_(available), tolerances_(tolerances), findings_(findings) {}

  /// With the states of the bodies.
  void judge(const LoggedEvent& event, Scene scene);
  /// Of a log, or for an impact, without them: the dose from the logged speeds.
  void judge_speeds(const LoggedEvent& event, const LoggedImpact& impact);
  /// At the end of the log.
  void finish();

  const Energies& energies() const { return energies_; }

 private:
  /// Residuals of the impact in each equation [m/s].
  struct Residuals {
    double normal = 0, tangential = 0, momentum = 0, spin = 0;
    double restitution_tangential = 1;  ///< that applies
    double largest() const;
  };
  /// The explanation of a violating impact.
  struct Explanation {
    Kind kind;
    const char* note;
    LoggedImpact impact;
  };
  struct Known {
    bool velocities, spins;  ///< before and after, of all bodies
  };

  const model::ContactLaw<double>& law(const LoggedImpact& impact) const {
    return impact.with_wall ? mill_.law_with_wall(impact.ball[0], impact.wall)
                            : mill_.law_between(impact.ball[0], impact.ball[1]);
  }
  /// Number of a law of the mill: of balls, with walls, pairs of materials.
  std::ptrdiff_t number_of(const model::ContactLaw<double>& law) const {
    if (&law == &mill_.ball_ball) return 0;
    return &law == &mill_.ball_wall ? 1 : 2 + (&law - mill_.pairs.laws.data());
  }
  Residuals residuals(const LoggedEvent& event, const LoggedImpact& impact, const Known& known,
                      bool parting) const;
  bool explain(const LoggedEvent& event, const Scene& scene, double allowed_off,
               Explanation& explanation) const;
  bool explain_by_formula(const LoggedEvent& event, const Scene& scene, double allowed_off,
                          Explanation& explanation) const;
  void tell_broken_equations(const LoggedEvent& event, const Scene& scene, const Residuals& off,
                             const Known& known, double allowed_off);
  bool leaves_by_the_other_branch(const LoggedEvent& event, const LoggedImpact& impact,
                                  double allowed_off) const;
  void tell_normal(const LoggedEvent& event, const LoggedImpact& impact, double off, double allowed_off);
  bool speeds_tell_another_wall_velocity(const LoggedEvent& event, const Scene& scene, const Known& known,
                                         double allowed_off) const;
  void judge_logged_speeds(const LoggedEvent& event, const LoggedImpact& impact, const Known& known,
                           double scale, bool wall_velocity_told);
  void judge_energies(const LoggedEvent& event, const LoggedImpact& right, const LoggedImpact& theirs,
                      double scale);
  void judge_dose(const LoggedEvent& event, const LoggedImpact& right, const LoggedImpact& theirs,
                  double allowed_off);
  void tell(Kind kind, const LoggedEvent& event, double size, double found, double expected,
            const char* note = "");

  const model::Mill<double>& mill_;
  const Available& available_;
  Tolerances tolerances_;
  Findings& findings_;
  Energies energies_;
  /// A least separation speed in the log other than the case's: two impacts of different approach speed
  /// separate at the same speed. The first of them is kept until the second one is found.
  struct OtherLeast {
    double speed = std::numeric_limits<double>::infinity(), g_n = 0, due = 0;
    bool confirmed = false;
    std::optional<Finding> held;
  };
  std::map<std::ptrdiff_t, OtherLeast> other_least_;  ///< by law of the impacts
};

}  // namespace edmill::audit
