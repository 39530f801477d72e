// First contact of two balls in free flight, as a certified decision. Equation (3.1) of the thesis.
#pragma once

#include "dynamics/flight.hpp"
#include "model/mill.hpp"

namespace edmill::dynamics {

template <class Real> struct PairAnswer {
  Verdict verdict = Verdict::none;
  Real delay{0};       ///< of a contact: time from now [s], >= 0
  Real time_error{0};  ///< of a contact: bound on the rounding error of the delay [s]
};

/// Constants, for a whole run, of the filter that proves that nearly all pairs never meet.
template <class Real> struct PairFilter {
  Vec3<Real> gravity;
  Real period;                               ///< of the drive [s]
  Real relative, slowest_squared, touching;  ///< see PairSearch::raise_top_speed
  Real grazing;  ///< a contact time is accurate if the discriminant is larger by this [m^4/s^2]

  bool may_meet(const Real& b, const Real& c, const Real& v2, const Real& r2) const {
    // No branch: whether two balls approach cannot be predicted by the processor.
    const Real error = relative * (v2 * r2);
    const bool moving = v2 > slowest_squared;
    const bool apart = (c > touching) & ((b >= 0) | (b * b - v2 * c < -error));
    const bool separating = (b > 0) & (b * b > error);  // even in contact, as after a collision
    return !(moving & (apart | separating));
  }
};

/// First contact of two balls in flight. Both have the same acceleration, so their relative motion
/// is uniform: r = r_i - r_j, v = v_i - v_j, b = r.v < 0, c = r.r - R^2, dt = c / (-b + sqrt(b^2 -
/// v.v c)). (3.1) Balls that overlap by rounding collide at once if they approach, else never.
template <class Real> class PairSearch {
 public:
  /// @param smallest_sum  least sum of two radii [m]
  /// @param reach         largest distance of a ball from the origin [m]
  /// @param top_speed     no ball is faster [m/s]; see `raise_top_speed`
  PairSearch(const model::Mill<Real>& mill, const Real& smallest_sum, const Real& reach,
      const Real& top_speed)
      : gravity_(mill.gravity), clock_(mill.motion.period()), smallest_sum_(smallest_sum),
        reach_(reach), widest_(2 * mill.vessel.reach()), largest_sum_(mill.vessel.widest_ball()),
        gravity_size_(norm<Real>(gravity_)), least_separation_(mill.least_separations().first) {
    filter_.gravity = gravity_;
    filter_.period = clock_.period();
    raise_top_speed(top_speed);
  }

  const Real& top_speed() const { return top_speed_; }
  /// Contacts farther apart in time than this [s] occur as predicted: errors are below its quarter.
  const Real& tie_window() const { return tie_window_; }
  const DriveClock<Real>& clock() const { return clock_; }

  void raise_top_speed(const Real& top_speed) {
    const Real u = epsilon<Real>() / 2;
    top_speed_ = top_speed;
    position_error_ = u * (24 * reach_ + 16 * top_speed_ * clock_.period());
    filter_.relative = 4096 * (8 * position_error_ / smallest_sum_ + 16 * u);
    const Real slowest = 64 * u * (top_speed_ + gravity_size_ * clock_.period()) / filter_.relative;
    filter_.slowest_squared = slowest * slowest;
    filter_.touching = 16 * position_error_ * smallest_sum_;

    // Long enough to resolve contacts at the least separation speed, and so short that two balls of
    // cells that are not adjacent cannot meet within it.
    using std::sqrt;
    tie_window_ = sqrt(epsilon<Real>()) * clock_.period();
    if (least_separation_ > 0 && 64 * position_error_ > tie_window_ * least_separation_)
      tie_window_ = 64 * position_error_ / least_separation_;
    const Real unseen = smallest_sum_ / (4096 * top_speed_);
    if (unseen < tie_window_) tie_window_ = unseen;
    // An upper bound on `time_error` for any two balls in the vessel: a flight whose deflection is
    // at most twice the reach gains at most this speed.
    const Real fall = 4 * sqrt(reach_ * gravity_size_);
    const Real displaced = position_error_ + u * (640 * reach_ + 12 * clock_.period() * fall);
    const Real least_root = 4 *
        contact_error(widest_ * widest_, largest_sum_, displaced, widest_ * widest_) / tie_window_;
    filter_.grazing = least_root * least_root;
  }

  /// State of a ball at one instant, for queries with many partners.
  struct State {
    Vec3<Real> position;  ///< now [m]
    Vec3<Real> velocity;  ///< at the start of the flight [m/s]
    Real age;             ///< time since the start of the flight [s]
  };

  State state(const Flight<Real>& flight, const Instant<Real>& now) const {
    const Real age = clock_.elapsed(flight.start, now);
    return {position_after(flight, gravity_, age), flight.velocity, age};
  }

  /// The filter: false if the two balls provably never meet, as nearly all pairs. It has no branch.
  bool may_meet(
      const State& i, const Flight<Real>& j, const Instant<Real>& now, const Real& sum) const {
    const Relative s = relative(i, j, now, sum);
    return filter_.may_meet(s.b, s.c, s.v2, s.r2);
  }
  const PairFilter<Real>& filter() const { return filter_; }

  /// First contact from `now` on; both flights started before or at `now`.
  PairAnswer<Real> operator()(const State& i, const Flight<Real>& j, const Instant<Real>& now,
      const Real& radius_sum) const {
    const Relative s = relative(i, j, now, radius_sum);
    const Real discriminant = s.b * s.b - s.v2 * s.c;
    if (!filter_.may_meet(s.b, s.c, s.v2, s.r2)) return {};
    const Real age = i.age > s.age ? i.age : s.age;
    if (s.v2 > filter_.slowest_squared && s.c > filter_.touching &&
        discriminant > filter_.relative * (s.v2 * s.r2) + filter_.grazing) {
      using std::sqrt;
      const Real root = sqrt(discriminant);  // v.r at the contact: approach speed times R
      const Real delay = s.c / (root - s.b);
      return {Verdict::contact, delay, time_error(s, delay, root, radius_sum, age)};
    }
    return close(s, age, radius_sum);
  }
 private:
  /// Relative motion of two balls now.
  struct Relative {
    Real b, c, v2, r2;  ///< r.v, r.r - R^2, v.v, r.r
    Real dt, age;       ///< difference of the ages, age of j [s]
  };
  Relative relative(const State& i, const Flight<Real>& j, const Instant<Real>& now,
      const Real& radius_sum) const {
    // Equals DriveClock::elapsed, without its branch.
    const Real age = static_cast<Real>(now.period - j.start.period) * clock_.period() +
        (now.offset - j.start.offset);
    const Vec3<Real> r = i.position - position_after(j, gravity_, age);
    const Real dt = i.age - age;  // zero for balls that started together
    const Vec3<Real> v{(i.velocity[0] - j.velocity[0]) + gravity_[0] * dt,
        (i.velocity[1] - j.velocity[1]) + gravity_[1] * dt,
        (i.velocity[2] - j.velocity[2]) + gravity_[2] * dt};
    const Real r2 = dot<Real>(r, r);
    return {.b = dot<Real>(r, v),
        .c = r2 - radius_sum * radius_sum,
        .v2 = dot<Real>(v, v),
        .r2 = r2,
        .dt = dt,
        .age = age};
  }

  /// Bounds on the rounding of the relative position now and of the relative velocity.
  Real position_error(const Real& age) const {
    const Real u = epsilon<Real>() / 2;
    return position_error_ + u * (16 * gravity_size_ * age * age + 16 * top_speed_ * age);
  }
  Real velocity_error(const Relative& s, const Real& speed, const Real& age) const {
    const Real u = epsilon<Real>() / 2;
    return 4 * u * speed +
        (s.dt == 0 ? Real(0) : Real(12 * u * gravity_size_ * (age + clock_.period())));
  }

  /// Twice a bound on the rounding of (r.r - R^2)/2 at the computed time: the path is displaced,
  /// and the sums of (3.1) are rounded. theory.md, section 4. @param b_delay  |r.v| times the delay
  static Real contact_error(
      const Real& r2, const Real& radius_sum, const Real& displaced, const Real& b_delay) {
    const Real u = epsilon<Real>() / 2;
    return 2 * radius_sum * displaced + 16 * u * (r2 + radius_sum * radius_sum + b_delay);
  }
  /// Bound on the error of a delay [s]: `contact_error` over its rate, the discriminant's root.
  Real time_error(const Relative& s, const Real& delay, const Real& root, const Real& radius_sum,
      const Real& age) const {
    using std::sqrt;
    const Real displaced = position_error(age) + velocity_error(s, sqrt(s.v2), age) * delay;
    return contact_error(s.r2, radius_sum, displaced, magnitude(s.b) * delay) / root +
        4 * epsilon<Real>() * (delay + clock_.period());
  }

  /// Decides with bounds computed for this pair, if the balls touch, graze or move slowly.
  PairAnswer<Real> close(const Relative& s, const Real& age, const Real& radius_sum) const {
    using std::sqrt;
    const Real u = epsilon<Real>() / 2;
    const auto& [b, c, v2, r2, dt, age_of_j] = s;
    if (v2 == 0 && (dt == 0 || gravity_size_ == 0))
      return {};  // exactly at rest relative to each other
    const Real speed = sqrt(v2), distance = sqrt(r2);
    const Real dr = position_error(age), dv = velocity_error(s, speed, age);
    const Real c_error = 4 * distance * dr + 8 * u * (r2 + radius_sum * radius_sum);
    const Real b_error = 2 * speed * dr + 2 * distance * dv + 8 * u * speed * distance;
    if (b > b_error) return {};  // separating, overlapped or not
    if (c < -c_error) {
      if (b < -b_error) return {Verdict::contact, Real(0), Real(0)};
      return {Verdict::undecided};
    }
    const Real discriminant = b * b - v2 * c;
    const Real absolute_b = magnitude(b), absolute_c = magnitude(c);
    const Real error = 3 * absolute_b * b_error + b_error * b_error + 2 * v2 * c_error +
        4 * speed * dv * (absolute_c + c_error) + 8 * u * (b * b + v2 * absolute_c);
    if (discriminant < -error) return {};
    if (discriminant > error && b < -b_error) {
      const Real root = sqrt(discriminant);
      // Touching within rounding: the contact is now or after this delay.
      const Real delay = c <= 0 ? Real(0) : Real(c / (root - b));
      return {Verdict::contact, delay, time_error(s, delay, root, radius_sum, age)};
    }
    return {Verdict::undecided};
  }

  Vec3<Real> gravity_;
  DriveClock<Real> clock_;
  Real smallest_sum_, reach_;
  Real widest_, largest_sum_;  ///< bounds on the distance of two balls, the sum of their radii [m]
  Real gravity_size_;
  Real least_separation_;  ///< the smallest one of all laws [m/s]
  Real top_speed_{}, position_error_{}, tie_window_{};
  PairFilter<Real> filter_;
};

}  // namespace edmill::dynamics
