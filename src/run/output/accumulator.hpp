// Running statistics of one variable.
#pragma once

#include <cstdint>
#include <optional>

#include "base/scalar.hpp"
#include "base/sums.hpp"
#include "casefile/output_spec.hpp"
#include "io/table.hpp"

namespace edmill::output {

using casefile::Statistic;

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

  /// Nothing where nothing defines the statistic, such as the average of nothing.
  /// @param duration  that the sum is spread over [s]
  /// @param whole     that the sum is a share of
  std::optional<Real> value(Statistic s, const Real& duration, const Real& whole) const {
    switch (s) {
      case Statistic::sum:
        return sum();
      case Statistic::average:
        return io::value_if(count_ > 0, [&] { return Real(sum() / Real(count_)); });
      case Statistic::minimum:
        return io::value_if(count_ > 0, [&] { return least_; });
      case Statistic::maximum:
        return io::value_if(count_ > 0, [&] { return largest_; });
      case Statistic::rate:
        return io::value_if(duration > 0, [&] { return Real(sum() / duration); });
      case Statistic::percentage:
        return io::value_if(whole != 0, [&] { return Real(100 * sum() / whole); });
    }
    return std::nullopt;
  }

 private:
  std::uint64_t count_ = 0;
  numerics::CompensatedSum<Real> sum_;
  Real least_{0}, largest_{0};
};

}  // namespace edmill::output
