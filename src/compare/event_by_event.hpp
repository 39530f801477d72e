// Two logs side by side: up to which event they agree.
#pragma once

#include "compare/log_reader.hpp"

namespace edmill::compare {

/// Times [s] that a comparison is restricted to.
struct Limits {
  std::optional<double> from, until;
};

struct FirstDifference {
  Event a, b;
  std::string quantity;  ///< "partners" for different bodies, or the name of the value that differs most
  double relative_difference;  ///< of that value; nan for partners
};

struct EventComparison {
  std::uint64_t agreeing = 0;            ///< events before the first difference
  double horizon = 0;                    ///< time of the last of them in A [s]
  std::optional<FirstDifference> first;  ///< nothing when the logs agree to the end of the shorter one
  std::uint64_t same_partners = 0;       ///< events before the bodies differ; at least `agreeing`
  OfEach<double> largest{};              ///< relative difference of each value up to the horizon
  /// Slope of log10 of the largest relative difference of an event over the events, by least squares from the
  /// first that is not 0 to the horizon [1/event]; needs ten such events.
  std::optional<double> digits_lost_per_event;

  bool agree_throughout() const { return !first && agreeing > 0; }
};

/// Compares the events of both logs in order. A value of an event is compared with the larger of itself in A
/// and the mean magnitude of its column in A.
/// @param tolerance  on the relative difference of every value that both logs have
/// @throws InputError when a log cannot be read
EventComparison compare_events(const std::filesystem::path& a, const std::filesystem::path& b,
                               const LogScan& scan_a, const LogScan& scan_b, const Limits& limits,
                               double tolerance);

}  // namespace edmill::compare
