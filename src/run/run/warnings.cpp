// Warnings about the results of a run.
#include <fmt/format.h>

#include <cmath>

#include "base/clean_text.hpp"
#include "base/statistics.hpp"
#include "run/run_statistics.hpp"

namespace edmill::run {

namespace {

constexpr double supplied_share_limit = 0.01, stall_share_limit = 0.01, closure_limit = 1e-9,
                 interval_limit = 0.05, by_rule_share_limit = 0.01;
constexpr double fewest_collisions = 1000;

constexpr std::pair<model::EndReason, const char*> ends[] = {
    {model::EndReason::interrupted,
        "The run was interrupted; the results cover the time up to then."},
    {model::EndReason::inelastic_collapse,
        "The run ended in inelastic collapse: a ball met another body infinitely often in a finite "
        "time."},
    {model::EndReason::stalled,
        "The run has stalled: bodies that cannot separate hit each other while the simulated time "
        "did not advance. The results cover the time up to then."},
    {model::EndReason::undecided,
        "The run ended at a decision that no scalar could make; the results cover the time up to "
        "then."}};

void check_dose_rate(const io::Facts& f, const std::optional<double>& wanted, const auto& warn) {
  const double duration = f.number("duration");
  const auto* means = f.numbers("intervals/milling_dose_rate_of_batches");
  if (!means) {
    if (duration > 0)
      warn("too_short",
          fmt::format("The statistics cover fewer than {} drive periods: the rates have no "
                      "intervals. Run longer.",
              io::Intervals::fewest));
    return;
  }
  const auto e = numerics::series_estimate(*means);
  const double relative = *e.mean != 0 ? std::abs(*e.half_width / *e.mean) : 0;
  if (io::has_dose(f) &&
      (numerics::drifts(*means) ||
          numerics::stands_apart(means->front(), {means->begin() + 1, means->end()}, 0.01)))
    warn("transient",
        "The dose rate drifts within the statistics: begin them later (run.start_time), when it is "
        "steady.");
  if (f.has("intervals/several_states"))
    warn("several_states",
        fmt::format(
            "Other seeds may settle at another dose rate: {}. Run several: edmill run --seeds 8.",
            f.text("intervals/several_states")));
  if (wanted && relative > *wanted) {
    const double ratio = relative / *wanted;
    warn("precision",
        fmt::format(
            "The dose rate is known to {}, but {} was requested: about {:.2g} s more are needed.",
            percent(relative), percent(*wanted), (ratio * ratio - 1) * duration));
  } else if (relative > interval_limit) {
    warn("wide_interval",
        fmt::format("The 95 % interval of the dose rate is wider than \u00b1{}: run longer.",
            percent(interval_limit)));
  }
}

}  // namespace

std::vector<io::Warning> warnings_of(
    const io::Facts& f, const std::optional<double>& wanted_precision) {
  const std::string scale = io::energy_scale_of(f);
  const double collisions = f.number("collisions/total"), impacts = f.number("impacts_since_start"),
               by_rule = impacts > 0 ? f.number("simultaneous_contacts") / impacts : 0,
               supplied = f.number("least_separation/supplied_energy_share"),
               in_stalls = f.number("stalls/milling_dose_share"),
               closure = std::abs(f.find("energy/closure_relative").value_or(0));
  const auto end_reason = io::end_reason_of(f);
  std::vector<io::Warning> list;
  const auto warn = [&](const char* kind, const std::string& text) {
    list.push_back({kind, text});
  };
  for (const auto& [reason, text] : ends)
    if (end_reason == reason) warn("end_reason", text);
  if (collisions < fewest_collisions)
    warn("too_few_collisions",
        fmt::format("Only {} counted; below {:g} the rates are not reliable.",
            counted(static_cast<std::uint64_t>(collisions), "collision"), fewest_collisions));
  check_dose_rate(f, wanted_precision, warn);
  if (in_stalls > stall_share_limit)
    warn("stall_share",
        fmt::format("{} of the dose comes from impacts without friction, in stalls of bodies that "
                    "touch: friction is weaker than in the case.",
            percent(in_stalls)));
  if (supplied > supplied_share_limit)
    warn("supplied_energy",
        fmt::format("The least separation speed supplies energy, {} of the {}: run with a smaller "
                    "contact.least_separation.",
            percent(supplied), scale));
  if (by_rule > by_rule_share_limit)
    warn("by_rule",
        fmt::format("{} of the impacts coincide with another impact of their ball, and a rule "
                    "decides the order: compare with other seeds or another precision.",
            percent(by_rule)));
  if (closure > closure_limit)
    warn("energy",
        fmt::format("The balance of energy closes only to {:.2g} of the {}.", closure, scale));
  return list;
}

}  // namespace edmill::run
