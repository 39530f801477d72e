// One case in more than one scalar: the events that are certain, and where two scalars diverge.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/side_by_side.hpp"
#include "casefile/case_spec.hpp"
#include "run/agreement.hpp"

namespace edmill::app {

struct CertifyOptions {
  std::string file;            ///< of the certified sequence; none when empty
  std::size_t collisions = 0;  ///< all up to the case's end time when 0
  int digits = 25;
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(const std::string& precision, std::size_t events)> progress = [](const auto&, auto) {};
};

/// How far the first events agree in two scalars.
struct Evidence {
  std::string narrow, wide;  ///< names of the scalars
  run::Agreement agreement;
  double seconds = 0;  ///< that both took

  /// "double and float128: 40 events in common; digits: time 12.3 ..."
  std::string text() const;
};

struct Certification {
  std::vector<Evidence> evidence;  ///< the narrowest first
  std::vector<run::Event> events;  ///< what is certain; empty where it is not
  std::string undecided;           ///< why nothing is certain; empty otherwise
  bool interrupted = false;
};

/// Raises the precision until two scalars agree on the first events, in order and in the digits required, and
/// writes them with the evidence: those of a fixed number of digits first, then `mpfr` with as many as the
/// digits that were lost lead to expect.
/// @param found  called with each pair of scalars
/// @throws InputError for a case that ends before, or has no end
Certification certify(
    const casefile::CaseSpec& spec, const CertifyOptions& options,
    const std::function<void(const Evidence&)>& found = [](const auto&) {});

/// Digits of the wider run that judges one of so many.
unsigned wider_than(unsigned digits);

/// Two runs of a case side by side.
struct Shadow {
  std::string narrow, wide;  ///< names of the scalars
  run::Agreement agreement;
  std::optional<std::pair<run::Event, run::Event>> diverged;  ///< the first events that differ
  bool uneven = false;                                        ///< one has an event more before the end
  bool interrupted = false;
  std::size_t balls = 0;

  /// Where the runs diverge: event, time, quantities, and how fast digits are lost.
  std::string text() const;
};

/// @param what  asks for the wider one, for the message: "option '--shadow'"
/// @throws InputError when `wider` is not wider than `precision`
void require_wider(const std::string& precision, const std::string& wider, const std::string& what);

/// Runs the case in both scalars to its end. @pre `wider` is wider than `precision`
Shadow shadow(const casefile::CaseSpec& spec, const std::string& precision, const std::string& wider,
              const std::atomic<bool>* interrupt);

}  // namespace edmill::app
