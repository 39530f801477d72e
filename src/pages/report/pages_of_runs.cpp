// The pages of many runs: side by side, and those of a study.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <ranges>
#include <set>

#include "base/statistics.hpp"
#include "base/version.hpp"
#include "casefile/quantity.hpp"
#include "io/output_folder.hpp"
#include "report/report_page.hpp"
#include "report/sections.hpp"
#include "study/study.hpp"

namespace edmill::report {

namespace {

using study::Point;

/// Names the runs by their folders; folders with the same name are named by their whole paths.
void name_runs(std::vector<RunFolder>& runs) {
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const auto own = (runs[k].place / "").parent_path().filename().string();
    const bool alone = std::ranges::count_if(runs, [&](const RunFolder& r) {
      return (r.place / "").parent_path().filename() == own;
    }) == 1;
    runs[k].name = alone ? own : fmt::format("{} ({})", runs[k].place.string(), k + 1);
  }
}

/// Whether two rates differ: the 95 % interval of their difference, by half-widths in quadrature,
/// leaves out zero. Nothing where a rate has no interval.
std::optional<bool> differ(const RateOf& a, const RateOf& b) {
  if (!a.half_width || !b.half_width) return std::nullopt;
  return std::abs(a.value - b.value) > std::hypot(*a.half_width, *b.half_width);
}

/// "+12 %", with a word where the difference may be noise.
std::string against(const RateOf& rate, const RateOf& first) {
  const auto apart = differ(rate, first);
  std::string change = "\u2013";
  if (first.value != 0) {
    const double percent = 100 * (rate.value / first.value - 1);
    change = fmt::format("{}{:.1f} %", percent < 0 ? "\u2212" : "+", std::abs(percent));
  }
  return !apart ? change + ", no interval"
      : *apart  ? change + ", significant"
                : change + ", not significant";
}

void add_rates_of(pugi::xml_node main, const std::vector<RunFolder>& runs) {
  auto section = add_section(main, "rates", "Rates");
  Rows rows;
  const auto first_run = main_rates(runs.front().facts);
  for (std::size_t k = 0; k < first_run.size(); ++k) {
    const auto& [name, unit, first] = first_run[k];
    std::vector<std::string> row{name + " [" + unit + "]"};
    bool any = false;
    for (const auto& run : runs) {
      const auto rate = main_rates(run.facts)[k].rate;
      any = any || rate;
      row.push_back(!rate ? "\u2013" : text_of(*rate));
      if (&run != &runs.front()) row.push_back(rate && first ? against(*rate, *first) : "\u2013");
    }
    if (any) rows.push_back(std::move(row));
  }
  std::vector<std::string> headings{"quantity"};
  for (const auto& run : runs) {
    headings.push_back(run.name);
    if (&run != &runs.front()) headings.push_back("against " + runs.front().name);
  }
  add_table(section, "rates-of-runs", "Rates of the runs", headings, rows);
  add_note(section,
      "\u00b1: 95 % interval of the run. A difference is significant where the 95 % interval of "
      "the difference, the half-widths added in quadrature, leaves out zero; of twenty comparisons "
      "of equal mills one is so by chance.");
}

/// Each dose rate as a bar with its interval, at the number of the run.
void draw_dose_rates(pugi::xml_node grid, const std::vector<RunFolder>& runs) {
  plot::Chart chart{"dose-rates", "Milling dose rate",
      "For each run a bar as high as its milling dose rate, with its 95 % interval.",
      {"number of the run", 0.4, static_cast<double>(runs.size()) + 0.6, false, true},
      {"milling dose rate [W]"}};
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const auto rate = rate_in(runs[k].facts, "milling_dose_rate");
    if (!rate) continue;
    const double place = static_cast<double>(k) + 1;
    const auto colour = run_colour(k);
    chart.bands.push_back(
        {colour, {place - 0.25, place + 0.25}, {0, 0}, {rate->value, rate->value}});
    add_level(chart, place - 0.25, place + 0.25, *rate, fmt::format("{}: {}", k + 1, runs[k].name),
        colour);
    chart.y.high = std::max(chart.y.high, 1.1 * (rate->value + rate->half_width.value_or(0)));
  }
  draw(grid, chart);
}

void draw_over_time(pugi::xml_node grid, const std::vector<RunFolder>& runs) {
  plot::Chart chart{"dose-rate", "Milling dose rate over time",
      "Lines of the milling dose rate of each run over the simulated time.", {"time [s]", 0, 0},
      {"milling dose rate [W]"}};
  for (std::size_t k = 0; k < runs.size(); ++k)
    if (const auto series = rate_of(runs[k], "milling_dose", 60)) {
      chart.curves.push_back({runs[k].name, run_colour(k), points_of(*series)});
      chart.x.high = std::max(chart.x.high, series->back().end);
    }
  if (chart.curves.empty()) return;
  draw_fitted(grid, chart);
}

/// Adds a table of the keys in which the cases differ.
void add_differences(pugi::xml_node main, const std::vector<RunFolder>& runs) {
  Rows rows;  // a key, and what each run has for it
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const auto& f = runs[k].facts;
    auto own = case_rows(runs[k]);
    own.push_back({"statistics", time_window(f)});
    own.push_back(
        {"seed, precision", fmt::format("{:.0f}, {}", f.number("seed"), f.text("precision"))});
    own.push_back({"program", fmt::format("edmill {} ({})", f.text("version"), f.text("commit"))});
    for (const auto& fact : own) {
      auto row = std::ranges::find_if(rows, [&](const auto& r) { return r[0] == fact[0]; });
      if (row == rows.end()) {
        row = rows.emplace(row, runs.size() + 1);
        row->front() = fact[0];
      }
      auto& text = (*row)[k + 1];
      text += (text.empty() ? "" : "; ") + fact[1];
    }
  }
  std::erase_if(rows, [](const auto& row) {
    return std::adjacent_find(row.begin() + 1, row.end(), std::not_equal_to<>()) == row.end();
  });
  for (auto& row : rows) std::ranges::replace(row, std::string(), "\u2013");
  auto section = add_section(main, "cases", "What differs in the cases");
  if (rows.empty()) {
    add(section, "p", {}, "Nothing: all runs are of one case.");
    return;
  }
  std::vector<std::string> headings{"key"};
  for (const auto& run : runs) headings.push_back(run.name);
  add_table(section, "differences", "Differences", headings, rows);
}

void add_warnings_of(pugi::xml_node main, const std::vector<RunFolder>& runs) {
  if (std::ranges::all_of(
          runs, [](const RunFolder& run) { return run.facts.keys_of("warnings").empty(); }))
    return;
  auto list = add(add_section(main, "warnings", "Warnings"), "ul");
  for (const auto& run : runs)
    for (const auto& kind : run.facts.keys_of("warnings"))
      add(list, "li", {{"data-kind", kind}}, run.name + ": " + run.facts.text("warnings/" + kind));
}

std::string page_of_runs(const std::vector<RunFolder>& runs) {
  pugi::xml_document document;
  auto main = add(document, "main");
  add_rates_of(main, runs);
  auto grid = add(add_section(main, "charts", "Dose rates"), "div", {{"class", "charts"}});
  draw_dose_rates(grid, runs);
  draw_over_time(grid, runs);
  add_warnings_of(main, runs);
  add_differences(main, runs);
  add_spectra_of(main, runs);
  const auto names = runs | std::views::transform(&RunFolder::name);
  return page_of({fmt::format("{} runs compared", runs.size()),
      fmt::format("{}", fmt::join(names, ", ")), version(), commit(), document});
}

/// Positions of the points in a chart: the values of the key that varies, if they are numbers of
/// one unit, or else the points' numbers. If a second key varies, each of its values has a curve.
struct Places {
  std::string title = "point";
  std::vector<double> x;
  std::vector<std::string> curves{""};  ///< their names
  std::vector<std::size_t> curve;       ///< of each point
  bool over_a_key = false;

  explicit Places(const std::vector<Point>& points) : curve(points.size()) {
    for (std::size_t k = 0; k < points.size(); ++k) x.push_back(static_cast<double>(k) + 1);
    auto keys = study::varied_keys(points);
    if (keys.size() == 2 && number_of_values(points, keys[1]) > number_of_values(points, keys[0]))
      std::swap(keys[0], keys[1]);
    if (keys.empty() || keys.size() > 2 || !take(points, keys[0])) return;
    over_a_key = true;
    if (keys.size() == 1) return;
    curves.clear();
    for (std::size_t k = 0; k < points.size(); ++k) {
      const auto name = keys[1] + " = " + study::value_of(points[k], keys[1]);
      curve[k] = static_cast<std::size_t>(std::ranges::find(curves, name) - curves.begin());
      if (curve[k] == curves.size()) curves.push_back(name);
    }
  }
 private:
  static std::size_t number_of_values(const std::vector<Point>& points, const std::string& key) {
    std::set<std::string> values;
    for (const auto& point : points)
      if (casefile::split_number(study::value_of(point, key)))
        values.insert(study::value_of(point, key));
    return values.size();
  }
  /// @return whether all values of this key are numbers of one unit
  bool take(const std::vector<Point>& points, const std::string& key) {
    std::vector<double> values;
    std::string unit;
    for (const auto& point : points) {
      const auto value = casefile::split_number(study::value_of(point, key));
      if (!value || (!values.empty() && value->second != unit)) return false;
      unit = value->second;
      values.push_back(value->first);
    }
    title = key + (unit.empty() ? "" : " [" + unit.substr(unit[0] == ' ') + "]");
    x = values;
    return true;
  }
};

void draw_points(pugi::xml_node grid, const std::vector<Point>& points, const Places& places,
    const study::Quantity& what) {
  const auto [low, high] = std::ranges::minmax(places.x);
  const double room = high > low ? 0.08 * (high - low) : 0.6,
               width = places.over_a_key ? 0.25 * room : 0.5 * room;
  plot::Chart chart{what.name, capitalised(what.title),
      fmt::format("For each point a short line at its {}, within its 95 % interval; one for each "
                  "steady state.",
          what.title),
      {places.title, low - room, high + room, false, !places.over_a_key},
      {fmt::format("{} [{}]", what.title, what.unit)}};
  std::vector<plot::Curve> curves;
  for (std::size_t c = 0; c < places.curves.size(); ++c)
    curves.push_back({places.curves[c], run_colour(c), {}});
  for (std::size_t k = 0; k < points.size(); ++k) {
    auto& curve = curves[places.curve[k]];
    const auto found = points[k].estimate(what);
    const auto level = [&](double mean, const std::optional<double>& half_width) {
      add_level(chart, places.x[k] - width, places.x[k] + width,
          RateOf{mean, half_width}.in_units_of(what.size), "", curve.colour);
    };
    for (const auto& state : found.states) level(state.mean, state.half_width);
    if (!found.states.empty() || !found.mean) continue;
    level(*found.mean, found.half_width);
    curve.points.emplace_back(places.x[k], *found.mean / what.size);
  }
  for (auto& curve : curves) {
    std::ranges::sort(curve.points);
    if (places.over_a_key && curve.points.size() > 1) chart.curves.push_back(std::move(curve));
  }
  if (chart.curves.empty()) return;
  draw_fitted(grid, chart);
}

/// Quotes a word for a shell.
std::string quoted(const std::string& word) {
  const auto* safe = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,%@";
  if (!word.empty() && word.find_first_not_of(safe) == word.npos) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? "'\\''" : std::string(1, c);
  return out + "'";
}

/// The command that makes a run again, with a report.
std::string command_of(const study::Job& job, const std::string& folder) {
  auto text = "edmill run " + quoted(job.case_file);
  for (const auto& setting : job.overrides) text += " --set " + quoted(setting);
  return text + " --report --out " + quoted(folder);
}

void add_runs(pugi::xml_node main, const std::vector<Point>& points) {
  auto section = add_section(main, "runs", "Runs");
  add_note(section,
      "The record of each run, and the command that makes it again with a report of its own.");
  for (std::size_t k = 0; k < points.size(); ++k) {
    auto details = add(section, "details", {{"class", "runs"}});
    add(details, "summary", {}, fmt::format("{}: {}", k + 1, study::name_of(points, k)));
    auto list = add(details, "ul");
    for (const auto& run : points[k].runs) {
      auto item = add(list, "li");
      std::string text = fmt::format("seed {}: ", run.seed);
      const auto rate = run.record ? rate_in(run.record->facts, "milling_dose_rate") : std::nullopt;
      if (!run.record)
        text += "not run";
      else if (!run.record->done())
        text += run.record->status + ", " + run.record->message;
      else if (rate)
        text += text_of(*rate) + " W";
      add(item, "span", {}, text);
      if (run.job.digest.empty()) continue;
      auto lines = add(item, "ul");
      if (run.record && run.record->lasting())
        add(add(lines, "li"), "a", {{"href", "runs/" + run.job.digest + ".json"}},
            fmt::format("record of seed {}", run.seed));
      add(add(lines, "li"), "code", {},
          command_of(run.job, fmt::format("run-{}-{}", k + 1, run.seed)));
    }
  }
}

}  // namespace

void write_comparison(const std::vector<std::string>& folders, const std::filesystem::path& file) {
  std::vector<RunFolder> runs;
  for (const auto& folder : folders) runs.push_back(read_run_folder(folder));
  name_runs(runs);
  io::NamedFile(file).write(page_of_runs(runs));
}

std::string study_page(
    const study::Study& study, const std::string& kind, const std::string& finding) {
  const auto& points = study.points();
  pugi::xml_document document;
  auto main = add(document, "main");
  if (!finding.empty())
    add(add_section(main, "finding", "Finding"), "pre", {{"tabindex", "0"}}, finding);
  auto section = add_section(main, "points", "Points");
  std::vector<std::string> headings{"point", "name", "runs"};
  for (const auto& what : study::main_quantities()) headings.push_back(what.title);
  Rows rows;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto& point = points[k];
    const auto failed = point.failed();
    std::vector<std::string> row{std::to_string(k + 1), study::name_of(points, k),
        std::to_string(point.done()) + (failed > 0 ? fmt::format(", {} failed", failed) : "")};
    for (const auto& what : study::main_quantities())
      row.push_back(study::text_of(point.estimate(what), what));
    rows.push_back(std::move(row));
  }
  add_table(section, "rates-of-points", "Rates", headings, rows);
  add_note(section,
      "\u00b1: 95 % interval, from the intervals of the runs and their scatter; where seeds settle "
      "in several steady states, each with the number of its runs. All numbers:");
  auto files = add(section, "ul");
  add(add(files, "li"), "a", {{"href", study.name() + ".csv"}},
      study.name() + ".csv: a row for each point");
  add(add(files, "li"), "a", {{"href", "runs.csv"}}, "runs.csv: a row for each run");
  auto grid = add(add_section(main, "charts", "Charts"), "div", {{"class", "charts"}});
  const Places places(points);
  for (const auto& what : study::main_quantities()) draw_points(grid, points, places, what);
  add_runs(main, points);
  const auto counts = study.counts();
  return page_of({kind + ", " + std::filesystem::path(study.file()).filename().string(),
      fmt::format("{} point{}, {} runs, {} failed{}", points.size(), points.size() == 1 ? "" : "s",
          counts.total, counts.failed, study.interrupted() ? ", interrupted" : ""),
      version(), commit(), document});
}

}  // namespace edmill::report
