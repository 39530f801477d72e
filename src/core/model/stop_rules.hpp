// Stop rules: conditions besides the end time that end a run.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <tuple>
#include <utility>

#include "base/statistics.hpp"
#include "base/sums.hpp"
#include "base/vector.hpp"
#include "model/parts/parameter.hpp"

namespace edmill::model {

/// Ends a run after a number of impacts.
struct MaxCollisions {
  static constexpr Parameter key{
      "max_collisions", Dimension::none, "the run ends after this many impacts", Range::count};

  template <class Real> struct Watch {
    Real limit;

    bool is_met(const auto& impact, const auto&) const { return Real(impact.index + 1) >= limit; }
    void archive(Archive&) {}
  };
};

/// Ends a run at a milling dose since its start.
struct MaxMillingDose {
  static constexpr Parameter key{"max_milling_dose", Dimension::energy,
      "the run ends when this energy has been dissipated since it began", Range::positive};

  template <class Real> struct Watch {
    Real limit;  ///< [J]
    numerics::CompensatedSum<Real> dose{};

    bool is_met(const auto& impact, const auto&) {
      dose += impact.outcome.milling_dose;
      return dose.value() >= limit;
    }
    void archive(Archive& a) { a(dose); }
  };
};

/// Ends a run when a ball exceeds a speed just after an impact.
struct MaxBallSpeed {
  static constexpr Parameter key{"max_ball_speed", Dimension::speed,
      "the run ends when a ball is faster than this after an impact", Range::positive};

  template <class Real> struct Watch {
    Real limit;  ///< [m/s]

    bool is_met(const auto& impact, const auto& simulation) const {
      const auto too_fast = [&](int ball) {
        return squared_norm<Real>(simulation.flight(ball).velocity) > limit * limit;
      };
      return too_fast(impact.ball) || (!impact.with_wall && too_fast(impact.partner));
    }
    void archive(Archive&) {}
  };
};

/// Ends a run when the dose rate is known precisely enough.
struct DoseRatePrecision {
  static constexpr Parameter key{"dose_rate_precision", Dimension::none,
      "the run ends when the half-width of the 95 % interval of the dose rate is at most this "
      "fraction of "
      "the rate; first tested after 40 drive periods of statistics",
      Range(0.0001, 1)};

  /// Tests the interval only a few times, each after a time that the previous test predicts, so
  /// that a run does not end because its interval is narrow by chance. (docs/theory.md, section 8)
  template <class Real> struct Watch {
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
      const auto e = numerics::series_estimate(batches.amounts(0));
      const double wanted = static_cast<double>(limit) * *e.mean;
      if (*e.half_width <= wanted) return true;
      const double ratio = wanted > 0 ? *e.half_width / wanted : 2;
      next_look = static_cast<std::int64_t>(
          static_cast<double>(elapsed) * std::clamp(ratio * ratio, 1.2, 2.0));
      return false;
    }
  };
};

/// All stop rules. A rule has a key of [run], whose value is its limit and whose name is the end
/// reason, and a Watch: the limit in the run's scalar, `is_met(impact, simulation)`, called after
/// each impact, `archive` for its state, and `begin(case)` if it needs the case. To add a rule,
/// write a class above and list it here.
using StopRuleList = std::tuple<MaxCollisions, MaxMillingDose, MaxBallSpeed, DoseRatePrecision>;

inline constexpr std::size_t stop_rule_count = std::tuple_size_v<StopRuleList>;

/// Calls f(rule, its place in the list) for each.
constexpr void for_each_stop_rule(auto&& f) {
  [&]<std::size_t... place>(std::index_sequence<place...>) {
    (f(std::tuple_element_t<place, StopRuleList>{}, place), ...);
  }
  (std::make_index_sequence<stop_rule_count>{});
}

/// Limits in the order of the list; empty for rules that the case does not set.
template <class Number> using StopLimits = std::array<std::optional<Number>, stop_rule_count>;

/// The place of a rule in the list.
template <class Rule>
inline constexpr std::size_t place_of_rule = [] {
  std::size_t found = stop_rule_count;
  for_each_stop_rule([&]<class Each>(Each, std::size_t place) {
    if (std::is_same_v<Each, Rule>) found = place;
  });
  return found;
}();

}  // namespace edmill::model
