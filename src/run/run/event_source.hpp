// The events of a run in order, in a number type that represents the values of every scalar.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "base/scalar_list.hpp"
#include "casefile/case_spec.hpp"
#include "model/impact_record.hpp"

namespace edmill::run {

/// Represents a number of any scalar exactly.
#if defined(EDMILL_WITHOUT_MPFR)
using Number = mpfr_of<200>;
#else
using Number = mpfr;
#endif

/// One impact of a run. Of two balls the lower number comes first.
using Event = model::ImpactRecord<Number>;

/// A run that delivers its events on request.
class EventSource {
 public:
  virtual ~EventSource() = default;
  /// The next `count` events; fewer at the end or when interrupted. @throws UndecidedError
  virtual std::vector<Event> next(std::size_t count) = 0;
  /// Skips about `count` events. @return how many; 0 at the end @pre `next` was not called
  virtual std::size_t pass(std::size_t count) = 0;
  /// Whether the run has ended in inelastic collapse.
  virtual bool has_collapsed() const = 0;
  /// The simulated time reached so far [s].
  virtual double reached() const = 0;
  /// Positions, velocities and spins of all balls, ball by ball, at the time reached so far.
  virtual std::vector<Number> states() const = 0;
  /// Continues with fewer digits from the current states; no effect for scalars of fixed digits.
  virtual void continue_in(unsigned digits) = 0;
};

/// @param precision  name of the scalar, in which the balls are placed
/// @param to_end     whether the run ends where the case does; otherwise it continues on request
/// @param interrupt  ends it when it becomes true @throws InterruptedError at the start
std::unique_ptr<EventSource> make_source(const std::string& precision,
    const casefile::CaseSpec& spec, bool to_end, const std::atomic<bool>* interrupt = nullptr);
template <class Real>
std::unique_ptr<EventSource> make_source_in(
    const casefile::CaseSpec& spec, bool to_end, const std::atomic<bool>* interrupt);

}  // namespace edmill::run
