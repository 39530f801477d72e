// Recognises inelastic collapse: infinitely many impacts of a ball in finite time.
#pragma once

#include <algorithm>
#include <cstdint>

#include "edmill/core/instant.hpp"

namespace edmill::engine {

/// What is kept of a ball's recent impacts.
template <class Real>
struct RecentImpacts {
  Instant<Real> last = Instant<Real>::long_ago();
  Real accumulation{0};  ///< time [s] to which a burst converges
  int partner = -1;
  std::int16_t burst = 0, stuck = 0, rest = 0;  ///< impacts in a row; counted up to `CollapseWatch::plenty`
  bool extrapolated = false;                    ///< whether `accumulation` is known

  void archive(Archive& a) { a(last, accumulation, partner, burst, stuck, rest, extrapolated); }
};

/// Follows the balls' recent impacts. A ball whose last `enough` impacts each came after a path shorter than
/// `smallest_path`, a length well above rounding, is in collapse. The accumulation time extrapolates the
/// first of these impacts, where rounding matters least: intervals with one partner shrink by the restitution
/// e, so the rest of them sums to dt e / (1 - e).
template <class Real>
class CollapseWatch {
 public:
  /// @param resting_path  the same for `resting`, of one size in every scalar [m]
  CollapseWatch(const Real& smallest_path, const Real& resting_path)
      : smallest_path_(smallest_path), resting_path_(resting_path) {}

  /// Takes note of an impact. @param key identifies the partner, @return true when the ball is in collapse
  bool note(RecentImpacts<Real>& r, int key, const Instant<Real>& now, const Real& approach_speed,
            const Real& restitution, const DriveClock<Real>& clock) const {
    const Real interval = clock.elapsed(r.last, now);
    if (interval * approach_speed < smallest_path_) {
      if (r.burst == 0) {
        r.extrapolated = r.partner == key && restitution < 1;
        if (r.extrapolated) r.accumulation = clock.seconds(now) + interval * restitution / (1 - restitution);
      }
      if (r.partner != key) r.extrapolated = false;
      r.burst = one_more(r.burst);
    } else {
      r.burst = 0;
    }
    r.rest = interval * approach_speed < resting_path_ ? one_more(r.rest) : std::int16_t{0};
    r.stuck = interval > 0 ? std::int16_t{0} : one_more(r.stuck);
    r.last = now;
    r.partner = key;
    return r.burst >= enough;
  }

  /// The ball's recent impacts came after paths so short that it is at rest for every purpose: with t_c,
  /// where friction at one wall takes the motion along the normal of another.
  static bool resting(const RecentImpacts<Real>& r) { return r.rest >= enough; }

  /// Impacts of the ball without any time between them.
  static bool stuck(const RecentImpacts<Real>& r) { return r.stuck >= plenty; }

  static Real accumulation_time(const RecentImpacts<Real>& r, const DriveClock<Real>& clock) {
    return r.extrapolated ? r.accumulation : clock.seconds(r.last);
  }

  static constexpr std::int16_t enough = 8, plenty = 1000;

 private:
  static std::int16_t one_more(std::int16_t count) {
    return std::min(static_cast<std::int16_t>(count + 1), plenty);
  }

  Real smallest_path_, resting_path_;
};

}  // namespace edmill::engine
