// Tolerances of an audit. docs/audit.md, "Tolerances"
#pragma once

#include <cmath>
#include <limits>

namespace edmill::audit {

struct Tolerances {
  double relative = 1e-9;
  double gap = 0;    ///< between bodies in contact [m]
  double reach = 0;  ///< largest distance of a ball from the fulcrum [m]

  /// Uncertainty of a logged time by rounding [s].
  static double time(double t) { return 4 * std::numeric_limits<double>::epsilon() * std::abs(t); }
  double touch(double t, double speed) const { return gap + time(t) * speed; }
  double position(double t, double path, double speed) const {
    return relative * (reach + path) + time(t) * speed;
  }
};

}  // namespace edmill::audit
