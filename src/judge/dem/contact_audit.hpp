// Contacts that last against the laws of a case: values, their intervals and what is expected. docs/dem.md
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "base/statistics.hpp"
#include "casefile/build_case.hpp"
#include "compare/comparison.hpp"
#include "dem/contacts.hpp"

namespace edmill::dem {

using numerics::Median, numerics::median_of;

/// One value of the code against that of the case.
struct Judged {
  std::string name;           ///< "restitution at walls"
  std::string unit = {};      ///< empty for numbers
  std::string equation = {};  ///< of theory.md that it belongs to
  Median found = {};
  double expected = 0;
  double allowed = 0;     ///< beyond the interval: what contacts of this duration do, and a time step
  double dose_share = 0;  ///< of the contacts that show it
  double spread = 0;      ///< half of the interquartile range

  enum class Of { log, walls, balls } of = Of::log;
  bool is_part = false;         ///< of the contacts of another value: of one wall, or one kind of balls
  std::string not_judged = {};  ///< why it is not, other than by too few contacts

  bool known() const { return not_judged.empty() && found.known(); }
  /// Too few contacts show it for a verdict, and they have more than this share of the dose.
  static constexpr double large_share = 0.05;
  bool is_open() const { return not_judged.empty() && !found.known() && dose_share > large_share; }
  bool agrees() const {
    return !known() || (found.low - allowed <= expected && expected <= found.high + allowed);
  }
};

/// A number of the case that explains where the walls were met.
struct GeometryCause {
  std::string key;
  std::string text;  ///< "10.45 +- 0.01 mm, the case has 11 mm"
  double value = 0, half_width = 0, expected = 0;
  double left = 0;  ///< median distance from the walls with it [m]
};

/// e_t, what a contact leaves of the slip, for a range of slip over approach.
struct SlipBin {
  double ratio = 0;  ///< median in the bin
  Median of_walls, of_balls;
};

struct ContactAudit {
  std::string case_name, log_name;
  ContactLogFacts facts;
  compare::Verdict verdict = compare::Verdict::too_few;
  ByClass<std::uint64_t> counts{};
  double magnitude = 0;  ///< sum of the doses of all contacts, each without its sign [J]
  std::uint64_t missed_at_walls = 0, missed_between_balls = 0;
  std::vector<Judged> judged;
  std::vector<SlipBin> slips;
  double wall_distance = 0;    ///< median from the walls of the case where balls left their flights [m]
  double wall_resolution = 0;  ///< what frames resolve of it [m]
  std::vector<GeometryCause> causes;
  double dose_rate = 0, dose_rate_half_width = 0;  ///< [W]
  bool interrupted = false;

  std::uint64_t jumps() const { return counts[static_cast<std::size_t>(ContactClass::jump)]; }
  bool wall_velocity_differs() const;
  /// Balls leave their flights at the walls of the case.
  bool walls_met() const { return wall_distance <= 2 * wall_resolution && causes.empty(); }
};

/// @throws InputError when the log cannot be read or is of other balls
ContactAudit audit_contacts(const casefile::CaseSpec& spec, const std::string& log,
                            const std::atomic<bool>* interrupt);

std::string table(const ContactAudit& audit);
std::string to_json(const ContactAudit& audit);
std::string contact_audit_keys();
/// JUnit's XML, a test case for each value.
std::string to_junit(const ContactAudit& audit);

/// Finds the distance from the walls at which balls leave their flights, and the numbers of mill and vessel
/// with which it vanishes, best first.
/// @param contacts  of single balls
void judge_places(const casefile::CaseSpec& spec, const std::vector<Contact>& contacts,
                  const std::atomic<bool>* interrupt, ContactAudit& audit);

}  // namespace edmill::dem
