// How often powder is hit: the fraction of it that has been hit n times. docs/outputs.md, "treatment"
#pragma once

#include <vector>

#include "base/scalar_list.hpp"
#include "output/coverage_output.hpp"
#include "output/table_output.hpp"

namespace edmill::output {

struct TreatmentKeys {
  casefile::Quantity share, threshold;
  std::uint64_t most = 10;
  CoverageKeys cells;

  static void keys(auto& t, auto&& row) {
    row({"share_per_impact", "fraction of the powder's volume that one impact works",
         casefile::Range(1e-12, 1)},
        t.share);
    row({"threshold", Dimension::energy, "lowest energy that an impact must dissipate to work powder",
         model::Range::not_negative, "0 J"},
        t.threshold);
    row({"most", "largest number of hits with a row of its own", casefile::table_size, "10"}, t.most);
    CoverageKeys::keys(t.cells, row);
  }
};

/// exp(-x) with the same bits on every machine.
template <class Real>
Real exp_of_minus(const Real& x) {
  if constexpr (std::is_same_v<Real, double>) {
    return static_cast<double>(exp(-mpfr50(x)));
  } else {
    using std::exp;
    return exp(Real(-x));
  }
}

/// Counts impacts on each ball and each cell of the walls. If powder is mixed between impacts, each impact
/// hits it with the same probability, so that the number of hits has Poisson's distribution (Delogu and
/// Cocco). If powder stays in place, in an even layer, the mean is that of its own patch.
template <class Real>
class TreatmentOutput : public TableOutput<Real> {
 public:
  TreatmentOutput(const casefile::OutputSpec& spec, const RunContext<Real>& run)
      : TableOutput<Real>(spec, run),
        most_(spec.own_keys<TreatmentKeys>().most),
        share_(spec.own_keys<TreatmentKeys>().share.template to<Real>()),
        threshold_(spec.own_keys<TreatmentKeys>().threshold.template to<Real>()),
        walls_(run.surfaces(spec), run.bodies, spec.own_keys<TreatmentKeys>().cells),
        on_walls_(walls_.count()),
        on_balls_(run.ball_colours.size()) {}

 protected:
  void archive_record(Archive& a) override { a(on_walls_, on_balls_, impacts_); }

  void record(const ImpactFacts<Real>& f) override {
    if (f.outcome.milling_dose < threshold_) return;
    ++impacts_;
    ++on_balls_[static_cast<std::size_t>(f.impact.ball)];
    if (!f.impact.with_wall)
      ++on_balls_[static_cast<std::size_t>(f.impact.partner)];
    else if (const auto cell = walls_.cell_of(f))
      ++on_walls_[*cell];
  }

  void end_of_record(const engine::Simulation<Real>& simulation, const Real& until) override {
    this->begin(
        {{"hits", text, "", "how often powder has been hit; the last row is of all that was hit more often"},
         {"mixed", number, "1", "part of the powder that was, if it is mixed between impacts"},
         {"in_place", number, "1",
          "part of the powder that was, if it stays in an even layer on balls and walls"}},
        {this->window(until), std::to_string(impacts_) + " impacts that work powder"});
    std::vector<Real> mixed(most_ + 1), in_place(most_ + 1);
    add_poisson(share_ * Real(impacts_), Real(1), mixed);
    Real whole(0);
    for_each_patch(simulation, [&](const Real& area, std::uint64_t) { whole += area; });
    for_each_patch(simulation, [&](const Real& area, std::uint64_t impacts) {
      // Half of the powder that an impact works is on each body.
      const Real layer = area / whole;
      if (layer > 0) add_poisson(share_ / 2 * Real(impacts) / layer, layer, in_place);
    });
    Real more_mixed(1), more_in_place(1);
    for (std::uint64_t hits = 0; hits <= most_; ++hits) {
      this->put(std::to_string(hits), mixed[hits], in_place[hits]);
      more_mixed -= mixed[hits];
      more_in_place -= in_place[hits];
    }
    this->put("more", more_mixed > 0 ? more_mixed : Real(0), more_in_place > 0 ? more_in_place : Real(0));
  }

 private:
  /// Calls f(area [m2], impacts) for each cell of the walls and each ball.
  void for_each_patch(const engine::Simulation<Real>& simulation, auto&& f) const {
    for (const auto& wall : walls_.walls())
      for (std::size_t cell = wall.first; cell < wall.first + wall.columns * wall.rows; ++cell)
        f(wall.area_of_cell(), on_walls_[cell]);
    for (std::size_t k = 0; k < on_balls_.size(); ++k)
      f(ball_area(simulation, static_cast<int>(k)), on_balls_[k]);
  }

  /// Adds `weight` times Poisson's distribution of this mean.
  void add_poisson(const Real& mean, const Real& weight, std::vector<Real>& sums) const {
    Real probability = exp_of_minus<Real>(mean);
    for (std::uint64_t hits = 0; hits <= most_; ++hits) {
      sums[hits] += weight * probability;
      probability *= mean / Real(hits + 1);
    }
  }

  std::uint64_t most_;
  Real share_, threshold_;
  WallCells<Real> walls_;
  std::vector<std::uint64_t> on_walls_, on_balls_;  ///< impacts by cell and by ball
  std::uint64_t impacts_ = 0;
};

}  // namespace edmill::output
