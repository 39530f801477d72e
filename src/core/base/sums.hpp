// Compensated sums, and totals of batches for the interval of a mean.
#pragma once

#include <cstdint>
#include <vector>

#include "base/instant.hpp"
#include "base/scalar.hpp"

namespace edmill::numerics {

/// A sum that does not lose small terms (Neumaier 1974).
template <class Real> class CompensatedSum {
 public:
  CompensatedSum& operator+=(const Real& term) {
    const Real next = sum_ + term;
    lost_ += magnitude(sum_) >= magnitude(term) ? Real((sum_ - next) + term)
                                                : Real((term - next) + sum_);
    sum_ = next;
    return *this;
  }
  Real value() const { return sum_ + lost_; }
  void archive(Archive& a) { a(sum_, lost_); }
 private:
  Real sum_{0}, lost_{0};
};

/// Totals at the ends of batches of whole drive periods, which cover all phases of the drive.
/// Batches are merged in pairs so that from 64 periods on there are 64 to 127 complete ones.
template <class Real> class Batches {
 public:
  static constexpr std::size_t most = 128;

  void begin(const Instant<Real>& start) { start_ = start; }

  /// End of the open batch.
  Instant<Real> next() const {
    return {
        start_.period + periods_ * static_cast<std::int64_t>(totals_.size() + 1), start_.offset};
  }
  /// Ends the open batch. @param totals  of all quantities since the start
  void close(std::vector<double> totals) {
    totals_.push_back(std::move(totals));
    if (totals_.size() < most) return;
    for (std::size_t k = 0; k < most / 2; ++k) totals_[k] = std::move(totals_[2 * k + 1]);
    totals_.resize(most / 2);
    periods_ *= 2;
  }

  /// End of the open drive period.
  Instant<Real> next_period() const { return {start_.period + elapsed_ + 1, start_.offset}; }
  /// Must be called with the current totals before the first event at or after the end of a period.
  void pass(const Instant<Real>& time, const std::vector<double>& totals) {
    elapsed_ = time.period - start_.period - (time.offset < start_.offset ? 1 : 0);
    latest_ = totals;
    while (!(time < next())) close(totals);
  }
  /// Number of whole periods so far, and the total of a quantity over them. @pre at least one
  std::int64_t elapsed() const { return elapsed_; }
  double total(std::size_t quantity) const { return latest_.at(quantity); }

  std::size_t count() const { return totals_.size(); }
  /// Length of a batch in drive periods.
  std::int64_t periods() const { return periods_; }
  /// Amount of a quantity in each complete batch.
  std::vector<double> amounts(std::size_t quantity) const {
    std::vector<double> each;
    double before = 0;
    for (const auto& total : totals_) {
      each.push_back(total.at(quantity) - before);
      before = total.at(quantity);
    }
    return each;
  }

  void archive(Archive& a) { a(start_, periods_, totals_, elapsed_, latest_); }
 private:
  Instant<Real> start_;
  std::int64_t periods_ = 1;
  std::vector<std::vector<double>> totals_;  ///< at the end of each batch
  std::int64_t elapsed_ = 0;                 ///< whole periods
  std::vector<double> latest_;               ///< totals at the end of the last of them
};

}  // namespace edmill::numerics
