// Logs without states: the case is run again with other values, from its own initial state, until its impacts
// are those of the log. docs/audit.md, "Causes"
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "audit/audit.hpp"
#include "identify/parameters.hpp"

namespace edmill::identify {

/// A value or a mistake with which a run follows a log.
struct Replayed {
  std::string mistake;  ///< or empty
  const Parameter* parameter = nullptr;
  double value = 0, half_width = 0;
  std::uint64_t follows = 0;  ///< impacts from the first on that are those of the log
  std::uint64_t of = 0;       ///< that could be followed before rounding has changed the order
};

struct ReplayResult {
  bool too_few = false;           ///< fewer than 20 impacts: nothing is said
  std::uint64_t without = 0;      ///< impacts that the case itself follows
  bool clean = false;             ///< as far as rounding lets it
  std::optional<Replayed> cause;  ///< the best with which nine tenths can be followed
};

/// The first impacts of the log and of runs of the case, from the case's initial state.
/// @param is_interrupted  asked between runs; yes ends the search
ReplayResult replay(const Assumptions& nominal, const std::vector<Parameter>& parameters,
                    const std::vector<Mistake>& mistakes, const audit::EventsAtHand& log,
                    const std::function<bool()>& is_interrupted);

}  // namespace edmill::identify
