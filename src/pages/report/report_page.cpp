// The page of a run: its frame, main results, warnings, energy balance and case.
#include "report/report_page.hpp"

#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "io/atomic_file.hpp"
#include "io/checkpoint_file.hpp"
#include "io/input_file.hpp"
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
  if (spec.powder_mass)
    text += fmt::format(", {} g of powder", brief(1000 * spec.powder_mass->to<double>()));
  const auto mill = casefile::name_of(spec.mill);
  if (mill == "still") return text + ", in a still vessel";
  return text +
      fmt::format(", {} at {} rpm", mill == "spex8000" ? "SPEX 8000" : mill,
          brief(60 / casefile::period_of(spec.mill).to<double>()));
}

std::string law_text(const casefile::ContactSpec& c) {
  std::string text = c.name();
  c.parameters([&](const model::Parameter& p, const casefile::Quantity& value) {
    text += fmt::format(", {} = {}", p.key, brief(value.to<double>()));
  });
  return text +
      fmt::format(", least separation {} mm/s", brief(1000 * c.least_separation.to<double>()));
}

/// @param entry  key of the entry in the file, "balls.0"; numbers are shown in its units
std::string ball_text(const casefile::CaseSpec& spec, const casefile::BallSpec& ball, auto count,
    const std::string& entry) {
  const auto in_file = [&](const char* key) { return casefile::text_of_key(spec, entry + key); };
  return fmt::format("{} of {}, {}", count,
      in_file(".diameter").value_or(brief(1000 * ball.diameter.to<double>()) + " mm"),
      in_file(".density").value_or(brief(ball.density.to<double>()) + " kg/m\u00b3"));
}

/// Says on the card of a dose rate or milling time what makes it doubtful, with links to the
/// warnings.
void add_doubts(pugi::xml_node card, const io::Facts& f) {
  for (const auto& [kind, text] : {std::pair{"several_states", "other seeds may settle elsewhere"},
           std::pair{"transient", "not steady yet"},
           std::pair{"too_few_collisions", "too few collisions"},
           std::pair{"too_short", "too short for an interval"},
           std::pair{"wide_interval", "known to 5 % or worse"},
           std::pair{"precision", "less precise than asked for"}})
    if (f.has(std::string("warnings/") + kind))
      add(add(card, "dd", {{"class", "doubt"}}), "a", {{"href", "#warnings"}}, text);
}

void add_headline(pugi::xml_node main, const RunFolder& run) {
  const auto& f = run.facts;
  auto section = add_section(main, "results", "Results");
  add(section, "p", {},
      fmt::format("{} collisions between {} s and {} s of simulated time, {} of them contacts at "
                  "rest, which give {} of the dose.",
          brief(f.number("collisions/total"), 12), brief(f.number("start_time"), 12),
          brief(f.number("end_time"), 12),
          percent(f.find("least_separation/impact_share").value_or(0)),
          percent(f.find("least_separation/milling_dose_share").value_or(0))));
  auto list = add(section, "dl", {{"class", "cards"}});
  bool any = false;
  for (const auto& [name, unit, rate] : main_rates(f)) {
    if (!rate) continue;
    auto box = add(list, "div", {{"class", "card"}});
    add(box, "dt", {}, capitalised(name));
    auto value =
        add(box, "dd", {{"data-unit", unit}, {"data-value", fmt::format("{}", rate->value)}});
    const auto [number, width] = plot::with_interval(rate->value, rate->half_width.value_or(0));
    add(value, "strong", {}, number);
    add(value, "span", {{"class", "unit"}}, " " + unit);
    if (rate->half_width) {
      any = true;
      value.append_attribute("data-interval") = fmt::format("{}", *rate->half_width).c_str();
      add(box, "dd", {{"class", "interval"}}, "\u00b1 " + width + " " + unit);
    }
    if (name.find("dose rate") != name.npos || name == "milling time") add_doubts(box, f);
  }
  add_note(section,
      any ? fmt::format("\u00b1: 95 % interval of this run, from {} batches of {} s, whole drive "
                        "periods. It covers longer runs of the same mill; other seeds may settle "
                        "at another mean (edmill run --seeds 8).",
                brief(f.number("intervals/batches")), readable(f.number("intervals/batch_length")))
          : "Too short for intervals: fewer than 5 drive periods.");
  if (const auto dose = f.find("target/dose"))
    add_note(section,
        fmt::format(fmt::runtime(f.find("target/milling_time")
                            ? "Milling time to {} kJ/g, counting {}."
                            : "No milling time to {} kJ/g: nothing of the dose counts ({})."),
            readable(*dose / 1e6), f.text("target/counts")));
}

void add_warnings(pugi::xml_node main, const RunFolder& run) {
  const auto kinds = run.facts.keys_of("warnings");
  if (kinds.empty()) return;
  auto list =
      add(add_section(main, "warnings", kinds.size() == 1 ? "A warning" : "Warnings"), "ul");
  for (const auto& kind : kinds)
    add(list, "li", {{"data-kind", kind}}, run.facts.text("warnings/" + kind));
}

void add_energy(pugi::xml_node main, const RunFolder& run) {
  const auto& f = run.facts;
  auto section = add_section(main, "energy", "Energy balance");
  const double duration = f.number("duration");
  const auto row = [&](const std::string& name, double joules) {
    return std::vector<std::string>{
        name, readable(joules, 6), duration > 0 ? readable(joules / duration) : "\u2013"};
  };
  const auto less = [&](const std::string& name, double joules) {
    return row(name, joules == 0 ? 0 : -joules);
  };
  const auto gain = [&](const std::string& energy) {
    return f.number("energy/" + energy + "_end") - f.number("energy/" + energy + "_start");
  };
  Rows rows{row("work of the walls on the balls", f.number("wall_work"))};
  for (int k = 0; k < run.partners.count(); ++k)
    rows.push_back(less("dissipated, " + typeset(run.partners[k].label),
        f.number("milling_dose_by_partner/" + run.partners[k].key)));
  rows.push_back(
      row("supplied by the least separation speed", f.number("least_separation/supplied_energy")));
  rows.push_back(less("stored as kinetic energy of the balls", gain("kinetic")));
  rows.push_back(less("stored as potential energy", gain("potential")));
  const auto closure = f.find("energy/closure_relative");
  rows.push_back({"closure error, by rounding", readable(f.number("energy/closure"), 2),
      closure ? readable(std::abs(*closure), 2) + " of the " + io::energy_scale_of(f) : "\u2013"});
  add_table(section, "ledger", "From the start of statistics to their end",
      {"part", "energy [J]", "rate [W]"}, rows);
}

void add_case(pugi::xml_node main, const RunFolder& run) {
  const auto& spec = run.spec;
  const auto& f = run.facts;
  auto section = add_section(main, "case", "Case");
  auto rows = case_rows(run);
  rows.push_back({"statistics",
      fmt::format("{}, ended by {}", time_window(f), model::name(io::end_reason_of(f)))});
  rows.push_back(
      {"seed, precision", fmt::format("{:.0f}, {}", f.number("seed"), f.text("precision"))});
  if (const auto digits = f.find("right_digits"))
    rows.push_back({"right digits", fmt::format("{:.0f}, of every impact to the end", *digits)});
  const auto share = [&](const std::string& group) {
    return fmt::format("{} % of the impacts, {} % of the dose",
        readable(100 * f.number(group + "/impact_share"), 3),
        readable(100 * f.number(group + "/milling_dose_share"), 2));
  };
  rows.push_back({"least separation speed", share("least_separation")});
  rows.push_back({"stalls, without friction", share("stalls")});
  rows.push_back({"deepest overlap", readable(f.number("deepest_overlap"), 2) + " m"});
  rows.push_back({"program",
      fmt::format("edmill {} ({}), {}", f.text("version"), f.text("commit"), f.text("compiler"))});
  rows.push_back({"CPU time",
      fmt::format("{} s for {} impacts", readable(f.number("cpu_seconds"), 3),
          brief(f.number("impacts_since_start"), 12))});
  for (const auto& setting : spec.settings) rows.push_back({"set over the case file", setting});
  rows.push_back({"digest of the case", f.text("case_digest")});
  add_table(section, "run", "Run", {"name", "value"}, rows);
  auto details = add(section, "details");
  add(details, "summary", {}, "The case file");
  add(add(details, "pre", {{"tabindex", "0"}}), "code", {}, spec.text);
}

void add_check(pugi::xml_node main, const RunFolder& run) {
  const auto file = run.place / check_file;
  if (!std::filesystem::exists(file)) return;
  auto section = add_section(main, "check", "What decides the dose rate");
  // Lines of the table have a deeper indent, and columns at least two blanks between them.
  Rows rows;
  std::vector<std::string> sentences;
  std::istringstream lines(io::content_of(file));
  for (std::string line; std::getline(lines, line);) {
    const bool in_table = line.starts_with("    ");
    std::vector<std::string> cells;
    for (std::size_t from = line.find_first_not_of(' '); from < line.size();
         from = line.find_first_not_of(' ', from)) {
      const auto end = in_table ? std::min(line.find("  ", from), line.size()) : line.size();
      cells.push_back(line.substr(from, end - from));
      from = end;
    }
    if (in_table) {
      cells.resize(3);
      rows.push_back(std::move(cells));
    } else if (!cells.empty() && !rows.empty()) {
      sentences.push_back(capitalised(cells[0]) + ".");
    }
  }
  for (const auto& sentence : sentences) add(section, "p", {}, sentence);
  add_table(section, "check-runs", "Runs of the case with one thing changed in each",
      {"run", "dose rate", "effect"}, rows);
  add_note(section, "Dose rates differ where their intervals are apart.");
}

std::string page_of_run(const RunFolder& run) {
  pugi::xml_document document;
  auto main = add(document, "main");
  for (const auto part :
      {add_headline, add_warnings, add_animation, add_rates, add_check, add_spectra, add_vessel,
          add_treatment, add_ball_speeds, add_exponents, add_energy, add_case})
    part(main, run);
  const bool plays = static_cast<bool>(main.select_node("//div[@id='player']"));
  const auto title = std::filesystem::path(run.facts.text("case_file")).filename().string();
  return page_of({title, subtitle_of(run), run.facts.text("version"), run.facts.text("commit"),
      document, plays ? fmt::format("<script>\n{}{}</script>\n", mill_view_js, page_js) : ""});
}

}  // namespace

Rows case_rows(const RunFolder& run) {
  const auto& spec = run.spec;
  const auto written_in = [&spec](const std::string& section) {
    return [&spec, section](
               const std::string& key) { return casefile::text_of_key(spec, section + "." + key); };
  };
  Rows rows;
  for (std::size_t k = 0; const auto& batch : spec.batches)
    rows.push_back({"balls", ball_text(spec, batch, batch.count, fmt::format("balls.{}", k++))});
  if (const auto& balls = spec.balls; !balls.empty())
    rows.push_back(
        {"balls placed individually", ball_text(spec, balls[0], balls.size(), "ball.0")});
  if (spec.powder_mass)
    rows.push_back({"powder", brief(1000 * spec.powder_mass->to<double>()) + " g"});
  rows.push_back({"vessel", casefile::describe(spec.vessel, written_in("vessel"))});
  for (const auto& body : spec.bodies) rows.push_back({body.name, casefile::describe(body)});
  for (const auto& piston : spec.pistons)
    rows.push_back({"piston " + run.partners[piston.wall].label, casefile::describe(piston)});
  rows.push_back({"mill", casefile::describe(spec.mill, written_in("mill"))});
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
  // Removes temporary files of killed processes, but not those of a run that can continue.
  if (!std::filesystem::exists(io::checkpoint_place(folder))) io::remove_temporaries(folder);
  return put_report(folder);
}

std::filesystem::path put_report(const std::filesystem::path& folder) {
  const auto page = page_of_run(read_run_folder(folder));
  const auto place = folder / "report.html";
  io::AtomicFile file(place);
  file.stream() << page;
  file.complete();
  io::record_files(folder, {file.place()});
  file.commit();
  return place;
}

}  // namespace edmill::report
