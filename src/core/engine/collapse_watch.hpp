// Recognises inelastic collapse: infinitely many impacts of a ball in finite time.
#pragma once

#include <algorithm>
#include <cstdint>

#include "base/instant.hpp"

namespace edmill::engine {

/// What is kept of a ball's recent impacts.
template <class Real>
struct RecentImpacts {
  Instant<Real> last = Instant<Real>::long_ago();
  Real accumulation{-1};  ///< time [s] to which a burst converges; negative where it is not known
  int partner = -1;
  std::int8_t burst = 0;  ///< impacts in a row, up to `CollapseWatch::enough`

  void archive(Archive& a) { a(last, accumulation, partner, burst); }
};

/// Follows the balls' recent impacts by laws without a least separation speed. A ball is in collapse whose
/// last `enough` impacts each came after a path shorter than `smallest_path`, a length well above rounding,
/// and so slowly that the bodies' acceleration brought them together again, or that nothing but rounding is
/// left of their approach. Faster impacts without a path are those of bodies that touch: a sequence of them
/// comes to an end.
/// The accumulation time extrapolates the first of these impacts, where rounding matters least: intervals
/// with one partner shrink by the restitution e, so the rest of them sums to dt e / (1 - e).
template <class Real>
class CollapseWatch {
 public:
  explicit CollapseWatch(const Real& smallest_path) : smallest_path_(smallest_path) {}

  /// Takes note of an impact. @param key identifies the partner, @return true when the ball is in collapse
  /// @param slow  of approach speeds by acceleration over the smallest path, or by rounding [m/s]
  bool note(RecentImpacts<Real>& r, int key, const Instant<Real>& now, const Real& approach_speed,
            const Real& slow, const Real& restitution, const DriveClock<Real>& clock) const {
    const Real interval = clock.elapsed(r.last, now);
    if (interval * approach_speed < smallest_path_ && approach_speed < slow) {
      if (r.burst == 0) {
        r.accumulation = -1;
        if (restitution < 1) r.accumulation = clock.seconds(now) + interval * restitution / (1 - restitution);
      }
      if (r.partner != key) r.accumulation = -1;
      r.burst = std::min(static_cast<std::int8_t>(r.burst + 1), enough);
    } else {
      r.burst = 0;
    }
    r.last = now;
    r.partner = key;
    return r.burst >= enough;
  }

  static Real accumulation_time(const RecentImpacts<Real>& r, const DriveClock<Real>& clock) {
    return r.accumulation < 0 ? clock.seconds(r.last) : r.accumulation;
  }

  const Real& smallest_path() const { return smallest_path_; }

  static constexpr std::int8_t enough = 8;

 private:
  Real smallest_path_;
};

}  // namespace edmill::engine
