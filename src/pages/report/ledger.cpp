// The energy balance, and the case.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/sections.hpp"

namespace edmill::report {

using plot::add;
using plot::brief;
using plot::readable;

void add_energy(pugi::xml_node main, const RunFolder& run) {
  const auto& f = run.facts;
  auto section = add_section(main, "energy", "Energy balance");
  const double kinetic = f.kinetic_end - f.kinetic_start, potential = f.potential_end - f.potential_start;
  const auto row = [&](const std::string& name, double joules) {
    const bool timed = f.duration() > 0;
    return std::vector<std::string>{name, readable(joules, 6),
                                    timed ? readable(joules / f.duration()) : "\u2013"};
  };
  std::vector<std::vector<std::string>> rows{row("work of the walls on the balls", f.wall_work)};
  for (int k = 0; k < run.partners.count(); ++k)
    rows.push_back(row("dissipated, " + name_of(run.partners[k]), f.dose[k] == 0 ? 0 : -f.dose[k]));
  rows.push_back(row("supplied by the least separation speed", f.supplied_energy));
  rows.push_back(row("stored as kinetic energy of the balls", kinetic == 0 ? 0 : -kinetic));
  rows.push_back(row("stored as potential energy", potential == 0 ? 0 : -potential));
  const double scale = std::max({f.milling_dose, f.kinetic_start, f.kinetic_end});
  rows.push_back({"closure error, by rounding", readable(f.closure, 2),
                  scale > 0 ? readable(std::abs(f.closure) / scale, 2) + " of the " +
                                  (f.milling_dose < scale ? "kinetic energy" : "dose")
                            : "\u2013"});
  add_table(section, "ledger", "From the start of statistics to their end",
            {"part", "energy [J]", "rate [W]"}, rows);
}

namespace {

std::string law_text(const casefile::ContactSpec& c) {
  std::string text = c.name();
  c.parameters([&](const model::Parameter& p, const casefile::Quantity& value) {
    text += fmt::format(", {} = {}", p.key, brief(value.to<double>()));
  });
  return text + fmt::format(", least separation {} mm/s", brief(1000 * c.least_separation.to<double>()));
}

std::string ball_text(const casefile::BallSpec& ball, int count) {
  return fmt::format("{} of {} mm, {} kg/m\u00b3", count, brief(1000 * ball.diameter.to<double>()),
                     brief(ball.density.to<double>()));
}

}  // namespace

Rows case_rows(const RunFolder& run) {
  const auto& spec = run.spec;
  Rows rows;
  for (const auto& batch : spec.batches) rows.push_back({"balls", ball_text(batch, batch.count)});
  if (!spec.balls.empty())
    rows.push_back(
        {"balls placed individually", ball_text(spec.balls.front(), static_cast<int>(spec.balls.size()))});
  if (spec.powder_mass) rows.push_back({"powder", brief(1000 * spec.powder_mass->to<double>()) + " g"});
  rows.push_back({"vessel", casefile::describe(spec.vessel)});
  for (const auto& piston : spec.pistons)
    rows.push_back({"piston " + run.partners[piston.wall].label, casefile::describe(piston)});
  rows.push_back({"mill", casefile::describe(spec.mill)});
  rows.push_back({"gravity", casefile::describe_gravity(spec)});
  if (!spec.pairs_only) {
    rows.push_back({"contact of balls", law_text(spec.ball_ball)});
    rows.push_back({"contact with walls", law_text(spec.ball_wall)});
  }
  for (const auto& pair : spec.pairs)
    rows.push_back({"contact of " + spec.names_of(pair), law_text(pair.law)});
  return rows;
}

void add_case(pugi::xml_node main, const RunFolder& run) {
  const auto& spec = run.spec;
  const auto& f = run.facts;
  auto section = add_section(main, "case", "Case");
  auto rows = case_rows(run);
  rows.push_back({"statistics", fmt::format("{} s to {} s, ended by {}", brief(f.start_time, 12),
                                            brief(f.end_time, 12), model::name(f.end_reason))});
  rows.push_back({"seed, precision", fmt::format("{:.0f}, {}", f.seed, f.precision)});
  if (f.right_digits)
    rows.push_back({"right digits", fmt::format("{:.0f}, of every impact to the end", *f.right_digits)});
  rows.push_back({"least separation speed", fmt::format("{} % of the impacts, {} % of the dose",
                                                        readable(100 * f.touched_impact_share, 3),
                                                        readable(100 * f.touched_dose_share, 2))});
  rows.push_back({"stalls, without friction", fmt::format("{} % of the impacts, {} % of the dose",
                                                          readable(100 * f.stall_impact_share, 3),
                                                          readable(100 * f.stall_dose_share, 2))});
  rows.push_back({"deepest overlap", readable(f.deepest_overlap, 2) + " m"});
  rows.push_back({"program", fmt::format("edmill {} ({}), {}", f.version, f.commit, f.compiler)});
  rows.push_back({"CPU time", fmt::format("{} s for {} impacts", readable(f.cpu_seconds, 3),
                                          brief(f.impacts_since_start, 12))});
  for (const auto& setting : spec.settings) rows.push_back({"set over the case file", setting});
  rows.push_back({"digest of the case", f.case_digest});
  add_table(section, "run", "Run", {"name", "value"}, rows);
  auto details = add(section, "details");
  add(details, "summary", {}, "The case file");
  add(add(details, "pre", {{"tabindex", "0"}}), "code", {}, spec.text);
}

}  // namespace edmill::report
