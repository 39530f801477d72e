// The page of a sweep or an optimisation.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "base/statistics.hpp"
#include "base/version.hpp"
#include "casefile/quantity.hpp"
#include "report/page.hpp"
#include "report/report_page.hpp"
#include "report/sections.hpp"
#include "study/study.hpp"

namespace edmill::report {

using plot::add;
using study::Point;

namespace {

/// What the page shows of each point, and in which units.
struct Shown {
  const char *quantity, *name, *unit;
  double size;  ///< of the unit, in SI
};
constexpr Shown shown[] = {{"milling_dose_rate", "milling dose rate", "W", 1},
                           {"specific_milling_dose_rate", "specific milling dose rate", "W/kg", 1},
                           {"milling_time", "milling time", "h", 3600}};

/// Of a point's runs; of one run alone, its own interval.
std::optional<RateOf> rate_of_point(const Point& point, const Shown& what) {
  const auto e = numerics::estimate(point.values(study::quantity_named(what.quantity)));
  if (!e.mean) return std::nullopt;
  auto rate = RateOf{*e.mean, e.half_width}.in_units_of(what.size);
  if (point.done() != 1) return rate;
  const auto& run =
      std::ranges::find_if(point.runs, [](const auto& r) { return r.record && r.record->done(); });
  const double dose_rate = *study::quantity_named("milling_dose_rate").of(*run->record);
  if (run->record->dose_rate_half_width && dose_rate > 0)
    rate.half_width = rate.value * *run->record->dose_rate_half_width / dose_rate;
  return rate;
}

std::string name_of_point(const Point& point, std::size_t index) {
  std::string name = point.name;
  for (const auto& [key, value] : point.settings)
    if (point.name.empty()) name += fmt::format("{}{} = {}", name.empty() ? "" : ", ", key, value);
  return name.empty() ? fmt::format("point {}", index + 1) : name;
}

/// The axis of the points: the value of the only key that varies, where it is a number, or their numbers.
struct Places {
  std::string title = "point";
  std::vector<double> x;

  explicit Places(const std::vector<Point>& points) {
    for (std::size_t k = 0; k < points.size(); ++k) x.push_back(static_cast<double>(k) + 1);
    std::vector<double> values;
    std::string unit;
    for (const auto& point : points) {
      if (point.settings.size() != 1 || point.settings[0].first != points[0].settings[0].first) return;
      const auto value = casefile::split_number(point.settings[0].second);
      if (!value || (!values.empty() && value->second != unit)) return;
      unit = value->second;
      values.push_back(value->first);
    }
    title = points[0].settings[0].first + (unit.empty() ? "" : " [" + unit.substr(unit[0] == ' ') + "]");
    x = values;
  }
};

void draw_points(pugi::xml_node grid, const std::vector<Point>& points, const Places& places,
                 const Shown& what) {
  plot::Chart chart;
  chart.id = what.quantity, chart.title = capitalised(what.name);
  chart.description =
      fmt::format("For each point a short line at its {}, within its 95 % interval.", what.name);
  const auto [low, high] = std::ranges::minmax(places.x);
  const double room = high > low ? 0.08 * (high - low) : 0.6;
  chart.x = {places.title, low - room, high + room, false};
  chart.y.title = fmt::format("{} [{}]", what.name, what.unit);
  double top = 0;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (const auto rate = rate_of_point(points[k], what)) {
      add_point(chart, places.x[k], 0.5 * room, *rate, "", "c0");
      top = std::max(top, rate->value + rate->half_width.value_or(0));
    }
  if (chart.curves.empty()) return;
  chart.y.high = top > 0 ? 1.1 * top : 1;
  draw(grid, chart);
}

/// As one word of a shell.
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
  add(section, "p", {{"class", "note"}},
      "The record of each run, and the command that makes it again with a report of its own.");
  const auto dose_rate = study::quantity_named("milling_dose_rate");
  for (std::size_t k = 0; k < points.size(); ++k) {
    auto details = add(section, "details", {{"class", "runs"}});
    add(details, "summary", {}, fmt::format("{}: {}", k + 1, name_of_point(points[k], k)));
    auto list = add(details, "ul");
    for (const auto& run : points[k].runs) {
      auto item = add(list, "li");
      std::string text = fmt::format("seed {}: ", run.seed);
      const auto rate = run.record ? dose_rate.of(*run.record) : std::nullopt;
      if (!run.record)
        text += "not run";
      else if (!run.record->done())
        text += run.record->status + ", " + run.record->message;
      else if (rate)
        text += text_of({*rate, run.record->dose_rate_half_width}) + " W";
      add(item, "span", {}, text);
      if (run.job.digest.empty()) continue;
      auto lines = add(item, "ul");
      if (run.record && run.record->lasting())
        add(add(lines, "li"), "a", {{"href", "runs/" + run.job.digest + ".json"}},
            fmt::format("record of seed {}", run.seed));
      add(add(lines, "li"), "code", {}, command_of(run.job, fmt::format("run-{}-{}", k + 1, run.seed)));
    }
  }
}

}  // namespace

std::string study_page(const study::Study& study, const std::string& kind, const std::string& finding) {
  const auto& points = study.points();
  pugi::xml_document document;
  auto main = add(document, "main");
  if (!finding.empty()) {
    auto section = add_section(main, "finding", "Finding");
    add(section, "pre", {{"tabindex", "0"}}, finding);
  }
  auto section = add_section(main, "points", "Points");
  std::vector<std::string> headings{"point", "name", "runs"};
  for (const auto& what : shown) headings.push_back(fmt::format("{} [{}]", what.name, what.unit));
  Rows rows;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto& point = points[k];
    const auto failed = point.failed();
    std::vector<std::string> row{
        std::to_string(k + 1), name_of_point(point, k),
        std::to_string(point.done()) + (failed > 0 ? fmt::format(", {} failed", failed) : "")};
    for (const auto& what : shown) {
      const auto rate = rate_of_point(point, what);
      row.push_back(rate ? text_of(*rate) : "\u2013");
    }
    rows.push_back(std::move(row));
  }
  add_table(section, "rates-of-points", "Rates", headings, rows);
  add(section, "p", {{"class", "note"}},
      "\u00b1: 95 % interval by Student\u2019s t over the runs of a point; of a single run, its own "
      "interval. All numbers:");
  auto files = add(section, "ul");
  add(add(files, "li"), "a", {{"href", study.name() + ".csv"}}, study.name() + ".csv: a row for each point");
  add(add(files, "li"), "a", {{"href", "runs.csv"}}, "runs.csv: a row for each run");
  auto grid = add(add_section(main, "charts", "Charts"), "div", {{"class", "charts"}});
  const Places places(points);
  for (const auto& what : shown) draw_points(grid, points, places, what);
  add_runs(main, points);
  const auto counts = study.counts();
  return page_of({kind + " " + std::filesystem::path(study.file()).filename().string(),
                  fmt::format("{} points, {} runs, {} failed{}", points.size(), counts.total, counts.failed,
                              study.interrupted() ? ", interrupted" : ""),
                  version(), commit(), document});
}

}  // namespace edmill::report
