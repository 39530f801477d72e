// Judges a single impact: the contact law, conservation, and the numbers that are logged with it.
#pragma once

#include <vector>

#include "edmill/audit/finding.hpp"
#include "edmill/audit/mechanics.hpp"
#include "edmill/audit/tolerances.hpp"

namespace edmill::audit {

/// Restitutions that are right for an impact: more than one where the log does not tell the last impact.
struct Restitutions {
  bool law = true;        ///< e_n of the law
  bool collapse = false;  ///< 1, within t_c of the last impact
  bool rest = false;      ///< nothing lost, of a ball at rest
};

/// An impact and where it takes place.
struct Scene {
  Impact impact;  ///< with the right velocity of the wall
  VesselFrame nested, printed;
  bool displaced = false;  ///< judged in the printed frame, where that code has its walls
};

/// What the impacts of a log do in all.
struct Energies {
  std::uint64_t creating = 0;  ///< impacts that create energy
  double created = 0;          ///< by them [J]
};

class ImpactJudge {
 public:
  ImpactJudge(const model::Mill<double>& mill, const Available& available, const Tolerances& tolerances,
              Findings& findings)
      : mill_(mill), available_(available), tolerances_(tolerances), findings_(findings) {}

  /// With the states of the bodies.
  void judge(const LoggedEvent& event, Scene scene, const Restitutions& allowed);
  /// Of a log, or for an impact, without them: the dose from the logged speeds.
  void judge_speeds(const LoggedEvent& event, const Impact& impact, const Restitutions& allowed);

  const Energies& energies() const { return energies_; }

 private:
  /// How far the impact is from each of the equations [m/s].
  struct Residuals {
    double normal = 0, tangential = 0, momentum = 0, spin = 0;
    double restitution = 1;  ///< the allowed one that fits best
    bool lossless = false;
    double largest() const;
  };
  /// What explains a broken impact.
  struct Explanation {
    Kind kind;
    const char* note;
    Impact impact;
  };
  struct Known {
    bool velocities, spins;  ///< before and after, of all bodies
  };

  const model::ContactLaw<double>& law(const Impact& impact) const {
    return impact.with_wall ? mill_.ball_wall : mill_.ball_ball;
  }
  Residuals residuals(const LoggedEvent& event, const Impact& impact, const Restitutions& allowed,
                      const Known& known) const;
  std::vector<Formula> right_formulas(const Impact& impact, const Restitutions& allowed) const;
  bool explain(const LoggedEvent& event, const Scene& scene, const Restitutions& allowed, double allowed_off,
               Explanation& explanation) const;
  bool explain_by_formula(const LoggedEvent& event, const Scene& scene, const Formula& right,
                          double allowed_off, Explanation& explanation) const;
  void tell_broken_equations(const LoggedEvent& event, const Scene& scene, const Residuals& off,
                             const Known& known, double allowed_off);
  bool speeds_tell_another_wall_velocity(const LoggedEvent& event, const Scene& scene, const Known& known,
                                         double allowed_off) const;
  void judge_logged_speeds(const LoggedEvent& event, const Impact& impact, const Known& known, double scale,
                           bool wall_velocity_told);
  void judge_energies(const LoggedEvent& event, const Impact& right, const Impact& theirs,
                      const Restitutions& allowed, double scale);
  double dose_by_law(const Impact& impact, const Formula& formula, double approach, double slip) const;
  void tell(Kind kind, const LoggedEvent& event, double size, double found, double expected,
            const char* note = "");

  const model::Mill<double>& mill_;
  const Available& available_;
  Tolerances tolerances_;
  Findings& findings_;
  Energies energies_;
};

}  // namespace edmill::audit
