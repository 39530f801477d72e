// Agreement of two runs of one case in two scalars.
#pragma once

#include <array>
#include <optional>

#include "base/statistics.hpp"
#include "run/event_source.hpp"

namespace edmill::run {

/// Decimal digits to which numbers agree that differ by so much: of their largest size, or decimals in SI
/// units where they are zero but for rounding. @return Agreement::most when there is no difference
double digits_of(const Number& difference, const Number& size);

/// Agreement of two sequences of events. Digits of a quantity are -log10 of the largest difference over the
/// largest magnitude of that quantity so far, so that values near zero do not count as disagreement.
class Agreement {
 public:
  /// Takes the next event of both runs. @return false, and takes nothing, when the bodies differ
  bool take(const Event& one, const Event& two);

  std::size_t events() const { return events_; }
  /// Number of balls involved, summed over the events: two where balls collide.
  std::size_t bodies() const { return bodies_; }
  /// @param quantity  of model::logged_quantities
  /// @return digits to which all events taken agree; `most` when no difference was seen.
  double digits(std::size_t quantity) const;
  double least_digits() const;
  static constexpr double most = 1e7;

  /// Digits lost per event, by least squares over the times of the events; none when there are fewer
  /// than ten with a difference.
  std::optional<double> digits_lost_per_event() const;

 private:
  std::size_t events_ = 0, bodies_ = 0;
  std::array<Number, model::logged_count> largest_difference_{}, largest_size_{};
  numerics::Line growth_;  ///< log10 of the differences in time
};

}  // namespace edmill::run
