// How many digits a run needs to end with a given number of correct ones.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

#include "casefile/case_spec.hpp"
#include "run/agreement.hpp"

namespace edmill::app {

struct DigitsOptions {
  const std::atomic<bool>* interrupt = nullptr;
  /// Called now and then: what runs, how many events it has, and about how many it will have.
  std::function<void(const std::string& precision, std::size_t events, double expected)> progress =
      [](const auto&, auto, auto) {};
};

/// What a run will take, from short trials.
struct RunEstimate {
  std::string precision;         ///< of the run
  double events = 0;             ///< to its end
  double lost_per_event = 0;     ///< decimal digits
  double right_events = 0;       ///< of which all digits are used up; more than `events` where they last
  double seconds_per_event = 0;  ///< of processor time
  double verifying = 0;          ///< runs of the case that show the digits right, in times of the run
  double trials = 0;             ///< processor time that the trials took [s]
  std::uint64_t bytes = 0;       ///< of memory
  std::uint64_t digits = 0;      ///< that are asked for; 0 where a precision is
  std::string undecided;         ///< why no number of digits suffices, as far as the trials went
  bool outputs = false;          ///< of the case, whose time is not in here
  bool interrupted = false;

  double cpu_seconds() const { return events * seconds_per_event; }
  std::string text() const;
};

/// Short trials say how many digits the case loses per event, how many events it has, and what one costs.
/// @param precision  of the run; empty to find that which `spec.digits` needs
RunEstimate estimate_run(const casefile::CaseSpec& spec, const std::string& precision,
                         const DigitsOptions& options);

/// A precision in which a case has a given number of correct digits to its end.
struct FoundDigits {
  std::string precision;     ///< of the run; empty where there is none
  std::string narrow;        ///< that agrees with it
  run::Agreement agreement;  ///< of the events of both
  double states = 0;         ///< digits to which the states at the end agree
  double seconds = 0;        ///< that finding it took
  std::string undecided;     ///< why there is none
  bool interrupted = false;

  /// Digits that both runs have in common to the end.
  double left() const;
  /// Digits of the run that are right to its end, rounded down.
  std::uint64_t right() const;
  std::string text() const;
};

/// Estimates the digits needed, and runs the case to its end in them and in more, until both have all events
/// in common, with the digits that `spec.digits` asks for. @pre spec.digits
FoundDigits find_digits(const casefile::CaseSpec& spec, const DigitsOptions& options);

}  // namespace edmill::app
