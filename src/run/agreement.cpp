#include "run/agreement.hpp"

#include <algorithm>
#include <cmath>

namespace edmill::run {

const char* name_of(Quantity quantity) {
  constexpr const char* names[] = {"time", "approach_speed", "slip_speed", "milling_dose", "wall_work"};
  return names[quantity];
}

const char* unit_of(Quantity quantity) {
  constexpr const char* units[] = {"s", "m/s", "m/s", "J", "J"};
  return units[quantity];
}

bool Agreement::take(const Event& one, const Event& two) {
  if (!one.same_bodies(two)) return false;
  for (int k = 0; k < quantity_count; ++k) {
    const Number difference = abs(one.values[k] - two.values[k]), size = abs(two.values[k]);
    largest_difference_[k] = std::max(largest_difference_[k], difference);
    largest_size_[k] = std::max(largest_size_[k], size);
    if (k == time && difference > 0) {
      const double x = static_cast<double>(events_), y = static_cast<double>(log10(difference));
      ++n_, x_ += x, y_ += y, xx_ += x * x, xy_ += x * y;
    }
  }
  ++events_;
  bodies_ += one.with_wall ? 1 : 2;
  return true;
}

double Agreement::digits(Quantity quantity) const {
  if (!(largest_difference_[quantity] > 0)) return most;
  return -static_cast<double>(log10(largest_difference_[quantity] / largest_size_[quantity]));
}

double Agreement::least_digits() const {
  double least = most;
  for (int k = 0; k < quantity_count; ++k) least = std::min(least, digits(static_cast<Quantity>(k)));
  return least;
}

std::optional<double> Agreement::digits_lost_per_event() const {
  const double spread = n_ * xx_ - x_ * x_;
  if (n_ < 10 || !(spread > 0)) return std::nullopt;
  return (n_ * xy_ - x_ * y_) / spread;
}

}  // namespace edmill::run
