// Implementation of result_table; included by the instantiation files only.
#pragma once

#include <fmt/format.h>

#include "report/result_table.hpp"

namespace edmill::report {

template <class Real>
std::string result_table(const io::Summary<Real>& s) {
  const auto real = [](const Real& x) { return static_cast<double>(x); };
  const double duration = real(s.duration());
  std::string out;
  const auto row = [&](const std::string& name, const std::string& value) {
    out += fmt::format("  {:<28}{}\n", name, value);
  };
  out += fmt::format("{} in {}, ended by {}\n", s.provenance.case_file, s.provenance.precision,
                     model::name(s.end_reason));
  row("statistics", fmt::format("{} s to {} s", real(s.start_time), real(s.end_time)));
  out += fmt::format("  {:<28}{:>12}{:>14}{:>16}\n", "collisions", "number", "per second", "dose [J]");
  const auto collisions = [&](const std::string& name, std::uint64_t number, const Real& dose) {
    const std::string rate =
        duration > 0 ? fmt::format("{:.1f}", static_cast<double>(number) / duration) : "-";
    out += fmt::format("    {:<26}{:>12}{:>14}{:>16.6g}\n", name, number, rate, real(dose));
  };
  for (int k = 0; k < s.partners.count(); ++k) {
    const auto& label = s.partners[k].label;
    collisions(k < s.partners.walls() ? fmt::format("wall {} ({})", k, label) : label, s.collisions[k],
               s.dose_by_partner[k]);
  }
  collisions("total", s.total_collisions(), s.milling_dose);
  if (duration > 0) {
    row("milling dose rate", fmt::format("{:.6g} W", real(s.milling_dose) / duration));
    if (s.milling_dose > 0)
      row("inverse milling dose rate", fmt::format("{:.6g} s/J", duration / real(s.milling_dose)));
    row("wall work rate", fmt::format("{:.6g} W", real(s.wall_work) / duration));
    if (s.powder_mass)
      row("specific milling dose rate",
          fmt::format("{:.6g} W/kg", real(s.milling_dose) / duration / real(*s.powder_mass)));
  }
  if (s.milling_dose > 0)
    row("energy closure / dose", fmt::format("{:.2e}", real(s.energy_closure()) / real(s.milling_dose)));
  const auto total = s.total_collisions();
  const auto of_dose = [&](const Real& energy) {
    return s.milling_dose > 0 ? 100 * real(energy) / real(s.milling_dose) : 0.0;
  };
  const auto of_impacts = [&](std::uint64_t impacts) {
    return total > 0 ? 100.0 * static_cast<double>(impacts) / static_cast<double>(total) : 0.0;
  };
  row("least separation speed",
      fmt::format("{:.1f} % of impacts, {:.2g} % of the dose; supplies {:.2g} % of the dose",
                  of_impacts(s.touched_impacts), of_dose(s.touched_dose), of_dose(s.supplied_energy)));
  if (s.stall_impacts > 0)
    row("stalls, without friction", fmt::format("{:.2g} % of impacts, {:.2g} % of the dose",
                                                of_impacts(s.stall_impacts), of_dose(s.stall_dose)));
  if (s.collapse)
    row("inelastic collapse", fmt::format("ball {} with {} {} at {:.12g} s", s.collapse->ball,
                                          s.collapse->with_wall ? "wall" : "ball", s.collapse->partner,
                                          real(s.collapse->accumulation_time)));
  for (const auto& e : s.escalations)
    row("decided by " + e.scalar, fmt::format("{} wall, {} pair, {} order", e.wall, e.pair, e.order));
  row("deepest overlap", fmt::format("{:.2e} m", real(s.deepest_overlap)));
  row("CPU time",
      fmt::format("{:.3g} s, {:.3g} collisions/s", s.cpu_seconds,
                  s.cpu_seconds > 0 ? static_cast<double>(s.total_impacts) / s.cpu_seconds : 0.0));
  return out;
}

}  // namespace edmill::report
