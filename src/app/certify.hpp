// One case in more than one scalar: the events that are certain, and where two scalars diverge.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "casefile/case_spec.hpp"
#include "run/agreement.hpp"

namespace edmill::app {

struct CertifyOptions {
  std::string file;  ///< of the certified sequence; none when empty
  std::size_t collisions = 0;
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

/// Raises the precision until two successive scalars agree on the first events, in order and in the digits
/// required, and writes them with the evidence.
/// @param found  called with each pair of scalars
/// @throws InputError for a case that ends before
Certification certify(
    const casefile::CaseSpec& spec, const CertifyOptions& options,
    const std::function<void(const Evidence&)>& found = [](const auto&) {});

/// The events of a case in the scalar of this name.
std::unique_ptr<run::EventSource> source_in(const std::string& precision, const casefile::CaseSpec& spec,
                                            bool to_end);

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
