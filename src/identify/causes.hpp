// Mistakes other than wrong numbers: orders, signs, directions, units, and what columns stand for.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "audit/audit.hpp"
#include "identify/parameters.hpp"

namespace edmill::identify {

/// A mistake that is made or not.
struct Mistake {
  std::string key;   ///< "mill, order of rotations"
  std::string text;  ///< "R_x(gamma) R_z(theta) in place of R_z(theta) R_x(gamma)"
  std::function<void(Assumptions&)> make;
  bool by_factor = false;  ///< of a number, as a wrong unit makes it
  bool of_motion = false;  ///< it makes another mill, which has not the numbers of the case's

  /// The assumptions with it.
  Assumptions on(Assumptions base) const {
    make(base);
    return base;
  }
};

/// Those that can be told apart in a log with these columns.
std::vector<Mistake> mistakes_of(const Assumptions& nominal, const std::vector<Parameter>& parameters,
                                 const audit::EventsAtHand& log);

}  // namespace edmill::identify
