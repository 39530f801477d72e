// When an output records. (thesis D.3.2)
#pragma once

#include <cstdint>
#include <optional>

#include "base/archive.hpp"
#include "casefile/output_spec.hpp"

namespace edmill::output {

/// Opens at the first of its starts that is met, closes at the first of its ends. Times are
/// inclusive.
template <class Real> class OutputTimer {
 public:
  /// @param run_start  initial time of the run [s]
  OutputTimer(const casefile::TimerSpec& spec, const Real& run_start)
      : on_(spec.on), start_collision_(spec.start_collision), collisions_(spec.collisions) {
    const auto seconds = [](const std::optional<casefile::Quantity>& q) {
      return q ? std::optional<Real>(q->to<Real>()) : std::nullopt;
    };
    start_time_ = seconds(spec.start_time);
    end_time_ = seconds(spec.end_time);
    duration_ = seconds(spec.duration);
    if (!start_time_ && !start_collision_) start_time_ = run_start;
    if (start_time_ && *start_time_ < run_start) start_time_ = run_start;
    if (!start_collision_)
      open(*start_time_);  // known at once: rows can be due before the first impact
  }

  /// True if an impact is recorded. Must be called once for each impact, in order.
  bool admits(const Real& time, std::uint64_t index) {
    if (!on_ || closed_) return false;
    if (!from_) {
      if (start_time_ && time >= *start_time_)
        open(*start_time_);
      else if (index >= *start_collision_)
        open(time);
    }
    if (!from_ || time < *from_) return false;
    if (until_ && time > *until_) {
      closed_ = true;
      return false;
    }
    if (collisions_ && ++recorded_ == *collisions_) {
      closed_ = true;
      until_ = time;
    }
    return true;
  }

  /// True if the start of the record is known.
  bool is_open() const { return from_.has_value(); }
  /// Start of the record [s]. @pre is_open()
  const Real& from() const { return *from_; }
  /// End of the record if the run continues to `run_end` [s].
  Real until(const Real& run_end) const { return until_ && *until_ < run_end ? *until_ : run_end; }
  /// True if the record has ended before or at `time`.
  bool ends_by(const Real& time) const { return until_ && *until_ <= time; }
  /// True if a run that ends at `run_end` has a record.
  bool recorded(const Real& run_end) const { return on_ && from_ && *from_ <= run_end; }

  void archive(Archive& a) { a(closed_, recorded_, from_, until_); }
 private:
  void open(const Real& time) {
    from_ = time;
    for (const auto& end :
        {end_time_, duration_ ? std::optional<Real>(time + *duration_) : std::nullopt})
      if (end && (!until_ || *end < *until_)) until_ = end;
  }

  bool on_, closed_ = false;
  std::optional<Real> start_time_, end_time_, duration_;
  std::optional<std::uint64_t> start_collision_, collisions_;
  std::uint64_t recorded_ = 0;
  std::optional<Real> from_, until_;  ///< of the record, where they are known
};

/// The ends of a record's intervals, one after the other.
template <class Real> class IntervalClock {
 public:
  explicit IntervalClock(const casefile::TimerSpec& spec)
      : interval_(spec.interval ? spec.interval->to<Real>() : Real(0)), rows_(spec.max_rows) {}

  /// Calls `row(begin, end)` for each interval that ends at `time` or before; the one that ends
  /// with the record stays open, since an impact at that very instant belongs to it.
  template <class Row> void pass(const OutputTimer<Real>& timer, const Real& time, Row&& row) {
    const Real& from = timer.from();
    for (;;) {
      const Real end = from + interval_ * Real(passed_ + 1);
      if (end > time || timer.ends_by(end) || full()) return;
      row(Real(from + interval_ * Real(passed_)), end);
      ++passed_;
    }
  }
  /// Calls `row` for the remaining intervals up to the end of the record. The last one may be
  /// shorter; one that exists only by rounding is omitted.
  template <class Row> void finish(const Real& from, const Real& until, Row&& row) {
    for (Real begin = from + interval_ * Real(passed_);
         until - begin > interval_ / 1000000000 && !full();
         begin = from + interval_ * Real(++passed_)) {
      const Real end = from + interval_ * Real(passed_ + 1);
      row(begin, end < until ? end : until);
    }
  }
  bool full() const { return rows_ && passed_ >= *rows_; }

  void archive(Archive& a) { a(passed_); }
 private:
  Real interval_;
  std::optional<std::uint64_t> rows_;
  std::uint64_t passed_ = 0;
};

}  // namespace edmill::output
