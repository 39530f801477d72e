// How late events are: evenly, as with time steps, or otherwise. docs/audit.md, "What a log looks like"
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>

namespace edmill::audit {

/// Delays in bins that become wider with them.
class Delays {
 public:
  void add(double delay) {
    if (!(width_ > 0) && delay > 0) width_ = delay / (bins / 2);
    while (width_ > 0 && !(delay < width_ * bins)) widen();
    ++numbers_[width_ > 0 ? static_cast<std::size_t>(delay / width_) : 0];
    ++count_;
  }

  std::uint64_t count() const { return count_; }
  /// That this share does not exceed [s].
  double quantile(double share) const {
    std::uint64_t below = 0;
    std::size_t k = 0;
    while (k < bins && static_cast<double>(below += numbers_[k]) < share * static_cast<double>(count_)) ++k;
    return width_ * static_cast<double>(k + 1);
  }
  /// Whether they are spread evenly from 0 to a step, by the test of Kolmogorov and Smirnov at 1 %; a tenth
  /// more for impacts that follow each other within a step.
  bool are_even(double step) const {
    double sum = 0, worst = 0;
    const double all = static_cast<double>(count_);
    for (std::size_t k = 0; k < bins; ++k) {
      sum += static_cast<double>(numbers_[k]);
      worst =
          std::max(worst, std::abs(sum / all - std::min(1.0, width_ * static_cast<double>(k + 1) / step)));
    }
    return worst <= 1.63 / std::sqrt(all) + 0.1;
  }

 private:
  static constexpr std::size_t bins = 512;
  void widen() {
    for (std::size_t k = 0; k < bins; ++k)
      numbers_[k] = 2 * k + 1 < bins ? numbers_[2 * k] + numbers_[2 * k + 1] : 0;
    width_ *= 2;
  }

  std::array<std::uint64_t, bins> numbers_{};
  std::uint64_t count_ = 0;
  double width_ = 0;  ///< of a bin [s]
};

/// Delays by what was touched. A finite step delays all alike; a wrong wall or ball only its own contacts.
class DelaysByPartner {
 public:
  void add(int partner, double delay) {
    all_.add(delay);
    by_partner_[partner].add(delay);
  }
  /// The step with which a code sees each contact at the first step after it; 0 for none.
  double step() const {
    constexpr std::uint64_t least = 20;
    if (all_.count() < least) return 0;
    const double step = all_.quantile(0.98) / 0.98;
    if (!(step > 0) || !all_.are_even(step)) return 0;
    for (const auto& [partner, own] : by_partner_)
      if (own.count() >= least && !own.are_even(step)) return 0;
    return step;
  }

 private:
  Delays all_;
  std::map<int, Delays> by_partner_;
};

}  // namespace edmill::audit
