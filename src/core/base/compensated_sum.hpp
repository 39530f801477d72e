// A sum that does not lose small terms (Neumaier 1974).
#pragma once

#include "base/archive.hpp"

namespace edmill::numerics {

template <class Real>
class CompensatedSum {
 public:
  CompensatedSum& operator+=(const Real& term) {
    const Real next = sum_ + term;
    const Real size = sum_ < 0 ? Real(-sum_) : sum_, term_size = term < 0 ? Real(-term) : term;
    lost_ += size >= term_size ? Real((sum_ - next) + term) : Real((term - next) + sum_);
    sum_ = next;
    return *this;
  }
  Real value() const { return sum_ + lost_; }
  void archive(Archive& a) { a(sum_, lost_); }

 private:
  Real sum_{0}, lost_{0};
};

}  // namespace edmill::numerics
