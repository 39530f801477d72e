// Recognises inelastic collapse: infinitely many impacts of a ball in finite time.
#pragma once

#include <cstdint>
#include <vector>

#include "edmill/core/instant.hpp"
#include "edmill/core/memory.hpp"

namespace edmill::engine {

/// Follows each ball's recent impacts. A ball whose last `enough` impacts each came after a path shorter than
/// `smallest_path`, a length well above rounding, is in collapse. The accumulation time extrapolates the
/// first of these impacts, where rounding matters least: intervals with one partner shrink by the restitution
/// e, so the rest of them sums to dt e / (1 - e).
template <class Real>
class CollapseWatch {
 public:
  /// @param resting_path  the same for `resting`, of one size in every scalar [m]
  CollapseWatch(int balls, const Real& smallest_path, const Real& resting_path)
      : smallest_path_(smallest_path),
        resting_path_(resting_path),
        records_(balls, Record{Instant<Real>::long_ago(), -1, 0, 0, 0, false, Real(0)}) {}

  /// Asks memory for what is kept of a ball, which may lie in two lines.
  void fetch_record(int ball) const {
    const char* record = reinterpret_cast<const char*>(&records_[ball]);
    fetch(record);
    fetch(record + sizeof(Record) - 1);
  }

  /// Of the ball's latest impact of any kind.
  const Instant<Real>& last_impact(int ball) const { return records_[ball].last; }

  /// Time since the ball's latest impact [s]; `now` is the time of the next one.
  Real since_last(int ball, const Instant<Real>& now, const DriveClock<Real>& clock) const {
    return clock.elapsed(records_[ball].last, now);
  }

  /// Takes note of an impact. @param key identifies the partner, @return true when the ball is in collapse
  bool note(int ball, int key, const Instant<Real>& now, const Real& approach_speed, const Real& restitution,
            const DriveClock<Real>& clock) {
    Record& r = records_[ball];
    const Real interval = clock.elapsed(r.last, now);
    if (interval * approach_speed < smallest_path_) {
      if (r.burst == 0) {
        r.extrapolated = r.partner == key && restitution < 1;
        if (r.extrapolated) r.accumulation = clock.seconds(now) + interval * restitution / (1 - restitution);
      }
      if (r.partner != key) r.extrapolated = false;
      ++r.burst;
    } else {
      r.burst = 0;
    }
    r.rest = interval * approach_speed < resting_path_ ? r.rest + 1 : 0;
    r.stuck = interval > 0 ? 0 : r.stuck + 1;
    r.last = now;
    r.partner = key;
    return r.burst >= enough;
  }

  /// The ball's recent impacts came after paths so short that it is at rest for every purpose: with t_c,
  /// where friction at one wall takes the motion along the normal of another.
  bool resting(int ball) const { return records_[ball].rest >= enough; }

  /// Impacts of the ball without any time between them.
  bool stuck(int ball) const { return records_[ball].stuck >= 1000; }

  Real accumulation_time(int ball, const DriveClock<Real>& clock) const {
    const Record& r = records_[ball];
    return r.extrapolated ? r.accumulation : clock.seconds(r.last);
  }

  void archive(Archive& a) { a(records_); }

 private:
  static constexpr int enough = 8;
  struct Record {
    Instant<Real> last;
    int partner;
    int burst;
    int stuck;
    int rest;
    bool extrapolated;
    Real accumulation;

    void archive(Archive& a) { a(last, partner, burst, stuck, rest, extrapolated, accumulation); }
  };
  Real smallest_path_, resting_path_;
  LargeVector<Record> records_;
};

}  // namespace edmill::engine
