#include "run/warnings.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/clean_text.hpp"
#include "base/statistics.hpp"

namespace edmill::run {

namespace {

constexpr double touched_share_limit = 0.05, supplied_share_limit = 0.01, stall_share_limit = 0.01,
                 closure_limit = 1e-9, interval_limit = 0.05, by_rule_share_limit = 0.01;
constexpr double fewest_collisions = 1000;

constexpr std::pair<model::EndReason, const char*> ends[] = {
    {model::EndReason::interrupted, "The run was interrupted; the results cover the time up to then."},
    {model::EndReason::inelastic_collapse,
     "The run ended in inelastic collapse: a ball met another body infinitely often in a finite time."},
    {model::EndReason::stalled,
     "The run has stalled: bodies that cannot separate hit each other while the clock stood still. The "
     "results cover the time up to then."},
    {model::EndReason::undecided,
     "The run ended at a decision that no scalar could make; the results cover the time up to then."}};

/// Whether the transient is not over: the first batch is outside the others' prediction interval, or the
/// halves differ.
bool drifts(const std::vector<double>& means) {
  const auto half = means.begin() + static_cast<std::ptrdiff_t>(means.size() / 2);
  return numerics::stands_apart(means.front(), {means.begin() + 1, means.end()}, 0.01) ||
         numerics::differ({means.begin(), half}, {half, means.end()}, 0.01);
}

void check_dose_rate(const Measures& m, std::vector<io::Warning>& list) {
  const auto warn = [&](const char* kind, const std::string& text) { list.push_back({kind, text}); };
  if (m.dose_rates.size() < 2) {
    if (m.duration > 0)
      warn("too_short", fmt::format("The statistics cover fewer than {} drive periods: the rates have no "
                                    "intervals. Run longer.",
                                    io::Intervals::fewest));
    return;
  }
  const auto e = numerics::estimate(m.dose_rates);
  const double relative = *e.mean != 0 ? std::abs(*e.half_width / *e.mean) : 0;
  if (drifts(m.dose_rates))
    warn("transient",
         "The dose rate drifts within the statistics: begin them later (run.start_time), when it "
         "is steady.");
  if (m.wanted_precision && relative > *m.wanted_precision) {
    const double ratio = relative / *m.wanted_precision;
    warn("precision",
         fmt::format("The dose rate is known to {}, {} was asked for: some {:.2g} s more are needed.",
                     percent(relative), percent(*m.wanted_precision), (ratio * ratio - 1) * m.duration));
  } else if (relative > interval_limit) {
    warn("wide_interval",
         fmt::format("The 95 % interval of the dose rate is wider than \u00b1{}: run longer.",
                     percent(interval_limit)));
  }
}

}  // namespace

std::vector<io::Warning> warnings_of(const Measures& m) {
  std::vector<io::Warning> list;
  const auto warn = [&](const char* kind, const std::string& text) { list.push_back({kind, text}); };
  for (const auto& [reason, text] : ends)
    if (m.end_reason == reason) warn("end_reason", text);
  if (m.collisions < fewest_collisions)
    warn("too_few_collisions",
         fmt::format("Only {:g} collisions were counted; below {:g} the rates are not reliable.",
                     m.collisions, fewest_collisions));
  check_dose_rate(m, list);
  if (m.touched_share > touched_share_limit)
    warn("separation_share",
         fmt::format("{} of the {} that the least separation speed decides: run also with half of "
                     "contact.least_separation.",
                     percent(m.touched_share),
                     m.has_dose ? "dose comes from impacts" : "impacts are among those"));
  if (m.stall_dose_share > stall_share_limit)
    warn("stall_share", fmt::format("{} of the dose comes from impacts without friction, in stalls of bodies "
                                    "that touch: friction acts less than the case says.",
                                    percent(m.stall_dose_share)));
  if (m.supplied_share > supplied_share_limit)
    warn("supplied_energy", fmt::format("The least separation speed supplies energy, {} of the {}: "
                                        "run with a smaller contact.least_separation.",
                                        percent(m.supplied_share), m.energy_scale));
  if (m.by_rule_share > by_rule_share_limit)
    warn("by_rule", fmt::format("{} of the impacts come at the same time as another one of their ball, in an "
                                "order that a rule decides: compare with other seeds or another precision.",
                                percent(m.by_rule_share)));
  if (std::abs(m.closure_share) > closure_limit)
    warn("energy",
         fmt::format("Energy closes only to {:.2g} of the {}.", std::abs(m.closure_share), m.energy_scale));
  return list;
}

}  // namespace edmill::run
