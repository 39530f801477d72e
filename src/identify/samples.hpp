// Which events of a log a fit takes: half of them such as violate something, half of them any, evenly over a
// span.
#pragma once

#include <cstddef>
#include <vector>

#include "audit/event_log.hpp"

namespace edmill::identify {

class Samples {
 public:
  using Places = std::vector<std::size_t>;

  /// @param events  at least one; they must outlive the samples
  /// @param period  of the drive [s]
  Samples(const std::vector<audit::LoggedEvent>& events, double period)
      : events_(&events), period_(period), violating_(events.size(), false) {}

  Places every() const;
  void note_violating(std::size_t event) { violating_[event] = true; }
  void forget_violating() { violating_.assign(violating_.size(), false); }
  /// Draws them again.
  void choose();

  const Places& few() const { return few_; }               ///< of the whole log
  const Places& whole() const { return windows_.back(); }  ///< the same, more
  const Places& many() const { return many_; }             ///< the same, for a last fit
  const Places& early() const { return windows_.front(); }
  /// Samples of growing spans, the last of the whole log: a motion's speed is fitted from the first on.
  const std::vector<Places>& windows() const { return windows_; }

 private:
  Places sample(double until, std::size_t most) const;

  const std::vector<audit::LoggedEvent>* events_;
  double period_;
  std::vector<bool> violating_;  ///< by event
  std::vector<Places> windows_;
  Places few_, many_;
};

}  // namespace edmill::identify
