// The page of a run: its frame, main results, warnings, energy balance and case.
#include "report/report_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/atomic_file.hpp"
#include "io/checkpoint_file.hpp"
#include "io/output_folder.hpp"
#include "report/embedded.hpp"
#include "report/sections.hpp"

namespace edmill::report {

namespace {

/// One line that identifies the case.
std::string subtitle_of(const RunFolder& run) {
  const auto& spec = run.spec;
  std::string text = fmt::format("{} balls", spec.ball_count());
  if (spec.batches.size() == 1 && spec.balls.empty())
    text += fmt::format(" of {} mm", brief(1000 * spec.batches[0].diameter.to<double>()));
  if (spec.powder_mass) text += fmt::format(", {} g of powder", brief(1000 * spec.powder_mass->to<double>()));
  const auto mill = casefile::name_of(spec.mill);
  if (mill == "still") return text + ", in a still vessel";
  return text + fmt::format(", {} at {} rpm", mill == "spex8000" ? "SPEX 8000" : mill,
                            brief(60 / casefile::period_of(spec.mill).to<double>()));
}

std::string player() {
  return fmt::format("<script>\n/* {}*/\n{}\n{}</script>\n<script>\n{}</script>\n", three_licence, three_js,
                     three_orbit_js, page_js);
}

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

void add_headline(pugi::xml_node main, const RunFolder& run) {
  const auto& f = run.facts;
  auto section = add_section(main, "results", "Results");
  add(section, "p", {},
      fmt::format("{} collisions between {} s and {} s of simulated time.", brief(f.all_collisions(), 12),
                  brief(f.start_time, 12), brief(f.end_time, 12)));
  auto list = add(section, "dl", {{"class", "cards"}});
  bool any = false;
  for (const auto& [name, unit, rate] : main_rates(f)) {
    if (!rate || !(f.duration() > 0)) continue;
    auto box = add(list, "div", {{"class", "card"}});
    add(box, "dt", {}, capitalised(name));
    auto value = add(box, "dd", {{"data-unit", unit}, {"data-value", fmt::format("{}", rate->value)}});
    const auto [number, width] = plot::with_interval(rate->value, rate->half_width.value_or(0));
    add(value, "strong", {}, number);
    add(value, "span", {{"class", "unit"}}, " " + unit);
    if (rate->half_width) {
      any = true;
      value.append_attribute("data-interval") = fmt::format("{}", *rate->half_width).c_str();
      add(box, "dd", {{"class", "interval"}}, "\u00b1 " + width + " " + unit);
    }
  }
  add_note(
      section,
      any ? fmt::format("\u00b1: 95 % interval of this run, Student\u2019s t over {} batches of {} s, whole "
                        "drive periods. It covers longer runs of the same mill; other seeds may settle at "
                        "another mean (edmill sweep).",
                        brief(f.batches), readable(f.batch_length))
          : "Too short for intervals: fewer than 5 drive periods.");
  if (f.target_dose)
    add_note(section, f.milling_time
                          ? fmt::format("Milling time to {} kJ/g, counting {}.",
                                        readable(*f.target_dose / 1e6), f.target_counts)
                          : fmt::format("No milling time to {} kJ/g: nothing of the dose counts ({}).",
                                        readable(*f.target_dose / 1e6), f.target_counts));
}

void add_warnings(pugi::xml_node main, const RunFolder& run) {
  const auto& warnings = run.facts.warnings;
  if (warnings.empty()) return;
  auto list = add(add_section(main, "warnings", warnings.size() == 1 ? "A warning" : "Warnings"), "ul");
  for (const auto& [kind, text] : warnings) add(list, "li", {{"data-kind", kind}}, text);
}

void add_energy(pugi::xml_node main, const RunFolder& run) {
  const auto& f = run.facts;
  auto section = add_section(main, "energy", "Energy balance");
  const double kinetic = f.kinetic_end - f.kinetic_start, potential = f.potential_end - f.potential_start;
  const auto row = [&](const std::string& name, double joules) {
    const bool timed = f.duration() > 0;
    return std::vector<std::string>{name, readable(joules, 6),
                                    timed ? readable(joules / f.duration()) : "\u2013"};
  };
  Rows rows{row("work of the walls on the balls", f.wall_work)};
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

std::string page_of_run(const RunFolder& run) {
  pugi::xml_document document;
  auto main = add(document, "main");
  add_headline(main, run);
  add_warnings(main, run);
  auto pair = add(main, "div", {{"class", "pair"}});
  add_animation(pair, run);
  add_ward(pair, run);
  add_rates(main, run);
  add_spectra(main, run);
  add_vessel(main, run);
  add_treatment(main, run);
  add_ball_speeds(main, run);
  add_exponents(main, run);
  add_energy(main, run);
  add_case(main, run);
  const bool plays = static_cast<bool>(main.select_node("//div[@id='player']"));
  const auto title = std::filesystem::path(run.facts.case_file).filename().string();
  return page_of({title, subtitle_of(run), run.facts.version, run.facts.commit, document,
                  plays ? player() : "", plays ? "The animation is played by three.js (MIT licence)." : ""});
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

std::filesystem::path write_report(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder)) read_run_folder(folder);  // says what is missing
  const io::FolderLock alone(folder);
  // Removes what killed processes have left; an unfinished run goes on with its own files, which stay.
  if (!std::filesystem::exists(io::checkpoint_place(folder))) io::remove_temporaries(folder);
  return put_report(folder);
}

std::filesystem::path put_report(const std::filesystem::path& folder) {
  const auto page = page_of_run(read_run_folder(folder));
  auto place = folder / "report.html";
  io::AtomicFile file(place);
  file.stream() << page;
  file.complete();
  io::record_files(folder, file.places());
  file.commit();
  return place;
}

}  // namespace edmill::report
