// Simulated time as whole drive periods and a remainder: its precision does not decrease.
#pragma once

#include <cmath>
#include <cstdint>
#include <type_traits>

#include "base/archive.hpp"

namespace edmill {

/// An instant: `period` whole drive periods, and `offset` [s] from 0 to below a period's length.
template <class Real> struct Instant {
  std::int64_t period = 0;
  Real offset{0};

  void archive(Archive& a) { a(period, offset); }

  friend bool operator<(const Instant& a, const Instant& b) {
    if constexpr (std::is_same_v<Real, double>)  // no branch, which could not be predicted
      return (a.period < b.period) | ((a.period == b.period) & (a.offset < b.offset));
    else
      return a.period != b.period ? a.period < b.period : a.offset < b.offset;
  }
  friend bool operator>(const Instant& a, const Instant& b) { return b < a; }
  friend bool operator<=(const Instant& a, const Instant& b) { return !(b < a); }
  friend bool operator>=(const Instant& a, const Instant& b) { return !(a < b); }
  friend bool operator==(const Instant& a, const Instant& b) = default;

  /// Later, and earlier, than every instant of a run.
  static Instant never() { return {std::int64_t{1} << 52, Real(0)}; }
  static Instant long_ago() { return {-(std::int64_t{1} << 52), Real(0)}; }
};

/// Arithmetic of instants for one drive period [s], which for a vessel at rest is a mere unit.
template <class Real> class DriveClock {
 public:
  explicit DriveClock(const Real& period) : period_(period) {}

  const Real& period() const { return period_; }

  Real elapsed(const Instant<Real>& from, const Instant<Real>& to) const {
    if (from.period == to.period) return to.offset - from.offset;
    return Real(to.period - from.period) * period_ + (to.offset - from.offset);
  }

  /// The instant at any `offset` [s] from the start of drive period `period`.
  Instant<Real> instant(std::int64_t period, Real offset) const {
    using std::floor;
    if (offset >= period_ || offset < 0) {
      const Real whole = floor(offset / period_);
      period += static_cast<std::int64_t>(whole);
      offset -= whole * period_;
      if (offset >= period_) {
        offset -= period_;
        ++period;
      } else if (offset < 0) {
        offset += period_;
        --period;
        if (offset >= period_) {  // a remainder below the resolution rounds up to a whole period
          offset = Real(0);
          ++period;
        }
      }
    }
    return {period, offset};
  }

  Instant<Real> after(const Instant<Real>& start, const Real& dt) const {
    return instant(start.period, start.offset + dt);
  }

  /// The instant at `time` [s] on the simulation clock, and the reverse.
  Instant<Real> at(const Real& time) const { return instant(0, time); }
  Real seconds(const Instant<Real>& t) const { return Real(t.period) * period_ + t.offset; }
 private:
  Real period_;
};

}  // namespace edmill
