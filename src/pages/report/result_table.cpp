// The result table of a run on the terminal.
#include <fmt/format.h>

#include <string_view>

#include "base/clean_text.hpp"
#include "report/report_page.hpp"

namespace edmill::report {

namespace {

/// "12.3 ± 0.4 h", in the unit that reads best.
std::string time_text(double seconds, const std::optional<double>& half_width) {
  const auto [size, unit] = seconds >= 7200  ? std::pair{3600.0, "h"}
                            : seconds >= 120 ? std::pair{60.0, "min"}
                                             : std::pair{1.0, "s"};
  return fmt::format("{:.4g}{} {}", seconds / size,
                     half_width ? fmt::format(" ± {:.2g}", *half_width / size) : "", unit);
}

std::string row_text(std::string_view name, std::string_view value) {
  return fmt::format("  {:<28}{}\n", name, value);
}

std::string target_rows(const io::Summary<double>& s) {
  const auto time = s.milling_time();
  return row_text("target dose", fmt::format("{:g} kJ/g, {}", s.target->dose / 1e6, s.target->counts)) +
         row_text("milling time",
                  time ? time_text(*time, s.milling_time_half_width()) : "none: nothing of the dose counts");
}

/// Rates with their intervals; nothing of a run without time.
std::string rate_rows(const io::Summary<double>& s) {
  std::string out;
  const double duration = s.duration();
  if (!(duration > 0)) return out;
  const auto& of = s.intervals;
  const auto row = [&](const char* name, double value, double half_width, const char* unit) {
    out += fmt::format("  {:<28}{:.6g}{} {}\n", name, value,
                       of.any() ? fmt::format(" ± {:.2g}", half_width) : "", unit);
  };
  const double rate = s.milling_dose / duration, half_width = of.dose_rate.half_width;
  row("milling dose rate", rate, half_width, "W");
  if (rate > 0) row("inverse milling dose rate", 1 / rate, half_width / rate / rate, "s/J");
  row("wall work rate", s.wall_work / duration, of.wall_work_rate.half_width, "W");
  if (s.powder_mass) {
    const double mass = *s.powder_mass;
    row("specific milling dose rate", rate / mass, half_width / mass, "W/kg");
  }
  return out;
}

/// What wider scalars and rules decided.
std::string decision_rows(const io::Summary<double>& s) {
  std::string out;
  if (s.simultaneous_contacts > 0)
    out +=
        row_text("simultaneous, by a rule", fmt::format("{} impacts, {}", s.simultaneous_contacts,
                                                        percent(static_cast<double>(s.simultaneous_contacts) /
                                                                static_cast<double>(s.total_impacts))));
  for (const auto& e : s.escalations)
    out += row_text("decided by " + e.scalar,
                    fmt::format("{} wall, {} pair, {} order", e.wall, e.pair, e.order));
  return out;
}

}  // namespace

std::string result_table(const io::Summary<double>& s) {
  const double duration = s.duration();
  std::string out;
  const auto row = [&](const std::string& name, const std::string& value) { out += row_text(name, value); };
  out += fmt::format("{} in {}, ended by {}\n", s.provenance.case_file, s.provenance.precision,
                     model::name(s.end_reason));
  row("statistics", fmt::format("{} s to {} s", s.start_time, s.end_time));
  out += fmt::format("  {:<28}{:>12}{:>14}{:>10}{:>14}\n", "collisions", "number", "per second", "±",
                     "dose [J]");
  const auto& of = s.intervals;
  const auto collisions = [&](const std::string& name, std::uint64_t number, double dose,
                              const io::Intervals::Rate* interval) {
    const std::string rate =
        duration > 0 ? fmt::format("{:.1f}", static_cast<double>(number) / duration) : "-";
    out += fmt::format("    {:<26}{:>12}{:>14}{:>10}{:>14.6g}\n", name, number, rate,
                       interval ? fmt::format("{:.2g}", interval->half_width) : "-", dose);
  };
  for (int k = 0; k < s.partners.count(); ++k) {
    const auto& label = s.partners[k].label;
    collisions(k < s.partners.walls() ? fmt::format("wall {} ({})", k, label) : label, s.collisions[k],
               s.dose_by_partner[k], of.any() ? &of.collision_rates[k] : nullptr);
  }
  collisions("total", s.total_collisions(), s.milling_dose, of.any() ? &of.collision_rate : nullptr);
  out += rate_rows(s);
  if (s.target) out += target_rows(s);
  const double scale = s.energy_scale();
  if (scale > 0)
    row(s.milling_dose < s.energy_scale() ? "energy closure / kinetic" : "energy closure / dose",
        fmt::format("{:.2e}", s.energy_closure / scale));
  const auto total = s.total_collisions();
  const auto of_dose = [&](double energy) {
    return percent(s.milling_dose > 0 ? energy / s.milling_dose : 0.0);
  };
  const auto of_impacts = [&](std::uint64_t impacts) {
    return total > 0 ? static_cast<double>(impacts) / static_cast<double>(total) : 0.0;
  };
  row("least separation speed",
      fmt::format("{:.1f} % of impacts, {} of the dose; supplies {} of the {}",
                  100 * of_impacts(s.touched_impacts), of_dose(s.touched_dose),
                  percent(scale > 0 ? s.supplied_energy / scale : 0.0), s.energy_scale_name()));
  if (s.stall_impacts > 0)
    row("stalls, without friction", fmt::format("{} of impacts, {} of the dose",
                                                percent(of_impacts(s.stall_impacts)), of_dose(s.stall_dose)));
  if (s.collapse)
    row("inelastic collapse", fmt::format("ball {} with {} {} at {:.12g} s", s.collapse->ball,
                                          s.collapse->with_wall ? "wall" : "ball", s.collapse->partner,
                                          s.collapse->accumulation_time));
  out += decision_rows(s);
  row("deepest overlap", fmt::format("{:.2e} m", s.deepest_overlap));
  row("CPU time",
      fmt::format("{:.3g} s, {:.3g} collisions/s", s.cpu_seconds,
                  s.cpu_seconds > 0 ? static_cast<double>(s.total_impacts) / s.cpu_seconds : 0.0));
  for (const auto& warning : s.warnings) row("warning", warning.text);
  return out;
}

}  // namespace edmill::report
