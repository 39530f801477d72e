// Two collision logs compared, event by event and by statistics, with verdicts.
#pragma once

#include <numeric>

#include "logs/event_log.hpp"

namespace edmill::compare {

/// Batch k covers [from + k length, from + (k + 1) length). [s]
struct BatchTimes {
  double from = 0, length = 0;
  std::size_t count = 0;

  double until() const { return from + static_cast<double>(count) * length; }
};

/// Classes of a spectrum, 16 an octave. Values up to `floor`, noise around zero, share the first.
class SpectrumClasses {
 public:
  static constexpr std::size_t count = 1 + 16 * 48;
  explicit SpectrumClasses(double floor) : floor_(floor) {}
  std::size_t of(double value) const;
 private:
  double floor_;
};

/// Number of impacts by approach speed, on walls and between balls; milling dose by dose of the
/// impact, since mills have many impacts of negligible dose, whose number varies much.
enum Spectrum : std::size_t { wall_speeds, ball_speeds, doses };
inline constexpr std::size_t spectrum_count = 3;

/// Values of a quantity, one per batch or class.
using BatchValues = std::vector<double>;

struct Batch {
  std::vector<double> events;              ///< with each wall, and last between balls
  double approach_speed = 0;               ///< sum [m/s]
  double milling_dose = 0, wall_work = 0;  ///< [J]
  std::array<std::vector<double>, spectrum_count> spectra;

  explicit Batch(int walls = 0) : events(walls + 1) {
    spectra.fill(BatchValues(SpectrumClasses::count));
  }

  double all_events() const { return std::accumulate(events.begin(), events.end(), 0.0); }
};

using Batches = std::vector<Batch>;

/// Divides a log into batches, in a second pass. Memory does not depend on its length.
/// @param walls  number of walls, larger than every wall number in the log
Batches cut_into_batches(const std::filesystem::path& place, const BatchTimes& times, int walls,
    const SpectrumClasses& speed_classes, const SpectrumClasses& dose_classes);

/// Batch values whose plain mean is sum / number of the whole and whose scatter is that of this
/// ratio, to first order (the linearised ratio estimator). @pre the numbers are not all 0
BatchValues ratio_values(const BatchValues& sums, const BatchValues& numbers);

/// Largest distance of two distribution functions, with a permutation test over batches.
struct SpectrumTest {
  double distance = 0;     ///< Kolmogorov's, over the bounds of the classes
  double limit = 0;        ///< exceeded in 5 % of the permutations
  double probability = 1;  ///< of at least this distance when A and B are alike
};

/// Each of 9999 permutations swaps batch k of A and B, or not, at random for every k, with a fixed
/// seed. @pre as many batches in A as in B, and both spectra are not empty
SpectrumTest test_spectra(const Batches& a, const Batches& b, Spectrum spectrum);

using logs::LogScan, logs::OfEach;
using Event = model::ImpactRecord<double>;

/// Times [s] that a comparison is restricted to.
struct Limits {
  std::optional<double> from, until;
};

struct FirstDifference {
  Event a, b;
  std::string quantity;        ///< "partners" for different bodies, or the value that differs most
  double relative_difference;  ///< of that value; nan for partners
};

struct EventComparison {
  std::uint64_t agreeing = 0;  ///< events before the first difference
  double horizon = 0;          ///< time of the last of them in A [s]
  std::optional<FirstDifference>
      first;                        ///< nothing when the logs agree to the end of the shorter one
  std::uint64_t same_partners = 0;  ///< events before the bodies differ; at least `agreeing`
  OfEach<double> largest{};         ///< relative difference of each value up to the horizon
  /// Slope of log10 of the largest relative difference of an event over the events, by least
  /// squares from the first that is not 0 to the horizon [1/event]; needs ten such events.
  std::optional<double> digits_lost_per_event;

  bool agree_throughout() const { return !first && agreeing > 0; }
};

struct ComparisonOptions {
  std::filesystem::path a, b;  ///< folders of runs, or logs; A is the reference
  Limits limits;
  std::optional<double> batch;          ///< length [s]; default: a twentieth of the common time
  std::optional<double> tolerance;      ///< relative, for events; 1e-9 by default
  std::optional<std::uint64_t> events;  ///< number that must agree one by one
  std::optional<double> within;  ///< largest relative difference of dose rates of contact logs

  double event_tolerance() const { return tolerance.value_or(1e-9); }
};

using logs::Verdict;
std::string_view name_of(Verdict verdict);

struct Quantity {
  std::string name, unit;
  std::optional<double> a = {}, b = {};  ///< means over the common time; nothing for a spectrum
  std::optional<double> a_half_width = {}, b_half_width = {};  ///< of their 95 % intervals
  /// B - A with its 95 % interval; for a spectrum Kolmogorov's distance and its 5 % limit.
  std::optional<double> difference = {}, half_width = {};
  std::optional<double> probability = {};  ///< of it by chance, after Holm; nothing if not tested
  Verdict verdict = Verdict::not_compared;
  std::string reason = {};  ///< why it is not_compared

  bool is_spectrum() const { return difference && !a; }
};

struct Comparison {
  ComparisonOptions options;
  LogScan a, b;
  EventComparison events;
  std::optional<Verdict> events_verdict;  ///< when a number of events was required
  BatchTimes times;  ///< no batches when the logs have too little time in common
  std::vector<Quantity> quantities;
  Verdict verdict = Verdict::too_few;  ///< overall: agree, differ or too_few
};

/// Familywise error rate: probability of any false difference between equivalent runs.
inline constexpr double significance = 0.05;
inline constexpr std::size_t fewest_batches = 10, most_batches = 200;
/// A rate or a mean of fewer events per batch, in A and B together, is not tested.
inline constexpr double fewest_events_per_batch = 5;

/// @throws InputError with every problem of the two logs, or of the options for them
Comparison compare(const ComparisonOptions& options);

std::string table(const Comparison& comparison);

std::string to_json(const Comparison& comparison);
/// A table of the document's keys.
std::string comparison_keys();

struct JunitCase {
  std::string name;
  std::string problem = {};     ///< empty where there is none
  std::string not_judged = {};  ///< why it was skipped, if so
};

/// @param suite  "edmill audit of log.csv"
std::string junit_text(const std::string& suite, const std::vector<JunitCase>& cases);
/// A test case for the events, where they must agree, and for each quantity that is tested.
std::string to_junit(const Comparison& comparison);

}  // namespace edmill::compare
