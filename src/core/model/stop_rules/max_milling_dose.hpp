// A milling dose since the start of the run.
#pragma once

#include "base/archive.hpp"
#include "base/compensated_sum.hpp"
#include "model/parts/parameter.hpp"

namespace edmill::model {

struct MaxMillingDose {
  static constexpr Parameter key{"max_milling_dose", Dimension::energy,
                                 "the run ends when this much has been dissipated since it began",
                                 Range::positive};

  template <class Real>
  struct Watch {
    Real limit;  ///< [J]
    numerics::CompensatedSum<Real> dose{};

    bool is_met(const auto& impact, const auto&) {
      dose += impact.outcome.milling_dose;
      return dose.value() >= limit;
    }
    void archive(Archive& a) { a(dose); }
  };
};

}  // namespace edmill::model
