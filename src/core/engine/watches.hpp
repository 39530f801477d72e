// Detects runs that cannot continue: by inelastic collapse, infinitely many impacts of a ball in
// finite time, or since time no longer advances.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/instant.hpp"
#include "model/outcome.hpp"

namespace edmill::engine {

template <class Real> struct RecentImpacts {
  Instant<Real> last = Instant<Real>::long_ago();
  Real accumulation{-1};  ///< time [s] to which a burst converges; negative where it is not known
  int partner = -1;
  std::int8_t burst = 0;  ///< impacts in a row, up to `CollapseWatch::enough`

  void archive(Archive& a) { a(last, accumulation, partner, burst); }
};

/// Detects inelastic collapse, for laws without a least separation speed. A ball is in collapse if
/// each of its last `enough` impacts came after a path shorter than `smallest_path`, a length well
/// above rounding, and was so slow that acceleration alone brought the bodies together again, or
/// mere rounding. Faster impacts after such paths are those of bodies that touch, and come to an
/// end. The accumulation time is extrapolated from the first of them, where rounding matters least:
/// intervals with one partner shrink by the restitution e, so the rest sum to dt e / (1 - e).
template <class Real> class CollapseWatch {
 public:
  explicit CollapseWatch(const Real& smallest_path) : smallest_path_(smallest_path) {}

  /// Records an impact with the partner `key`. @return true if the ball is in collapse
  /// @param slow  [m/s] any less is due to acceleration over the smallest path, or to rounding
  bool note(RecentImpacts<Real>& r, int key, const Instant<Real>& now, const Real& approach_speed,
      const Real& slow, const Real& restitution, const DriveClock<Real>& clock) const {
    const Real interval = clock.elapsed(r.last, now);
    if (interval * approach_speed < smallest_path_ && approach_speed < slow) {
      if (r.burst == 0) {
        r.accumulation = -1;
        if (restitution < 1)
          r.accumulation = clock.seconds(now) + interval * restitution / (1 - restitution);
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

/// Detects stalled runs: so many impacts while the clock hardly advances that bodies are jammed,
/// for frictionless ones would have found any motion that separates them. theory.md, section 6
template <class Real> class StallWatch {
 public:
  /// @param balls  how many there are: each may have impacts of its own at one instant
  /// @param brief  an advance of the clock by less than this does not count [s]
  StallWatch(std::size_t balls, const Instant<Real>& start, Real brief)
      : most_(std::int64_t{100000} + 100 * static_cast<std::int64_t>(balls)), left_(most_),
        begin_(start), brief_(std::move(brief)) {}

  /// Takes note of an impact. @return true when the run is stalled
  bool note(const Instant<Real>& now, const DriveClock<Real>& clock, int ball, bool with_wall,
      int partner) {
    if (--left_ > 0) [[likely]]
      return false;
    return look(now, clock, ball, with_wall, partner);
  }

  /// The bodies that hit each other in the stall.
  const model::Stall<Real>& found() const { return found_; }

  /// True if the loaded state is possible in a run with this many balls and walls.
  bool is_sound(int balls, int walls) const {
    const auto are_below = [](const std::vector<int>& bodies, int count) {
      return std::all_of(bodies.begin(), bodies.end(), [&](int b) { return b >= 0 && b < count; });
    };
    return left_ <= most_ && left_ > -sample && are_below(found_.balls, balls) &&
        are_below(found_.walls, walls);
  }

  void archive(Archive& a) { a(left_, begin_, found_); }
 private:
  /// Number of further impacts after which each of the bodies has taken part in one.
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

  std::int64_t most_, left_;  ///< impacts since `begin_`: enough for a stall, and left until then
  Instant<Real> begin_;
  Real brief_;
  model::Stall<Real> found_;
};

}  // namespace edmill::engine
