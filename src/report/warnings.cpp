#include "report/warnings.hpp"

#include <fmt/format.h>

#include <cmath>

#include "plot/ticks.hpp"
#include "study/statistics.hpp"

namespace edmill::report {

namespace {

using plot::readable;

constexpr double touched_share_limit = 0.05, supplied_share_limit = 0.01, stall_share_limit = 0.01,
                 closure_limit = 1e-9, interval_limit = 0.05;
constexpr double fewest_collisions = 1000;

void check_end(const RunFacts& f, std::vector<Warning>& list) {
  using model::EndReason;
  const auto warn = [&](const std::string& text) { list.push_back({"end_reason", text}); };
  if (f.end_reason == EndReason::interrupted)
    warn("The run was interrupted; the results cover the time up to then.");
  if (f.end_reason == EndReason::inelastic_collapse)
    warn("The run ended in inelastic collapse: a ball met another body infinitely often in a finite time.");
  if (f.end_reason == EndReason::stalled)
    warn(
        "The run has stalled: bodies that no motion parts hit each other while the clock stood still. The "
        "results cover the time up to then.");
  if (f.end_reason == EndReason::undecided)
    warn("The run ended at a decision that no scalar could make; the results cover the time up to then.");
}

/// Whether the transient is not over: the first batch is outside the others' prediction interval, or the
/// halves differ.
bool drifts(const std::vector<double>& means) {
  const auto half = means.begin() + static_cast<std::ptrdiff_t>(means.size() / 2);
  return study::stands_apart(means.front(), {means.begin() + 1, means.end()}, 0.01) ||
         study::differ({means.begin(), half}, {half, means.end()}, 0.01);
}

}  // namespace

std::vector<Warning> warnings_of(const RunFacts& f, const Batches& dose_rate) {
  std::vector<Warning> list;
  check_end(f, list);
  if (f.all_collisions() < fewest_collisions)
    list.push_back({"too_few_collisions",
                    fmt::format("Only {} collisions were counted; below {} the rates are not reliable.",
                                plot::brief(f.all_collisions()), plot::brief(fewest_collisions))});
  if (!dose_rate.means.empty()) {
    const auto e = study::estimate(dose_rate.means);
    if (drifts(dose_rate.means))
      list.push_back(
          {"transient",
           "The dose rate drifts within the statistics: begin them later (run.start_time), when it "
           "is steady."});
    if (e.half_width.value_or(0) > interval_limit * std::abs(e.mean.value_or(0)))
      list.push_back(
          {"wide_interval", fmt::format("The 95 % interval of the dose rate is wider than \u00b1{} %: "
                                        "run longer.",
                                        plot::brief(100 * interval_limit))});
  }
  if (f.touched_dose_share > touched_share_limit)
    list.push_back(
        {"separation_share",
         fmt::format("{} % of the dose comes from impacts that the least separation speed decides: "
                     "run also with half of contact.least_separation.",
                     readable(100 * f.touched_dose_share, 2))});
  if (f.stall_dose_share > stall_share_limit)
    list.push_back(
        {"stall_share",
         fmt::format("{} % of the dose comes from impacts without friction, in stalls of bodies that "
                     "touch: friction acts less than the case says.",
                     readable(100 * f.stall_dose_share, 2))});
  if (f.milling_dose > 0 && f.supplied_energy > supplied_share_limit * f.milling_dose)
    list.push_back({"supplied_energy",
                    fmt::format("The least separation speed supplies {} % of the dose as kinetic energy: run "
                                "with a smaller contact.least_separation.",
                                readable(100 * f.supplied_energy / f.milling_dose, 2))});
  if (f.milling_dose > 0 && std::abs(f.closure) > closure_limit * f.milling_dose)
    list.push_back({"energy", fmt::format("Energy closes only to {} of the dose.",
                                          readable(std::abs(f.closure) / f.milling_dose, 2))});
  return list;
}

}  // namespace edmill::report
