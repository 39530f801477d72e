// A run of a case.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "edmill/case.hpp"
#include "edmill/contact_law.hpp"
#include "edmill/motion.hpp"
#include "edmill/observer.hpp"
#include "edmill/summary.hpp"
#include "edmill/version.hpp"
#include "edmill/vessel.hpp"

namespace edmill {

/// User-defined contact laws. A null pointer keeps the law of the case.
template <class Real> struct Laws { std::shared_ptr<const CustomLaw<Real>> ball_ball, ball_wall; };

/// Parts of the model that a program defines itself. An empty part keeps that of the case.
template <class Real> struct OwnParts {
  Planes<Real> planes{};                       ///< of the vessel
  std::optional<CurvedVessel<Real>> vessel{};  ///< in place of planes
  Joints<Real> joints{};                       ///< that move the vessel
  Laws<Real> laws{};
};

/// Properties of a ball that are constant during a run.
template <class Real> struct Ball {
  Real radius{}, mass{};  ///< [m], [kg]
  std::string material;   ///< empty where the case names none
};

/// A run of a case in one scalar: double, float128, or mpfr. A run in mpfr must be constructed and
/// advanced within one scope of `mpfr::Digits` (default: 50 digits).
template <class Real> class Run {
 public:
  /// Places the balls and predicts their first contacts.
  /// @throws InputError when there is no room for the balls or the scalar cannot resolve the case
  /// @throws UndecidedError when no scalar can decide about a first contact
  /// @throws InputError when the planes do not form a closed vessel around the origin
  explicit Run(const Case& the_case, const Laws<Real>& laws = {}, const Planes<Real>& vessel = {});
  /// A run with parts of the model that the program defines.
  /// @throws InputError also when the walls of a curved vessel leave no room in its box or do not
  /// close it, and when a joint has no axis
  Run(const Case& the_case, const OwnParts<Real>& own);
  ~Run();
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  /// Makes the run write the outputs of the case, case.toml, final_state.csv and summary.json to a
  /// folder, like `edmill run --out`. Must be called before the run advances; without it nothing is
  /// written.
  /// @throws InputError when a file cannot be written, another process or run writes into the
  /// folder, or an unfinished run has left its checkpoint there
  void write_to(const std::string& folder);
  /// Moves these files into place and removes files of an earlier run that this run has not
  /// written. Must be called once, after the last advance.
  void commit();

  /// Observers receive every impact, in the order of attachment; they must outlive the run.
  void attach(Observer<Real>& observer);

  /// Simulates up to `time` [s], or until a stop rule of the case or an observer ends the run.
  /// @return true if the run can be continued
  /// @throws UndecidedError when no scalar can make a decision
  bool advance_to(const Real& time);
  /// Simulates to the end of the case.
  void finish();
  /// Ends the run after the present impact; for observers.
  void stop();
  /// Ends the run after the present impact, for a signal: its end reason is `interrupted`.
  void interrupt();

  Real time() const;  ///< [s]
  int ball_count() const;
  /// State of a ball now.
  BallState<Real> ball(int i) const;
  Ball<Real> properties(int i) const;
  Summary<Real> summary() const;
 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace edmill
