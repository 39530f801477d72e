// Totals of a run since the start of statistics, and warnings about its results.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/statistics.hpp"
#include "base/sums.hpp"
#include "engine/observer.hpp"
#include "io/summary.hpp"
#include "model/ball.hpp"
#include "model/case.hpp"
#include "model/parts/partners.hpp"

namespace edmill::run {

template <class Real> class RunStatistics : public engine::Observer<Real> {
 public:
  struct Totals {
    std::uint64_t collisions = 0;
    std::uint64_t touched = 0;   ///< impacts at the least separation speed
    std::uint64_t in_stall = 0;  ///< frictionless impacts
    std::uint64_t fast = 0;      ///< above io::Intervals::fast
    numerics::CompensatedSum<Real> milling_dose, touched_dose, stall_dose, supplied_energy,
        wall_work;
    numerics::CompensatedSum<Real>
        speed_by_dose;  ///< approach speed times dose, without contacts at rest

    void archive(Archive& a) {
      a(collisions, touched, in_stall, fast, milling_dose, touched_dose, stall_dose,
          supplied_energy, wall_work, speed_by_dose);
    }
  };

  /// @param balls    of the case
  /// @param counted  the part of an impact's dose that works the powder
  explicit RunStatistics(const model::Partners& partners,
      const std::vector<model::BallProperties<Real>>& balls = {},
      const model::CountedDose<Real>& counted = {})
      : counts_(counted), totals_(partners.count()), balls_(balls.size()) {
    constexpr std::size_t most_alike = 64;
    while (doses_.size() < std::min(most_alike, balls.size()) && balls[doses_.size()] == balls[0])
      doses_.push_back(0);
  }

  void begin(const Instant<Real>& start) { batches_.begin(start); }

  void on_impact(const engine::Impact<Real>& impact, engine::Simulation<Real>&) override {
    if (!(impact.time < batches_.next_period())) batches_.pass(impact.time, totals_now());
    Totals& t = impact.with_wall ? totals_[impact.partner] : totals_.back();
    const auto& outcome = impact.outcome;
    ++t.collisions;
    if (outcome.approach_speed > io::Intervals::fast) ++t.fast;
    t.milling_dose += outcome.milling_dose;
    if (!counts_.all()) counted_dose_ += counts_.of(outcome);
    if (impact.with_wall) t.wall_work += outcome.wall_work;
    if (outcome.least_separation) {
      ++t.touched;
      t.touched_dose += outcome.milling_dose;
      t.supplied_energy += outcome.supplied_energy;
    } else {
      t.speed_by_dose += outcome.approach_speed * outcome.milling_dose;
      const double dose = static_cast<double>(outcome.milling_dose);
      impact_energies_.add(static_cast<double>(outcome.impact_energy()), dose);
      dissipated_energies_.add(dose, dose);
    }
    if (outcome.in_stall) {
      ++t.in_stall;
      t.stall_dose += outcome.milling_dose;
    }
    const double share = static_cast<double>(outcome.milling_dose) / (impact.with_wall ? 1 : 2);
    add_to_ball(impact.ball, share);
    if (!impact.with_wall) add_to_ball(impact.partner, share);
  }

  void archive(Archive& a) override {
    a(totals_, counted_dose_, batches_, doses_, impact_energies_, dissipated_energies_);
  }

  /// Totals by partner.
  const std::vector<Totals>& by_partner() const { return totals_; }

  /// The sum of one of the totals over all partners.
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
  std::uint64_t collisions() const { return count(&Totals::collisions); }
  Real milling_dose() const { return sum(&Totals::milling_dose); }
  Real supplied_energy() const { return sum(&Totals::supplied_energy); }
  Real wall_work() const { return sum(&Totals::wall_work); }
  const numerics::WeightedQuantiles& impact_energies() const { return impact_energies_; }
  const numerics::WeightedQuantiles& dissipated_energies() const { return dissipated_energies_; }
  /// The part of the dose that works the powder [J].
  Real counted_dose() const { return counts_.all() ? milling_dose() : counted_dose_.value(); }

  /// Confidence intervals of the rates, from the batches that are complete at an instant. They
  /// include the difference that the incomplete last period of `duration` [s] makes.
  io::Intervals intervals(
      const Instant<Real>& until, const Real& period, const Real& duration) const {
    auto batches = batches_;
    const auto all = totals_now();
    if (!(until < batches.next_period())) batches.pass(until, all);
    io::Intervals found;
    found.batches = batches.count();
    found.batch_length = static_cast<double>(batches.periods()) * static_cast<double>(period);
    if (found.batches < io::Intervals::fewest) return found;
    std::size_t place = 0;
    const double whole = static_cast<double>(batches.elapsed()) * static_cast<double>(period);
    const auto next = [&] {
      auto rate = io::Intervals::of(batches.amounts(place), found.batch_length);
      rate.half_width +=
          std::abs(all[place] / static_cast<double>(duration) - batches.total(place) / whole);
      ++place;
      return rate;
    };
    for (std::size_t k = 0; k < totals_.size(); ++k) {
      found.impact_rates.push_back(next());
      found.dose_rates.push_back(next());
    }
    found.impact_rate = next();
    found.fast_impact_rate = next();
    found.dose_rate = next();
    found.wall_work_rate = next();
    found.counted_dose_rate = next();
    constexpr std::size_t few = 2;
    if (balls_ <= few)
      found.several_states = "one or two balls often settle in one of several orbits";
    else if (repeats(found.dose_rate, static_cast<double>(batches.periods())))
      found.several_states = "its dose is nearly the same in every period";
    else if (stay_apart(batches, place))
      found.several_states =
          "its balls do not change places: balls that are alike have different dose rates";
    return found;
  }
 private:
  /// True if the dose is nearly the same in every period. Doses of random impacts scatter from
  /// period to period by more than `least_scatter` over the root of the number of balls.
  bool repeats(const io::Intervals::Rate& dose, double periods) const {
    constexpr double least_scatter = 0.05, least_share = 0.2;
    const auto e = numerics::estimate(dose.means);
    const double n = static_cast<double>(dose.means.size()),
                 scatter = *e.half_width * std::sqrt(n) / 2;
    return *e.mean > 0 &&
        (scatter * std::sqrt(periods * static_cast<double>(balls_)) < least_scatter * *e.mean ||
            dose.half_width < least_share * *e.half_width);
  }

  /// True if identical balls differ in their doses by more than their scatter over the record
  /// allows. The scatter is that of eight parts; shorter ones are correlated.
  bool stay_apart(const numerics::Batches<Real>& batches, std::size_t place) const {
    constexpr std::size_t parts = 8;
    constexpr double significance = 3e-5;
    const std::size_t length = batches.count() / parts;
    if (doses_.size() < 2 || length == 0) return false;
    std::vector<std::vector<double>> series;
    std::vector<double> of_all(parts);
    for (std::size_t ball = 0; ball < doses_.size(); ++ball) {
      const auto amounts = batches.amounts(place + ball);
      auto& own = series.emplace_back(parts);
      for (std::size_t k = 0; k < parts * length; ++k) own[k / length] += amounts[k];
      for (std::size_t k = 0; k < parts; ++k)
        of_all[k] += own[k] / static_cast<double>(doses_.size());
    }
    for (auto& own : series)
      for (std::size_t k = 0; k < parts; ++k) own[k] -= of_all[k];
    return numerics::means_differ(series, significance);
  }

  void add_to_ball(int ball, double dose) {
    if (static_cast<std::size_t>(ball) < doses_.size())
      doses_[static_cast<std::size_t>(ball)] += dose;
  }

  /// The totals now, in the order of the intervals, then the dose of each ball.
  std::vector<double> totals_now() const {
    std::vector<double> now;
    double impacts = 0, dose = 0, work = 0;
    for (const auto& t : totals_) {
      now.push_back(static_cast<double>(t.collisions - t.touched));
      now.push_back(static_cast<double>(t.milling_dose.value()));
      impacts += now[now.size() - 2];
      dose += now.back();
      work += static_cast<double>(t.wall_work.value());
    }
    now.insert(now.end(),
        {impacts, static_cast<double>(count(&Totals::fast)), dose, work,
            counts_.all() ? dose : static_cast<double>(counted_dose_.value())});
    now.insert(now.end(), doses_.begin(), doses_.end());
    return now;
  }

  model::CountedDose<Real> counts_;
  std::vector<Totals> totals_;
  numerics::CompensatedSum<Real> counted_dose_;
  numerics::Batches<Real> batches_;
  std::size_t balls_;
  numerics::WeightedQuantiles impact_energies_,
      dissipated_energies_;  ///< by dose, without contacts at rest [J]
  std::vector<double>
      doses_;  ///< by ball, for the first identical ones; half of a dose with another [J]
};

/// Warnings about results that are not reliable, with the reasons.
/// @param wanted_precision  of the dose rate, relative
std::vector<io::Warning> warnings_of(
    const io::Facts& summary, const std::optional<double>& wanted_precision);

}  // namespace edmill::run
