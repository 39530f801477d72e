#include "run/agreement.hpp"

#include <algorithm>
#include <cmath>

namespace edmill::run {

bool Agreement::take(const Event& one, const Event& two) {
  if (!one.same_bodies(two)) return false;
  for (std::size_t k = 0; k < model::logged_count; ++k) {
    const Number difference = abs(one[k] - two[k]), size = abs(two[k]);
    largest_difference_[k] = std::max(largest_difference_[k], difference);
    largest_size_[k] = std::max(largest_size_[k], size);
    if (k == model::time && difference > 0) {
      const double x = static_cast<double>(events_), y = static_cast<double>(log10(difference));
      ++n_;
      x_ += x;
      y_ += y;
      xx_ += x * x;
      xy_ += x * y;
    }
  }
  ++events_;
  bodies_ += one.with_wall ? 1 : 2;
  return true;
}

double digits_of(const Number& difference, const Number& size) {
  constexpr double zero = 1e-20;  // [SI]
  if (!(difference > 0)) return Agreement::most;
  return -static_cast<double>(log10(size > zero ? Number(difference / size) : difference));
}

double Agreement::digits(std::size_t quantity) const {
  return digits_of(largest_difference_[quantity], largest_size_[quantity]);
}

double Agreement::least_digits() const {
  double least = most;
  for (std::size_t k = 0; k < model::logged_count; ++k) least = std::min(least, digits(k));
  return least;
}

std::optional<double> Agreement::digits_lost_per_event() const {
  const double spread = n_ * xx_ - x_ * x_;
  if (n_ < 10 || !(spread > 0)) return std::nullopt;
  return (n_ * xy_ - x_ * y_) / spread;
}

}  // namespace edmill::run
