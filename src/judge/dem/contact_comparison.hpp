// A log of contacts beside a run of edmill, or beside another log of contacts.
#pragma once

#include <cmath>
#include <string>
#include <vector>

namespace edmill::dem {

/// Rates of one record with their 95 % intervals.
struct ContactRates {
  std::string log;
  double first = 0, last = 0;  ///< of what counts [s]
  double dose_rate = 0,
         dose_rate_half_width = 0;  ///< [W]; of contacts by the balance of energy, groups included
  double contact_time = 0;          ///< [s]; 0 of impacts
  double single_rate = 0;           ///< single contacts per second
  double grouped = 0;               ///< share of the dose that groups and lasting contacts have
};

struct ContactComparison {
  ContactRates a, b;
  double difference = 0, half_width = 0;  ///< of dose rates, relative to A
  bool known = false;                     ///< enough of both records to judge

  bool agree() const { return std::abs(difference) <= half_width; }
};

/// @param a  reference: folder of a run, a collision log, or a log of contacts
/// @param b  a log of contacts
/// @throws InputError
ContactComparison compare_contacts(const std::string& a, const std::string& b, double from, double until);

std::string table(const ContactComparison& comparison);
std::string to_json(const ContactComparison& comparison);
std::string to_junit(const ContactComparison& comparison);

}  // namespace edmill::dem
