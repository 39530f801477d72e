// Parts of a log to which a cause may be restricted: one wall, one ball, one kind of partner, one branch of
// the law.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "audit/audit.hpp"
#include "model/case.hpp"

namespace edmill::identify {

/// Where a row of a fit stands.
struct RowPlace {
  std::size_t event = 0;  ///< place in the log
  int body = -1;          ///< 0 the event's ball, 1 its partner, -1 both
  bool of_flight = false;

  bool operator==(const RowPlace&) const = default;
};

/// The branches of the contact law that an impact took, by its states before.
struct Branches {
  bool known = false, sticks = false, at_least_separation = false;
};

struct Subset {
  std::string name;  ///< "at wall 0 (cap -y)", "on ball 3"
  std::function<bool(const RowPlace&)> holds;
  bool of_impacts = true, of_flights = true;  ///< what it can restrict
};
using SharedSubset = std::shared_ptr<const Subset>;

/// @param branches  by event; both must outlive the subsets
std::vector<SharedSubset> subsets_of(const model::Case<double>& the_case,
                                     const std::vector<audit::LoggedEvent>& events,
                                     const std::vector<Branches>& branches);

}  // namespace edmill::identify
