// Recognise runs that cannot go on: by inelastic collapse, infinitely many impacts of a ball in finite time,
// or because time no longer advances.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/instant.hpp"
#include "model/outcome.hpp"

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

/// Counts the impacts of all balls against the clock. A run is stalled when so many come while the clock
/// hardly advances that the bodies can only be jammed: where any motion parts them all, impacts without
/// friction find it sooner (theory.md, section 6).
template <class Real>
class StallWatch {
 public:
  /// @param balls  how many there are: each may have impacts of its own at one instant
  /// @param brief  the clock has hardly advanced when by less than this [s]
  StallWatch(std::size_t balls, const Instant<Real>& start, Real brief)
      : most_(std::int64_t{100000} + 100 * static_cast<std::int64_t>(balls)),
        left_(most_),
        begin_(start),
        brief_(std::move(brief)) {}

  /// Takes note of an impact of a ball with a wall or another ball. @return true when the run is stalled
  bool note(const Instant<Real>& now, const DriveClock<Real>& clock, int ball, bool with_wall, int partner) {
    if (--left_ > 0) [[likely]]
      return false;
    return look(now, clock, ball, with_wall, partner);
  }

  /// The bodies that hit each other then.
  const model::Stall<Real>& found() const { return found_; }

  /// Whether what was loaded can be of a run of so many balls and walls.
  bool is_sound(int balls, int walls) const {
    const auto are_below = [](const std::vector<int>& bodies, int count) {
      return std::all_of(bodies.begin(), bodies.end(), [&](int b) { return b >= 0 && b < count; });
    };
    return left_ <= most_ && left_ > -sample && are_below(found_.balls, balls) &&
           are_below(found_.walls, walls);
  }

  void archive(Archive& a) { a(left_, begin_, found_); }

 private:
  /// Enough further impacts that each of the bodies takes part.
  static constexpr std::int64_t sample = 10000;

  [[gnu::noinline]] bool look(const Instant<Real>& now, const DriveClock<Real>& clock, int ball,
                              bool with_wall, int partner) {
    if (!(clock.elapsed(begin_, now) < brief_)) {
      begin_ = now;
      left_ = most_;
      found_ = {};
      return false;
    }
    add(found_.balls, ball);
    add(with_wall ? found_.walls : found_.balls, partner);
    found_.time = clock.seconds(now);
    found_.impacts = static_cast<std::uint64_t>(most_ - left_);
    return left_ <= -sample;
  }
  static void add(std::vector<int>& bodies, int body) {
    const auto place = std::lower_bound(bodies.begin(), bodies.end(), body);
    if (place == bodies.end() || *place != body) bodies.insert(place, body);
  }

  std::int64_t most_, left_;  ///< impacts since `begin_`: how many are enough, and how many are left to that
  Instant<Real> begin_;
  Real brief_;
  model::Stall<Real> found_;
};

}  // namespace edmill::engine
