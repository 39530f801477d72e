// A dose rate that is known well enough.
#pragma once

#include <algorithm>

#include "base/batches.hpp"
#include "base/compensated_sum.hpp"
#include "base/statistics.hpp"
#include "model/parts/parameter.hpp"

namespace edmill::model {

struct DoseRatePrecision {
  static constexpr Parameter key{"dose_rate_precision", Dimension::none,
                                 "the run ends when the half-width of the 95 % interval of the dose rate is "
                                 "this part of it; tried first after 40 drive periods of statistics",
                                 Range(0.0001, 1)};

  /// Few looks at the interval, each after a time that the one before predicts, so that a run does not end
  /// because its interval is narrow by chance. (docs/theory.md, section 8)
  template <class Real>
  struct Watch {
    Real limit;
    numerics::Batches<Real> batches{};
    numerics::CompensatedSum<Real> dose{};
    Instant<Real> start{};
    std::int64_t next_look = 40;  ///< in drive periods since the start of statistics

    void begin(const auto& the_case) {
      start = the_case.statistics_start < the_case.initial_time ? the_case.initial_time
                                                                : the_case.statistics_start;
      batches.begin(start);
    }
    bool is_met(const auto& impact, const auto&) {
      if (impact.time < start) return false;
      bool met = false;
      while (!met && !(impact.time < batches.next())) {
        batches.close({static_cast<double>(dose.value())});
        met = is_precise();
      }
      dose += impact.outcome.milling_dose;
      return met;
    }
    void archive(Archive& a) { a(batches, dose, next_look); }

   private:
    bool is_precise() {
      const auto elapsed = static_cast<std::int64_t>(batches.count()) * batches.periods();
      if (elapsed < next_look) return false;
      const auto e = numerics::estimate(batches.amounts(0));
      const double wanted = static_cast<double>(limit) * *e.mean;
      if (*e.half_width <= wanted) return true;
      const double ratio = wanted > 0 ? *e.half_width / wanted : 2;
      next_look =
          static_cast<std::int64_t>(static_cast<double>(elapsed) * std::clamp(ratio * ratio, 1.2, 2.0));
      return false;
    }
  };
};

}  // namespace edmill::model
