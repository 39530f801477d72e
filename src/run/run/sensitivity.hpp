// Derivatives of the first events of a case with respect to its numbers and to the initial state.
// docs/theory.md, "Tangent dynamics"
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "casefile/case_spec.hpp"
#include "run/event_source.hpp"
#include "tangent/spectrum.hpp"

namespace edmill::run {

/// The derivatives of one impact.
struct EventDerivative {
  std::array<mpfr, model::logged_count> values;  ///< of model::logged_quantities
  std::array<tangent::Tangent<mpfr>, 2>
      states_after;  ///< of the ball and, if it is one, the partner
};

struct SensitivityOptions {
  /// Keys of numbers in the case file, "contact.restitution", or "initial.3.vx": of ball 3 at the
  /// start one of x, y, z, vx, vy, vz, wx, wy, wz.
  std::vector<std::string> by;
  std::size_t events = 0;
  unsigned digits = 17;  ///< correct digits of each derivative
  bool states =
      false;         ///< the file has the derivatives of the balls' states after each impact, too
  std::string file;  ///< CSV; none when empty
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(const std::string& precision, std::size_t events)> progress = [](const auto&,
                                                                                       auto) {};
};

struct Sensitivities {
  std::vector<std::string> by,
      units;  ///< unit of each number as in the case, "rpm"; "m/s" for a velocity
  std::vector<Event> events;
  std::vector<std::vector<EventDerivative>> derivatives;  ///< by event, and by number
  std::string precision;                                  ///< of the run
  bool interrupted = false;
};

/// Computes the first events, with their derivatives, in the digits that their errors require.
/// @throws InputError for a key that is no number of the case, and a case that ends before
/// @throws UndecidedError when a rule orders two contacts at one time
Sensitivities sensitivity(const casefile::CaseSpec& spec, const SensitivityOptions& options);

}  // namespace edmill::run
