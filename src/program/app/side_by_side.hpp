// One case in two scalars, event by event.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "casefile/case_spec.hpp"
#include "run/agreement.hpp"

namespace edmill::app {

inline bool stop_asked(const std::atomic<bool>* interrupt) {
  return interrupt && interrupt->load(std::memory_order_relaxed);
}

/// Two runs that advance together, each on a thread of its own. Where their digits are chosen, both keep as
/// many as the narrower one has right, by their agreement so far, and some more: the error that this adds to
/// it is small beside its own.
class SideBySide {
 public:
  /// @pre `wide` is wider than `narrow`
  /// @throws InterruptedError when `interrupt` becomes true at the start; later it ends both
  SideBySide(const casefile::CaseSpec& spec, const std::string& narrow, const std::string& wide, bool to_end,
             const std::atomic<bool>* interrupt = nullptr);

  /// Takes up to `count` further events of both.
  /// @return those of the wider run that have the same bodies in both; none when there are no more, or after
  /// an interrupt
  std::vector<run::Event> next(std::size_t count);

  const run::Agreement& agreement() const { return agreement_; }
  /// The first events that differ.
  const std::optional<std::pair<run::Event, run::Event>>& diverged() const { return diverged_; }
  /// One run has an event more before its end.
  bool uneven() const { return uneven_; }
  /// Digits that both have dropped since the start.
  unsigned dropped_digits() const { return dropped_; }
  /// Digits to which positions, velocities and spins agree now, each of the largest of its kind.
  double digits_of_states() const;

 private:
  void drop_lost_digits();

  const std::atomic<bool>* interrupt_;
  std::unique_ptr<run::EventSource> narrow_, wide_;
  std::array<unsigned, 2> digits_;  ///< of both at the start; 0 where they are fixed
  unsigned dropped_ = 0;
  run::Agreement agreement_;
  std::optional<std::pair<run::Event, run::Event>> diverged_;
  bool uneven_ = false;
};

}  // namespace edmill::app
