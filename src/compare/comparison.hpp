// Two collision logs compared: event by event, then by statistics, with a verdict for each quantity.
#pragma once

#include "compare/batches.hpp"
#include "compare/event_by_event.hpp"

namespace edmill::compare {

struct Options {
  std::filesystem::path a, b;  ///< folders of runs, or logs; A is the reference
  Limits limits;
  std::optional<double> batch;          ///< length [s]; a twentieth of the common time unless given
  double tolerance = 1e-9;              ///< relative, for events
  std::optional<std::uint64_t> events;  ///< that must agree one by one
};

enum class Verdict { agree, differ, too_few, not_compared };
std::string_view name_of(Verdict verdict);

struct Quantity {
  std::string name, unit;
  std::optional<double> a, b;                        ///< means over the common time; nothing for a spectrum
  std::optional<double> a_half_width, b_half_width;  ///< of the 95 % intervals of the means
  /// B - A and its 95 % interval; for a spectrum Kolmogorov's distance, and what 5 % of permutations exceed.
  std::optional<double> difference, half_width;
  std::optional<double> probability;  ///< of such a difference by chance, after Holm; nothing if not tested
  Verdict verdict = Verdict::not_compared;
  std::string reason;  ///< of not_compared
};

struct Comparison {
  Options options;
  LogScan a, b;
  EventComparison events;
  std::optional<Verdict> events_verdict;  ///< when a number of events was required
  BatchTimes times;                       ///< no batches when the logs have too little time in common
  std::vector<Quantity> quantities;
  Verdict verdict = Verdict::too_few;  ///< of everything: agree, differ or too_few
};

/// Familywise error rate: probability of any false difference between equivalent runs.
inline constexpr double significance = 0.05;
inline constexpr std::size_t fewest_batches = 10, most_batches = 200;
/// A rate or a mean of fewer events per batch, in A and B together, is not tested.
inline constexpr double fewest_events_per_batch = 5;

/// @throws InputError with every problem of the two logs, or of the options for them
Comparison compare(const Options& options);

/// The result as text.
std::string table(const Comparison& comparison);

/// docs/files.md, "comparison".
std::string to_json(const Comparison& comparison);

/// JUnit's XML: a test case for the events, where they must agree, and for each quantity that is tested.
std::string to_junit(const Comparison& comparison);

}  // namespace edmill::compare
