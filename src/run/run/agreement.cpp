#include "run/agreement.hpp"

#include <algorithm>

namespace edmill::run {

bool Agreement::take(const Event& one, const Event& two) {
  if (!one.same_bodies(two)) return false;
  for (std::size_t k = 0; k < model::logged_count; ++k) {
    const Number difference = abs(one[k] - two[k]), size = abs(two[k]);
    largest_difference_[k] = std::max(largest_difference_[k], difference);
    largest_size_[k] = std::max(largest_size_[k], size);
    if (k == model::time && difference > 0)
      growth_.add(static_cast<double>(events_), static_cast<double>(log10(difference)));
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
  return growth_.points() < 10 ? std::nullopt : std::optional(growth_.slope());
}

}  // namespace edmill::run
