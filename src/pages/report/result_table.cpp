// The result table of a run on the terminal.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <tuple>

#include "base/clean_text.hpp"
#include "report/report_page.hpp"

namespace edmill::report {

namespace {

using io::Facts;

std::string row_text(std::string_view name, std::string_view value) {
  return fmt::format("  {:<28}{}\n", name, value);
}

std::string collision_rows(const Facts& f, const model::Partners& partners) {
  std::string out = fmt::format("  {:<28}{:>12}{:>10}{:>26}{:>14}\n", "collisions", "number",
      "at rest", "impacts per second", "dose [J]");
  const auto row = [&](const std::string& name, const std::string& key, double dose) {
    const auto rate = f.find("impact_rate/" + key), all = f.find("collision_rate/" + key);
    const auto text =
        rate ? with_interval(*rate, f.find("intervals/impact_rate/" + key)) : std::string("-");
    out += fmt::format("    {:<26}{:>12.0f}{:>10}{:>26}{:>14.6g}\n", name,
        f.number("collisions/" + key),
        rate && *all > 0 ? percent(std::max(0.0, 1 - *rate / *all)) : "-", text, dose);
  };
  for (int k = 0; k < partners.count(); ++k) {
    const auto& [key, label, meaning] = partners[k];
    row(k < partners.walls() ? fmt::format("wall {} ({})", k, label) : label, key,
        f.number("milling_dose_by_partner/" + key));
  }
  row("total", "total", f.number("milling_dose"));
  return out;
}

/// Rates with their intervals, and what impacts are like; empty if the statistics cover no time.
std::string rate_rows(const Facts& f) {
  std::string out;
  for (const auto& [name, key, unit] : {std::tuple{"milling dose rate", "milling_dose_rate", "W"},
           std::tuple{"specific milling dose rate", "specific_milling_dose_rate", "W/kg"},
           std::tuple{"inverse milling dose rate", "inverse_milling_dose_rate", "s/J"},
           std::tuple{"wall work rate", "wall_work_rate", "W"},
           std::tuple{"impacts above 1 m/s", "fast_impact_rate", "1/s"}})
    if (const auto rate = f.find(key))
      out += row_text(
          name, with_interval(*rate, f.find(std::string("intervals/") + key)) + " " + unit);
  if (const auto speed = f.find("mean_impact_speed"))
    out += row_text("mean impact speed", fmt::format("{:.3g} m/s, weighted by dose", *speed));
  for (const auto& [name, key] : {std::pair{"impact energy", "impact_energy_by_dose"},
           std::pair{"dissipated in an impact", "dissipated_energy_by_dose"}})
    if (const auto half = f.find(std::string(key) + "/median"))
      out += row_text(name,
          fmt::format("half of the impacts' dose below {}, 90 % below {}", energy_text(*half),
              energy_text(f.number(std::string(key) + "/90_percent"))));
  if (const double share = f.number("least_separation/milling_dose_share"); share > 0.1)
    out += row_text(
        "contacts at rest", percent(share) + " of the dose: balls that roll, slide or settle");
  return out;
}

std::string target_rows(const Facts& f) {
  const auto time = f.find("target/milling_time");
  return row_text("milling time",
             (time ? time_with_interval(*time, f.find("target/milling_time_half_width"))
                   : "none: nothing of the dose counts")) +
      row_text("target dose",
          fmt::format("{:g} kJ/g, {}", f.number("target/dose") / 1e6, f.text("target/counts")));
}

/// Numbers of decisions by wider scalars and by rules.
std::string decision_rows(const Facts& f) {
  std::string out;
  if (const double count = f.number("simultaneous_contacts"); count > 0)
    out += row_text("simultaneous, by a rule",
        fmt::format("{:.0f} impacts, {}", count, percent(count / f.number("impacts_since_start"))));
  for (const auto& scalar : f.keys_of("escalations")) {
    const auto number = [&](const char* what) { return f.number("escalations/" + scalar + what); };
    out += row_text("decided by " + scalar,
        fmt::format("{:.0f} wall, {:.0f} pair, {:.0f} order", number("/wall"), number("/pair"),
            number("/order")));
  }
  return out;
}

}  // namespace

std::string result_table(const Facts& f, const model::Partners& partners) {
  std::string out = fmt::format(
      "{} in {}, ended by {}\n", f.text("case_file"), f.text("precision"), f.text("end_reason"));
  const auto row = [&](const std::string& name, const std::string& value) {
    out += row_text(name, value);
  };
  const auto share = [&](const char* key) { return percent(f.number(key)); };
  row("statistics", fmt::format("{} s to {} s", f.number("start_time"), f.number("end_time")));
  if (f.has("target/dose")) out += target_rows(f);
  out += rate_rows(f) + collision_rows(f, partners);
  const std::string scale = io::energy_scale_of(f);
  if (const auto closure = f.find("energy/closure_relative"))
    row(scale == "dose" ? "energy closure / dose" : "energy closure / kinetic",
        fmt::format("{:.2e}", *closure));
  row("least separation speed",
      fmt::format("{} of collisions, {} of the dose; supplies {} of the {}",
          share("least_separation/impact_share"), share("least_separation/milling_dose_share"),
          share("least_separation/supplied_energy_share"), scale));
  if (f.number("stalls/impacts") > 0)
    row("stalls, without friction",
        fmt::format("{} of impacts, {} of the dose", share("stalls/impact_share"),
            share("stalls/milling_dose_share")));
  if (f.has("inelastic_collapse/ball"))
    row("inelastic collapse",
        fmt::format("ball {} with {} {} at {:.12g} s", f.number("inelastic_collapse/ball"),
            f.text("inelastic_collapse/partner_kind"), f.number("inelastic_collapse/partner"),
            f.number("inelastic_collapse/accumulation_time")));
  out += decision_rows(f);
  row("deepest overlap", fmt::format("{:.2e} m", f.number("deepest_overlap")));
  row("CPU time",
      fmt::format("{:.3g} s, {:.3g} collisions/s", f.number("cpu_seconds"),
          f.number("collisions_per_cpu_second")));
  for (const auto& kind : f.keys_of("warnings")) row("warning", f.text("warnings/" + kind));
  return out;
}

}  // namespace edmill::report
