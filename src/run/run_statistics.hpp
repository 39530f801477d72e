// Totals of a run since the start of statistics.
#pragma once

#include <cstdint>
#include <vector>

#include "base/compensated_sum.hpp"
#include "engine/observer.hpp"
#include "model/parts/partners.hpp"

namespace edmill::run {

template <class Real>
class RunStatistics : public engine::Observer<Real> {
 public:
  struct Totals {
    std::uint64_t collisions = 0;
    std::uint64_t touched = 0;   ///< by the least separation speed
    std::uint64_t in_stall = 0;  ///< friction rested
    numerics::CompensatedSum<Real> milling_dose;
    numerics::CompensatedSum<Real> touched_dose, stall_dose;
    numerics::CompensatedSum<Real> supplied_energy;
    numerics::CompensatedSum<Real> wall_work;

    void archive(Archive& a) {
      a(collisions, touched, in_stall, milling_dose, touched_dose, stall_dose, supplied_energy, wall_work);
    }
  };

  explicit RunStatistics(const model::Partners& partners) : totals_(partners.count()) {}

  void on_impact(const engine::Impact<Real>& impact, engine::Simulation<Real>&) override {
    Totals& t = impact.with_wall ? totals_[impact.partner] : totals_.back();
    const auto& outcome = impact.outcome;
    ++t.collisions;
    t.milling_dose += outcome.milling_dose;
    if (impact.with_wall) t.wall_work += outcome.wall_work;
    if (outcome.least_separation) {
      ++t.touched;
      t.touched_dose += outcome.milling_dose;
      t.supplied_energy += outcome.supplied_energy;
    }
    if (outcome.in_stall) {
      ++t.in_stall;
      t.stall_dose += outcome.milling_dose;
    }
  }

  void archive(Archive& a) override { a(totals_); }

  /// By the partners' places.
  const std::vector<Totals>& by_partner() const { return totals_; }

  std::uint64_t collisions() const { return count(&Totals::collisions); }
  /// Impacts that separate at the least separation speed.
  std::uint64_t touched() const { return count(&Totals::touched); }
  Real milling_dose() const { return sum(&Totals::milling_dose); }
  /// Dose of those impacts [J].
  Real touched_dose() const { return sum(&Totals::touched_dose); }
  /// Impacts without friction, since a ball was in a stall, and their dose [J].
  std::uint64_t in_stall() const { return count(&Totals::in_stall); }
  Real stall_dose() const { return sum(&Totals::stall_dose); }
  Real supplied_energy() const { return sum(&Totals::supplied_energy); }
  Real wall_work() const { return sum(&Totals::wall_work); }

 private:
  std::uint64_t count(std::uint64_t Totals::*part) const {
    std::uint64_t total = 0;
    for (const auto& t : totals_) total += t.*part;
    return total;
  }
  Real sum(numerics::CompensatedSum<Real> Totals::*part) const {
    numerics::CompensatedSum<Real> total;
    for (const auto& t : totals_) total += (t.*part).value();
    return total.value();
  }
  std::vector<Totals> totals_;
};

}  // namespace edmill::run
