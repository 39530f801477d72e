// Running statistics of one variable.
#pragma once

#include <cstdint>
#include <string>

#include "base/compensated_sum.hpp"
#include "base/scalar.hpp"
#include "output/titles.hpp"

namespace edmill::output {

template <class Real>
class Accumulator {
 public:
  void add(const Real& value) {
    if (count_ == 0 || value < least_) least_ = value;
    if (count_ == 0 || value > largest_) largest_ = value;
    sum_ += value;
    ++count_;
  }
  /// What was added to another one.
  void add(const Accumulator& other) {
    if (other.count_ == 0) return;
    if (count_ == 0 || other.least_ < least_) least_ = other.least_;
    if (count_ == 0 || other.largest_ > largest_) largest_ = other.largest_;
    sum_ += other.sum_.value();
    count_ += other.count_;
  }

  Real sum() const { return sum_.value(); }

  void archive(Archive& a) { a(count_, sum_, least_, largest_); }

  /// The statistic as text; empty where nothing defines it, such as the average of nothing.
  /// @param duration  that the sum is spread over [s]
  /// @param whole     that the sum is a share of
  std::string text(Statistic s, const Real& duration, const Real& whole) const {
    switch (s) {
      case Statistic::sum:
        return to_text<Real>(sum());
      case Statistic::average:
        return count_ == 0 ? "" : to_text<Real>(sum() / Real(count_));
      case Statistic::minimum:
        return count_ == 0 ? "" : to_text<Real>(least_);
      case Statistic::maximum:
        return count_ == 0 ? "" : to_text<Real>(largest_);
      case Statistic::rate:
        return duration > 0 ? to_text<Real>(sum() / duration) : "";
      case Statistic::percentage:
        return whole != 0 ? to_text<Real>(100 * sum() / whole) : "";
    }
    return "";
  }

 private:
  std::uint64_t count_ = 0;
  numerics::CompensatedSum<Real> sum_;
  Real least_{0}, largest_{0};
};

}  // namespace edmill::output
