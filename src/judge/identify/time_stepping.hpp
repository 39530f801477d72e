// Signs of time steps and of soft contacts in a log. docs/audit.md, "Codes with time steps"
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "audit/audit.hpp"

namespace edmill::identify {

/// When in a contact that lasts a log has its line.
enum class LoggedAt { begin, end };

struct SoftContacts {
  double duration;   ///< median [s]
  double low, high;  ///< quartiles [s]
  LoggedAt at;
  std::uint64_t contacts;  ///< that show it
  double exponent;         ///< of duration ~ approach speed^exponent: 0 for a linear spring, -1/5 for Hertz
  double spring;           ///< stiffness of a linear spring with this duration [N/m]
  double modulus;          ///< effective modulus E* of Hertz's contacts with this duration [Pa]
};

struct TimeStepping {
  std::optional<double> step;           ///< all times are multiples of it [s]
  std::optional<double> step_by_depth;  ///< from the overlaps: a contact is seen up to a step late [s]
  std::optional<SoftContacts> soft;
  std::optional<double>
      first_order_step;          ///< of an integrator of first order, from flights under gravity [s]
  std::optional<double> jitter;  ///< root mean square by which single times are off, early and late [s]
  bool second_order = false;     ///< flights under gravity show no error of first order

  bool found() const { return step || step_by_depth || soft || first_order_step || jitter; }
};

/// @param log  in the case's order of times
TimeStepping time_stepping(const audit::EventsAtHand& log, const model::Case<double>& the_case,
                           const audit::Options& options);

std::string table(const TimeStepping& found);

}  // namespace edmill::identify
