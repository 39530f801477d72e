// Dose rates of contact logs: compared with a run of edmill or with another contact log, and extrapolated to
// zero contact time from runs of one deck with several contact times.
#pragma once

#include <algorithm>

#include "base/statistics.hpp"
#include "compare/comparison.hpp"

namespace edmill::dem {

using compare::Verdict;

/// A dose rate with its interval, from batches of equal duration, which may be correlated.
class DoseRate {
 public:
  static constexpr std::size_t batches = 64;

  /// @param first, last  of the record [s]
  DoseRate(double first, double last) : first_(first), length_((last - first) / batches), rates_(batches) {}

  void add(double time, double dose) {
    const double place = (time - first_) / length_;
    if (place >= 0) rates_[static_cast<std::size_t>(std::min(place, batches - 1.0))] += dose / length_;
  }
  /// [W]
  numerics::Estimate estimate() const { return numerics::series_estimate(rates_); }

 private:
  double first_, length_;
  std::vector<double> rates_;
};

struct ContactRates {
  std::string log;
  double first = 0, last = 0;            ///< ends of the time that is evaluated [s]
  double dose_rate = 0, half_width = 0;  ///< [W]; by the balance of energy, groups included
  double contact_time = 0;               ///< median of single contacts with walls [s]; 0 of impacts
  double single_rate = 0;                ///< single contacts per second
  double grouped = 0;                    ///< share of groups and lasting contacts in the dose
};

struct ContactComparison {
  ContactRates a = {}, b = {};
  std::optional<double> within = {};  ///< largest allowed |ratio - 1|, if required
  double ratio = 1, half_width = 0;   ///< of B's dose rate over A's
  /// With `within`, the ratio agrees if its interval lies inside the allowed range and differs if outside.
  /// Without it, it agrees if its interval contains 1 and its half-width is at most 5 %.
  Verdict verdict = Verdict::too_few;
};

/// @param options  A is a run or a log of collisions or contacts, B a log of contacts, or the reverse
/// @throws InputError
ContactComparison compare_contacts(const compare::ComparisonOptions& options);

std::string table(const ContactComparison& comparison);
std::string to_json(const ContactComparison& comparison);
std::string contact_comparison_keys();
std::string to_junit(const ContactComparison& comparison);

struct Limit {
  std::vector<ContactRates> points;
  ContactRates at_zero{.log = "limit, by a weighted line"};  ///< of contacts of zero duration
  double slope = 0;                                          ///< [W/s]
  std::optional<ContactComparison> to_edmill;                ///< of the limit, B, with a run, A
};

/// @param logs  of contacts, two or more of different contact times
/// @param run   folder of a run of edmill, or its collision log; none when empty
/// @param from    time from which on both count [s]
/// @param within  largest difference of the limit from that run, relative
/// @throws InputError when a log cannot be read, or contact times do not differ
Limit limit_of(const std::vector<std::string>& logs, const std::string& run, double from,
               std::optional<double> within = {});

std::string table(const Limit& limit);
std::string to_json(const Limit& limit);
std::string limit_keys();

}  // namespace edmill::dem
