// The figure of a claim: printed on one line, and held against its bound.
#pragma once

#include <gtest/gtest.h>

#include <iostream>
#include <sstream>
#include <string>

#include "base/scalar_list.hpp"

namespace edmill::verification {

/// Wider than every scalar under test.
using exact = boost::multiprecision::number<
    boost::multiprecision::mpfr_float_backend<100, boost::multiprecision::allocate_stack>,
    boost::multiprecision::et_off>;

/// The claim a program belongs to, e.g. "03 bouncing ball".
class Claim {
 public:
  explicit Claim(std::string name) : name_(std::move(name)) {}

  /// A figure that must not exceed its bound; one that is no number fails.
  template <class Real>
  void at_most(const std::string& figure, const Real& value, double bound,
      const std::string& unit = "") const {
    const double v = static_cast<double>(value);
    say(figure + " " + text(v) + unit + " (bound " + text(bound) + unit + ")");
    EXPECT_TRUE(v <= bound) << figure;
  }
  /// A figure that must be at least its bound.
  template <class Real>
  void at_least(const std::string& figure, const Real& value, double bound,
      const std::string& unit = "") const {
    const double v = static_cast<double>(value);
    say(figure + " " + text(v) + unit + " (at least " + text(bound) + unit + ")");
    EXPECT_TRUE(v >= bound) << figure;
  }
  void say(const std::string& line) const {
    std::cout << "claim " << name_ << ": " << line << "\n";
  }

  static std::string text(double v, int digits = 3) {
    std::ostringstream out;
    out.precision(digits);
    out << v;
    return out.str();
  }
 private:
  std::string name_;
};

/// Keeps the largest; what is no number stays.
template <class Real> void raise(Real& largest, const Real& value) {
  if (!(value <= largest) && largest == largest) largest = value;
}

}  // namespace edmill::verification
