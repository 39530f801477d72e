// Checks a single impact: the contact law, conservation, and the values logged with it.
#pragma once

#include <limits>
#include <map>
#include <optional>

#include "audit/finding.hpp"
#include "audit/mechanics.hpp"
#include "audit/naming.hpp"
#include "audit/stall_history.hpp"
#include "audit/tolerances.hpp"
#include "base/compensated_sum.hpp"

namespace edmill::audit {

/// An impact and where it takes place.
struct Scene {
  ContactGeometry impact;  ///< with the right velocity of the wall
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

inline Finding finding(Kind kind, const LoggedEvent& event, double size, double found, double expected,
                       const char* note = "", bool explained = false) {
  return {kind,          size,  event.line, event.time, event.ball, event.with_wall,
          event.partner, found, expected,   note,       explained};
}

class ImpactJudge {
 public:
  ImpactJudge(const model::Mill<double>& mill, const Available& available, const Tolerances& tolerances,
              Findings& findings)
      : mill_(mill),
        available_(available),
        tolerances_(tolerances),
        findings_(findings),
        suspicions_(known_mistake_count(), Suspicion(findings.examples())),
        net_dose_(findings.examples()),
        dose_without_rule_(findings.examples()) {}

  /// Judges an impact by the states of the bodies.
  void judge(const LoggedEvent& event, Scene scene);
  /// Judges the dose by the logged speeds, where the log or this impact has no states.
  void judge_speeds(const LoggedEvent& event, const ContactGeometry& impact);
  const model::ContactLaw<double>& law(const ContactGeometry& impact) const { return law_of(mill_, impact); }
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
  /// A mistake that reproduces a violating impact.
  struct Explanation {
    std::size_t mistake;
    Kind kind;
    const char* note;
    ContactGeometry impact;  ///< as that code saw it
    double off, left;        ///< without the mistake and with it [m/s]
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

  /// Number of a law of the mill: of balls, with walls, pairs of materials.
  std::ptrdiff_t number_of(const model::ContactLaw<double>& law) const {
    if (&law == &mill_.ball_ball) return 0;
    return &law == &mill_.ball_wall ? 1 : 2 + (&law - mill_.pairs.laws.data());
  }
  Residuals residuals(const LoggedEvent& event, const ContactGeometry& impact, const Known& known,
                      bool parting) const;
  static std::size_t known_mistake_count();
  /// The known mistake that reproduces the logged outcome, if one does. What does not is noted, also of an
  /// impact that is not violated.
  std::optional<Explanation> explaining(const LoggedEvent& event, const Scene& scene, double allowed,
                                        bool violated);
  bool fits_without_friction(const LoggedEvent& event, const ContactGeometry& impact,
                             const Known& known) const;
  bool tell_broken_equations(const LoggedEvent& event, const Scene& scene, const Residuals& off,
                             double allowed, Findings& plain);
  void tell_normal(const LoggedEvent& event, const ContactGeometry& impact, double off, double allowed,
                   Findings& plain);
  void see_separation(const LoggedEvent& event, const ContactGeometry& impact, double allowed);
  std::optional<double> other_wall_speed(const LoggedEvent& event, const ContactGeometry& impact,
                                         const Residuals& off, double allowed) const;
  bool judge_outcome(const LoggedEvent& event, const Scene& scene, const Known& known, const Allowed& allowed,
                     ContactGeometry& theirs);
  void judge_logged_speeds(const LoggedEvent& event, const ContactGeometry& impact, const Known& known,
                           double allowed, bool wall_velocity_told);
  void judge_energies(const LoggedEvent& event, const ContactGeometry& right, const ContactGeometry& theirs,
                      double allowed);
  void judge_dose(const LoggedEvent& event, const ContactGeometry& right, const ContactGeometry& theirs,
                  double allowed);
  void tell_dose(const LoggedEvent& event, double off, double expected, double allowed, double left,
                 double changes, Suspicion& mistake, const char* note);
  void leave_unresolved(const Known& known);
  bool leaves_by_the_other_branch(const LoggedEvent& event, const ContactGeometry& impact, double off,
                                  double allowed) const;
  void tell(Kind kind, const LoggedEvent& event, double size, double found, double expected) {
    findings_.add(finding(kind, event, size, found, expected));
  }

  const model::Mill<double>& mill_;
  const Available& available_;
  Tolerances tolerances_;
  Findings& findings_;
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
  std::map<std::ptrdiff_t, SeparationSuspicions> separations_;  ///< by law of the impacts
  Suspicion net_dose_, dose_without_rule_;
};

}  // namespace edmill::audit
