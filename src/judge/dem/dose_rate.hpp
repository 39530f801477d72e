// The dose rate of a record with its interval, from batches of equal duration.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/student.hpp"

namespace edmill::dem {

class DoseRate {
 public:
  static constexpr std::size_t batches = 24;

  /// @param first, last  of the record [s]
  DoseRate(double first, double last) : first_(first), length_((last - first) / batches), doses_(batches) {}

  void add(double time, double dose) {
    const double place = (time - first_) / length_;
    if (place >= 0) doses_[static_cast<std::size_t>(std::min(place, batches - 1.0))] += dose;
  }
  /// [W]
  double mean() const { return std::accumulate(doses_.begin(), doses_.end(), 0.0) / (length_ * batches); }
  /// Of the 95 % interval [W].
  double half_width() const {
    const double middle = mean();
    double squares = 0;
    for (const double dose : doses_) squares += (dose / length_ - middle) * (dose / length_ - middle);
    const double t = boost::math::quantile(numerics::Student(batches - 1), 0.975);
    return t * std::sqrt(squares / (batches * (batches - 1)));
  }

 private:
  double first_, length_;
  std::vector<double> doses_;
};

}  // namespace edmill::dem
