// Certainty of results: where runs in two scalars diverge and how far they agree, how many digits a
// run needs to end with a given number of correct ones, and events proven in ball arithmetic.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/statistics.hpp"
#include "casefile/case_spec.hpp"
#include "prove/proof.hpp"
#include "run/event_source.hpp"

namespace edmill::app {

/// Largest difference and largest magnitude of a quantity so far in two runs.
struct Largest {
  run::Number difference{}, size{};

  void take(const run::Number& one, const run::Number& two);
  /// Digits to which the runs agree: -log10 of the difference over the magnitude, so that values
  /// near zero do not count as disagreement; absolute in SI units if both are zero up to rounding.
  /// Agreement::most when there is no difference.
  double digits() const;
};

/// Agreement of two sequences of events.
class Agreement {
 public:
  /// Takes the next event of both runs. @return false, and takes nothing, when the bodies differ
  bool take(const run::Event& one, const run::Event& two);

  std::size_t events() const { return events_; }
  /// Number of balls involved, summed over the events: two where balls collide.
  std::size_t bodies() const { return bodies_; }
  /// Digits to which all events taken agree. @param quantity  of model::logged_quantities
  double digits(std::size_t quantity) const { return largest_[quantity].digits(); }
  double least_digits() const;
  static constexpr double most = 1e7;

  /// By least squares over the times of the events; none when fewer than ten have a difference.
  std::optional<double> digits_lost_per_event() const;
 private:
  std::size_t events_ = 0, bodies_ = 0;
  std::array<Largest, model::logged_count> largest_{};
  numerics::Line growth_;  ///< log10 of the differences in time
};

/// Two runs that advance together, each on its own thread. Scalars of variable digits drop
/// those that the narrower one has lost, except for a margin that keeps the added error small.
class SideBySide {
 public:
  /// @pre `wide` is wider than `narrow`
  /// @throws InterruptedError when `interrupt` becomes true at the start; later it ends both
  SideBySide(const casefile::CaseSpec& spec, const std::string& narrow, const std::string& wide,
      bool to_end, const std::atomic<bool>* interrupt = nullptr);

  /// Takes up to `count` further events of both. @return those of the wider run that have the same
  /// bodies in both; none when there are no more, or after an interrupt
  std::vector<run::Event> next(std::size_t count);

  const Agreement& agreement() const { return agreement_; }
  /// The first events that differ.
  const std::optional<std::pair<run::Event, run::Event>>& diverged() const { return diverged_; }
  /// True if one run has ended, but the other one has a further event.
  bool uneven() const { return uneven_; }
  /// Digits that both have dropped since the start.
  unsigned dropped_digits() const { return dropped_; }
  /// Digits to which positions, velocities and spins agree now, relative to the largest of a kind.
  double digits_of_states() const;
 private:
  void drop_lost_digits();

  const std::atomic<bool>* interrupt_;
  std::array<unsigned, 2> digits_;  ///< of both at the start; 0 where they are fixed
  std::array<std::unique_ptr<run::EventSource>, 2> sources_;
  unsigned dropped_ = 0;
  Agreement agreement_;
  std::optional<std::pair<run::Event, run::Event>> diverged_;
  bool uneven_ = false;
};

/// How far the first events agree in two scalars, the narrower first.
struct Evidence {
  std::string narrow{}, wide{};  ///< names of the scalars
  Agreement agreement{};
  double seconds = 0;  ///< duration of both runs [s]

  /// "double and float128: 40 events in common; digits: time 12.3 ..."
  std::string text() const;
};

struct CertifyOptions {
  std::string file;            ///< of the certified sequence; none when empty
  std::size_t collisions = 0;  ///< all up to the case's end time when 0
  int digits = 25;
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(const std::string& precision, std::size_t events)> progress = [](const auto&,
                                                                                       auto) {};
  std::function<void(const Evidence&)> found = [](const auto&) {};  ///< of a pair of scalars
};

struct Certification {
  std::vector<Evidence> evidence{};  ///< the narrowest first
  std::vector<run::Event> events{};  ///< the certain events; empty if there are none
  std::string undecided{};           ///< why nothing is certain; empty otherwise
  bool interrupted = false;
};

/// Raises the precision, at last by those digits that were lost so far, until two scalars agree on
/// the first events in the digits required, and writes them with the evidence.
/// @throws InputError for a case that ends before the required number of events, or has no end
Certification certify(const casefile::CaseSpec& spec, const CertifyOptions& options);

/// Two runs of a case side by side.
struct Shadow : Evidence {
  std::optional<std::pair<run::Event, run::Event>> diverged{};  ///< the first events that differ
  bool uneven = false;  ///< one has an event more before the end
  bool interrupted = false;
  std::size_t balls = 0;

  /// Where they diverge, in which quantities, and how fast digits are lost.
  std::string text() const;
};

/// @throws InputError when `wider` is not wider. @param what  asks for it: "option '--shadow'"
void require_wider(const std::string& precision, const std::string& wider, const std::string& what);

/// Runs the case in both scalars to its end. @pre `wider` is wider than `precision`
Shadow shadow(const casefile::CaseSpec& spec, const std::string& precision,
    const std::string& wider, const std::atomic<bool>* interrupt);

struct DigitsOptions {
  const std::atomic<bool>* interrupt = nullptr;
  /// Called now and then: what runs, its number of events, and about how many it will have.
  std::function<void(const std::string& precision, std::size_t events, double expected)> progress =
      [](const auto&, auto, auto) {};
};

/// Cost of a run, estimated by short trials.
struct RunEstimate {
  std::string precision{};    ///< of the run
  double events = 0;          ///< to its end
  double lost_per_event = 0;  ///< decimal digits
  double right_events = 0;    ///< after which no digit is left; more than `events` if they suffice
  double seconds_per_event = 0;  ///< of processor time
  double verifying = 0;          ///< cost of the runs that verify the digits, relative to the run
  double trials = 0;             ///< processor time that the trials took [s]
  std::uint64_t bytes = 0;       ///< of memory
  std::uint64_t digits = 0;      ///< required at the end; 0 if a precision is given
  std::string undecided{};       ///< why no number of digits suffices, as far as the trials went
  bool outputs = false;          ///< true if the case has outputs, whose time is not included
  bool interrupted = false;

  double cpu_seconds() const { return events * seconds_per_event; }
  std::string text() const;
};

/// Estimates by short trials the events of a case, the digits lost per event, and the cost.
/// @param precision  of the run; empty to find the one that `spec.digits` requires
RunEstimate estimate_run(
    const casefile::CaseSpec& spec, const std::string& precision, const DigitsOptions& options);

/// A precision in which a case has a given number of correct digits to its end.
struct FoundDigits {
  std::string precision{};  ///< of the run; empty where there is none
  std::string narrow{};     ///< narrower one that agrees with it
  Agreement agreement{};    ///< of the events of both
  double states = 0;        ///< digits to which the states at the end agree
  double seconds = 0;       ///< that finding it took
  std::string undecided{};  ///< why there is none
  bool interrupted = false;

  /// Digits that both runs have in common to the end.
  double left() const { return std::min(agreement.least_digits(), states); }
  /// Digits of the run that are right to its end, rounded down.
  std::uint64_t right() const;
  std::string text() const;
};

/// Estimates the digits needed, and runs the case to its end with that number and a larger one;
/// with more, until both agree on all events to `spec.digits` digits. @pre spec.digits
FoundDigits find_digits(const casefile::CaseSpec& spec, const DigitsOptions& options);

struct ProveOptions : prove::ProofOptions {
  std::string file, certificate;  ///< of the events and of the certificate; none when empty
};

/// Nothing is written where the events cannot be proven, or the proof is interrupted.
prove::Proof prove(const casefile::CaseSpec& spec, const ProveOptions& options);

/// Number of leading events of a proof that a run in this scalar reproduces.
std::size_t right_events(
    const std::string& precision, const casefile::CaseSpec& spec, const prove::Proof& proof);

/// Differences between a certificate's header and the case, a line each. @throws InputError
std::vector<std::string> check_certificate(
    const casefile::CaseSpec& spec, const std::string& certificate);

}  // namespace edmill::app
