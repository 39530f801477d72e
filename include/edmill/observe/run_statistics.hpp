// Totals of a run from the start of statistics on.
#pragma once

#include <array>
#include <cstdint>

#include "edmill/engine/observer.hpp"
#include "edmill/model/vessel.hpp"
#include "edmill/numerics/compensated_sum.hpp"

namespace edmill::observe {

template <class Real>
class RunStatistics : public engine::Observer<Real> {
 public:
  struct Totals {
    std::uint64_t collisions = 0;
    std::uint64_t collapsing = 0;  ///< with e_n = 1 by the collapse rule
    std::uint64_t resting = 0;     ///< of these, at rest: with e_t = 1 too
    numerics::CompensatedSum<Real> milling_dose;
    numerics::CompensatedSum<Real> collapsing_dose;
    numerics::CompensatedSum<Real> wall_work;

    void archive(Archive& a) { a(collisions, collapsing, resting, milling_dose, collapsing_dose, wall_work); }
  };

  void on_impact(const engine::Impact<Real>& impact, engine::Simulation<Real>&) override {
    Totals& t = totals_[impact.with_wall ? impact.partner : model::ball_ball];
    ++t.collisions;
    t.milling_dose += impact.outcome.milling_dose;
    if (impact.with_wall) t.wall_work += impact.outcome.wall_work;
    if (impact.collapsing) {
      ++t.collapsing;
      t.resting += impact.resting;
      t.collapsing_dose += impact.outcome.milling_dose;
    }
  }

  void archive(Archive& a) override { a(totals_); }

  const std::array<Totals, model::partner_kinds>& by_partner() const { return totals_; }

  std::uint64_t collisions() const {
    std::uint64_t sum = 0;
    for (const auto& t : totals_) sum += t.collisions;
    return sum;
  }
  std::uint64_t collapsing() const {
    std::uint64_t sum = 0;
    for (const auto& t : totals_) sum += t.collapsing;
    return sum;
  }
  std::uint64_t resting() const {
    std::uint64_t sum = 0;
    for (const auto& t : totals_) sum += t.resting;
    return sum;
  }
  Real milling_dose() const { return sum(&Totals::milling_dose); }
  Real collapsing_dose() const { return sum(&Totals::collapsing_dose); }
  Real wall_work() const { return sum(&Totals::wall_work); }

 private:
  Real sum(numerics::CompensatedSum<Real> Totals::*part) const {
    numerics::CompensatedSum<Real> total;
    for (const auto& t : totals_) total += (t.*part).value();
    return total.value();
  }
  std::array<Totals, model::partner_kinds> totals_{};
};

}  // namespace edmill::observe
