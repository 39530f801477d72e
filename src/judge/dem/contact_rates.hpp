// Audits of contact logs, and dose rates, compared and extrapolated to no contact time. docs/dem.md
#pragma once

#include "base/statistics.hpp"
#include "casefile/build_case.hpp"
#include "compare/comparison.hpp"
#include "dem/contacts.hpp"

namespace edmill::dem {

using casefile::CaseSpec;
using compare::Verdict;
using numerics::Median, numerics::median_of;
using Mill = model::Mill<double>;

/// A dose rate with its interval, from batches of equal duration, which may be correlated.
class DoseRate {
 public:
  static constexpr std::size_t batches = 64;

  /// @param first, last  of the record [s]
  DoseRate(double first, double last)
      : first_(first), length_((last - first) / batches), rates_(batches) {}

  void add(double time, double dose) {
    const double place = (time - first_) / length_;
    if (place >= 0)
      rates_[static_cast<std::size_t>(std::min(place, batches - 1.0))] += dose / length_;
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
  /// With `within`, the ratio agrees if its interval lies inside the allowed range and differs if
  /// outside. Without it, it agrees if its interval contains 1 and its half-width is at most 5 %.
  Verdict verdict = Verdict::too_few;
};

/// @param options  A is a run or a log of impacts or contacts, B a log of contacts, or the reverse
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

struct Judged {
  std::string name;           ///< "restitution at walls"
  std::string unit = {};      ///< empty for numbers
  std::string equation = {};  ///< number of the equation in theory.md
  Median found = {};
  double expected = 0;
  double allowed = 0;     ///< tolerance beyond the interval, for finite contacts and time steps
  double dose_share = 0;  ///< share of the dose of the contacts that determine it
  double spread = 0;      ///< half of the interquartile range

  enum class Of { log, walls, balls } of = Of::log;
  bool is_part = false;         ///< for a part of the contacts: of one wall, or one kind of balls
  std::string not_judged = {};  ///< the reason, other than too few contacts, if it is not judged

  bool known() const { return not_judged.empty() && found.known(); }
  /// A value is open if too few contacts determine it, with more than this share of the dose.
  static constexpr double large_share = 0.05;
  bool is_open() const { return not_judged.empty() && !found.known() && dose_share > large_share; }
  bool agrees() const {
    return !known() || (found.low - allowed <= expected && expected <= found.high + allowed);
  }
};

/// A parameter of the case that explains where balls left their flights.
struct GeometryCause {
  std::string key;
  std::string text;  ///< "10.45 +- 0.01 mm, the case has 11 mm"
  double value = 0, half_width = 0, expected = 0;
  double left = 0;  ///< median distance from the walls with this value [m]
};

/// e_t, the fraction of the slip that a contact leaves, for a range of slip over approach speed.
struct SlipBin {
  double ratio = 0;  ///< median in the bin
  Median of_walls, of_balls;
};

struct ContactAudit {
  std::string case_name, log_name;
  ContactLogFacts facts;
  Verdict verdict = Verdict::too_few;
  ByClass<std::uint64_t> counts{};
  double magnitude = 0;  ///< sum of |dose| over all contacts [J]
  std::uint64_t missed_at_walls = 0, missed_between_balls = 0;
  std::vector<Judged> judged;
  std::vector<SlipBin> slips;
  double wall_distance = 0;  ///< median from the case's walls to where balls left their flights [m]
  double wall_resolution = 0;  ///< resolution of that distance by the frames [m]
  std::vector<GeometryCause> causes;
  double dose_rate = 0, dose_rate_half_width = 0;  ///< [W]
  bool interrupted = false;

  std::uint64_t jumps() const { return counts[static_cast<std::size_t>(ContactClass::jump)]; }
  bool wall_velocity_differs() const;
  bool walls_met() const { return wall_distance <= 2 * wall_resolution && causes.empty(); }
};

/// @throws InputError when the log cannot be read or is of other balls
ContactAudit audit_contacts(
    const CaseSpec& spec, const std::string& log, const std::atomic<bool>* interrupt);

std::string table(const ContactAudit& audit);
std::string to_json(const ContactAudit& audit);
std::string contact_audit_keys();
std::string to_junit(const ContactAudit& audit);

/// Finds how far from the walls balls leave their flights, and the numbers with which it vanishes.
/// @param contacts of single balls
void judge_places(const CaseSpec& spec, const std::vector<Contact>& contacts,
    const std::atomic<bool>* interrupt, ContactAudit& audit);

}  // namespace edmill::dem
