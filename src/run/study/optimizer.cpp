#include "study/optimizer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/clean_text.hpp"
#include "casefile/quantity.hpp"

namespace edmill::study {

namespace {

using casefile::OptimizeSpec;
using casefile::OptimizeVariable;
using Coordinates = std::vector<double>;  ///< of each variable a value, or its index

class Search {
 public:
  Search(const OptimizeSpec& spec, Study& study)
      : spec_(spec), study_(study), quantity_(quantity_named(spec.objective())) {
    for (const auto& v : spec.variables) {
      const double intervals = static_cast<double>(spec.points - 1);
      steps_.push_back(v.values.empty() ? (v.high - v.low) / intervals : 0);
    }
  }

  std::string forecast() {
    begin();
    return study_.forecast();
  }

  Optimum run() {
    begin();
    study_.run();
    for (std::uint64_t round = 0;; ++round) {
      separate();
      if (stopped() || round == spec_.refinements || !refine()) break;
      study_.run();
    }
    Optimum optimum{best(), {}, ""};
    if (optimum.best) optimum.contenders = contenders(*optimum.best);
    optimum.why = study_.interrupted() ? "interrupted"
        : out_of_budget_               ? "the budget of runs_max is used up"
                                       : "the grid is as fine as requested";
    return optimum;
  }
 private:
  void begin() {
    study_.expect_at_most(spec_.runs_max);
    add_grid();
    study_.require_a_good_case();
  }

  bool stopped() const { return out_of_budget_ || study_.interrupted(); }

  /// Takes runs from the budget if it has this many left.
  bool spend(std::uint64_t runs) {
    if (used_ + runs > spec_.runs_max) {
      out_of_budget_ = true;
      return false;
    }
    used_ += runs;
    return true;
  }

  std::string text_of(const OptimizeVariable& v, double x) const {
    if (!v.values.empty()) return v.values[static_cast<std::size_t>(x)];
    return (x == v.low || x == v.high ? fmt::format("{}", x) : fmt::format("{:.6g}", x)) + v.unit;
  }

  /// Adds a point if it is new, within bounds and within the budget.
  bool add_point(Coordinates at) {
    Point point;
    for (std::size_t k = 0; k < at.size(); ++k) {
      const auto& v = spec_.variables[k];
      if (v.integer) at[k] = std::round(at[k]);
      const double slack = 1e-9 * (v.high - v.low);
      if (v.values.empty() && (at[k] < v.low - slack || at[k] > v.high + slack)) return false;
      point.settings.emplace_back(v.key, text_of(v, at[k]));
    }
    if (seen_.contains(point.settings) || !spend(spec_.replicas_first)) return false;
    seen_.insert(point.settings);
    places_.push_back(at);
    study_.add_runs(study_.add_point(std::move(point)), spec_.replicas_first);
    return true;
  }

  /// All combinations of a list of values for each variable, the last one changing fastest.
  bool add_product(const std::vector<Coordinates>& lists) {
    std::vector<Coordinates> places{{}};
    for (const auto& list : lists) {
      std::vector<Coordinates> longer;
      for (const auto& place : places)
        for (const double x : list) {
          longer.push_back(place);
          longer.back().push_back(x);
        }
      places = std::move(longer);
    }
    bool added = false;
    for (const auto& place : places) added = add_point(place) || added;
    return added;
  }

  void add_grid() {
    std::vector<Coordinates> lists;
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      const auto& v = spec_.variables[k];
      const auto count = v.values.empty() ? spec_.points : v.values.size();
      Coordinates list;
      for (std::size_t i = 0; i < count; ++i) {
        const double index = static_cast<double>(i), last = static_cast<double>(count - 1);
        list.push_back(
            v.values.empty() ? std::lerp(v.low, v.high, index / last) : index);  // exact ends
      }
      lists.push_back(list);
    }
    add_product(lists);
  }

  /// Halves the step and adds one step to both sides of the best point.
  bool refine() {
    const auto centre = best();
    if (!centre) return false;
    std::vector<Coordinates> lists;
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      const double x = places_[*centre][k];
      if (spec_.variables[k].integer && steps_[k] <= 1) steps_[k] = 0;
      steps_[k] /= 2;
      if (spec_.variables[k].integer && steps_[k] > 0) steps_[k] = std::max(steps_[k], 1.0);
      lists.push_back(
          steps_[k] > 0 ? Coordinates{x, x - steps_[k], x + steps_[k]} : Coordinates{x});
    }
    return add_product(lists);
  }

  /// Doubles the runs of all points that may be the best until one is left or all have the most.
  void separate() {
    while (!stopped()) {
      const auto leader = best();
      if (!leader) return;
      auto group = contenders(*leader);
      if (group.empty()) return;
      group.insert(group.begin(), *leader);
      bool added = false;
      for (const auto k : group) {
        const auto have = study_.points()[k].runs.size();
        const auto want = std::min<std::uint64_t>(2 * have, spec_.replicas_max);
        if (want <= have || !spend(want - have)) continue;
        study_.add_runs(k, want - have);
        added = true;
      }
      if (!added) return;
      study_.run();
    }
  }

  std::vector<double> values(std::size_t point) const {
    return study_.points()[point].values(quantity_);
  }

  /// The largest mean of points without a failure; the first of equals.
  std::optional<std::size_t> best() const {
    std::optional<std::size_t> best;
    double largest = 0;
    for (std::size_t k = 0; k < study_.points().size(); ++k) {
      const auto mean = numerics::estimate(values(k)).mean;
      if (!mean || study_.points()[k].failed() > 0) continue;
      if (!best || *mean > largest) {
        best = k;
        largest = *mean;
      }
    }
    return best;
  }

  /// Points that cannot be distinguished from the leader, at 5 % for all comparisons together.
  std::vector<std::size_t> contenders(std::size_t leader) const {
    std::vector<std::size_t> group;
    const auto count = study_.points().size();
    const double significance = 0.05 / static_cast<double>(std::max<std::size_t>(count - 1, 1));
    for (std::size_t k = 0; k < count; ++k)
      if (k != leader && study_.points()[k].failed() == 0 && !values(k).empty() &&
          !numerics::differ(values(k), values(leader), significance))
        group.push_back(k);
    return group;
  }

  const OptimizeSpec& spec_;
  Study& study_;
  Quantity quantity_;
  std::vector<double> steps_;  ///< of the present grid; 0 for a variable that is not refined
  std::vector<Coordinates> places_;
  std::set<std::vector<casefile::Setting>> seen_;
  std::uint64_t used_ = 0;
  bool out_of_budget_ = false;
};

std::string line_of(const OptimizeSpec& spec, const Study& study, std::size_t index) {
  const auto& point = study.points()[index];
  std::string line = fmt::format("  point {}:", index + 1);
  for (const auto& [key, value] : point.settings) line += fmt::format(" {} = {},", key, value);
  const auto quantity = quantity_named(spec.objective()), energy = quantity_named("impact_energy");
  return line +
      fmt::format(" {}, {} {} ({})\n", text_of(point.estimate(quantity), quantity), energy.title,
          text_of(point.estimate(energy), energy), counted(point.done(), "run"));
}

/// A note if the best value of a variable is at the end of its range; otherwise empty.
std::string bound_of(const OptimizeVariable& v, const std::string& value) {
  if (!v.values.empty()) return "";
  const auto number = casefile::parse_decimal(value.substr(0, value.size() - v.unit.size()));
  const double slack = 1e-9 * (v.high - v.low);
  for (const auto& [end, name] : {std::pair{v.low, "low"}, std::pair{v.high, "high"}})
    if (number && std::abs(number->to<double>() - end) <= slack)
      return fmt::format(
          "  {} is at the end '{}' of its range: there may be more beyond it; widen the range\n",
          v.key, name);
  return "";
}

}  // namespace

Optimum optimize(const OptimizeSpec& spec, Study& study) { return Search(spec, study).run(); }

std::string forecast(const OptimizeSpec& spec, Study& study) {
  return Search(spec, study).forecast();
}

std::string describe(const OptimizeSpec& spec, const Study& study, const Optimum& optimum) {
  if (!optimum.best) return "no point has a value of " + spec.objective() + "\n";
  std::string text = fmt::format("largest {} of {} points, 95 % interval; the search ended: {}\n",
      spec.objective(), study.points().size(), optimum.why);
  text += line_of(spec, study, *optimum.best);
  const auto& settings = study.points()[*optimum.best].settings;
  for (std::size_t k = 0; k < settings.size(); ++k)
    text += bound_of(spec.variables[k], settings[k].second);
  text += optimum.contenders.empty()
      ? "every other point is smaller, at 5 % for all comparisons together\n"
      : "indistinguishable from it, at 5 % for all comparisons together:\n";
  for (const auto k : optimum.contenders) text += line_of(spec, study, k);
  const auto& points = study.points();
  const auto excluded =
      std::count_if(points.begin(), points.end(), [](const Point& p) { return p.failed() > 0; });
  if (excluded > 0)
    text += "left out: " + counted(static_cast<std::uint64_t>(excluded), "point") +
        " with failed runs\n";
  return text;
}

}  // namespace edmill::study
