// The derivative of a run with respect to initial states and numbers of its case, event by event.
// docs/theory.md, "Tangent dynamics"
#pragma once

#include <array>
#include <vector>

#include "engine/observer.hpp"
#include "model/case.hpp"
#include "run/event_source.hpp"
#include "tangent/spectrum.hpp"

namespace edmill::run {

/// What a parameter of the case, or a number of the initial state, changes.
struct Perturbation {
  model::Mill<mpfr> mill;  ///< with the parameter larger by `step`
  std::vector<model::BallProperties<mpfr>> balls;
  std::vector<tangent::Tangent<mpfr>> initial;  ///< derivative of the balls' states at the start
  mpfr step{0};                                 ///< negative where no larger value is allowed
};

/// The derivatives of one impact.
struct EventDerivative {
  std::array<mpfr, model::logged_count> values;        ///< of model::logged_quantities
  std::array<tangent::Tangent<mpfr>, 2> states_after;  ///< of the ball and, if it is one, the partner
};

/// Observes a run, and carries the states of motions that are infinitely close to it from impact to impact.
/// The map of an impact is taken for the run and for the neighbouring motion, `step` away, in three times the
/// run's digits: the difference divided by the step is the derivative to the digits of the run.
class Linearised : public engine::Observer<mpfr> {
 public:
  /// @param base    the mill in these digits, and balls without `initial`
  /// @param digits  of the evaluation
  Linearised(Perturbation base, std::vector<Perturbation> others, unsigned digits);

  void on_impact(const engine::Impact<mpfr>& impact, engine::Simulation<mpfr>& simulation) override;

  /// By impact, and then by perturbation.
  const std::vector<std::vector<EventDerivative>>& events() const { return events_; }

 private:
  struct Body;
  EventDerivative derivative(const engine::Impact<mpfr>& impact, const std::array<Body, 2>& bodies,
                             std::size_t which);

  Perturbation base_;
  std::vector<Perturbation> others_;
  unsigned digits_;
  std::vector<std::vector<tangent::Tangent<mpfr>>>
      tangents_;  ///< by perturbation and ball, at its last impact
  std::vector<std::vector<EventDerivative>> events_;
};

}  // namespace edmill::run
