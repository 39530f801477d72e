// Runs side by side.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ranges>

#include "base/version.hpp"
#include "io/output_folder.hpp"
#include "report/page.hpp"
#include "report/report_page.hpp"
#include "report/sections.hpp"

namespace edmill::report {

using plot::add;
using plot::readable;

namespace {

/// By the folders, and where these have the same name by their whole paths.
void name_runs(std::vector<RunFolder>& runs) {
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const auto own = (runs[k].place / "").parent_path().filename().string();
    const bool alone = std::ranges::count_if(runs, [&](const RunFolder& r) {
                         return (r.place / "").parent_path().filename() == own;
                       }) == 1;
    runs[k].name = alone ? own : fmt::format("{} ({})", runs[k].place.string(), k + 1);
  }
}

/// "+12 %", with a word where the difference may be noise.
std::string against(const RateOf& rate, const RateOf& first) {
  const auto apart = differ(rate, first);
  std::string change = "\u2013";
  if (first.value != 0) {
    const double percent = 100 * (rate.value / first.value - 1);
    change = fmt::format("{}{:.1f} %", percent < 0 ? "\u2212" : "+", std::abs(percent));
  }
  return !apart ? change + ", no interval" : *apart ? change : change + ", not significant";
}

void add_rates_of(pugi::xml_node main, const std::vector<RunFolder>& runs) {
  auto section = add_section(main, "rates", "Rates");
  Rows rows;
  const auto first_run = main_rates(runs.front().facts);
  for (std::size_t k = 0; k < first_run.size(); ++k) {
    const auto& [name, unit, first] = first_run[k];
    if (name.starts_with("inverse")) continue;
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
  add(section, "p", {{"class", "note"}},
      "\u00b1: 95 % interval of the run. A difference is significant where the 95 % interval of the "
      "difference, the half-widths added in quadrature, leaves out zero; of twenty comparisons of equal "
      "mills one is so by chance.");
}

/// Each dose rate as a point with its interval, at the number of the run.
void draw_dose_rates(pugi::xml_node grid, const std::vector<RunFolder>& runs) {
  plot::Chart chart;
  chart.id = "dose-rates", chart.title = "Milling dose rate";
  chart.description = "For each run a horizontal line at its milling dose rate, within its 95 % interval.";
  chart.x = {"run", 0.4, static_cast<double>(runs.size()) + 0.6, false};
  chart.y.title = "milling dose rate [W]";
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const auto rate = main_rates(runs[k].facts).front().rate;
    if (!rate) continue;
    add_point(chart, static_cast<double>(k) + 1, 0.25, *rate, fmt::format("{}: {}", k + 1, runs[k].name),
              run_colour(k));
    chart.y.high = std::max(chart.y.high, 1.1 * (rate->value + rate->half_width.value_or(0)));
  }
  draw(grid, chart);
}

void draw_over_time(pugi::xml_node grid, const std::vector<RunFolder>& runs) {
  plot::Chart chart;
  chart.id = "dose-rate", chart.title = "Milling dose rate over time";
  chart.description = "Lines of the milling dose rate of each run over the simulated time.";
  chart.x.title = "time [s]", chart.x.high = 0, chart.y.title = "milling dose rate [W]";
  double high = 0;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const auto series = rate_of(runs[k], "milling_dose");
    if (!series) continue;
    const auto thin = coarser(whole(*series), 60);
    chart.curves.push_back({runs[k].name, run_colour(k), points_of(thin), false});
    chart.x.high = std::max(chart.x.high, thin.end.back());
    for (const double rate : thin.rate) high = std::max(high, rate);
  }
  if (chart.curves.empty()) return;
  chart.y.high = high > 0 ? 1.1 * high : 1;
  draw(grid, chart);
}

/// What the cases do not have in common.
void add_differences(pugi::xml_node main, const std::vector<RunFolder>& runs) {
  std::vector<std::string> keys;
  std::vector<std::map<std::string, std::string>> facts;
  for (const auto& run : runs) {
    auto& own = facts.emplace_back();
    auto rows = case_rows(run);
    rows.push_back({"statistics", fmt::format("{} s to {} s", plot::brief(run.facts.start_time, 12),
                                              plot::brief(run.facts.end_time, 12))});
    rows.push_back({"seed, precision", fmt::format("{:.0f}, {}", run.facts.seed, run.facts.precision)});
    rows.push_back({"program", fmt::format("edmill {} ({})", run.facts.version, run.facts.commit)});
    for (const auto& row : rows) {
      const auto [fact, is_first] = own.emplace(row[0], row[1]);
      if (!is_first) fact->second += "; " + row[1];
      if (std::ranges::find(keys, row[0]) == keys.end()) keys.push_back(row[0]);
    }
  }
  Rows rows;
  for (const auto& key : keys) {
    std::vector<std::string> row{key};
    for (const auto& own : facts) {
      const auto found = own.find(key);
      row.push_back(found == own.end() ? "\u2013" : found->second);
    }
    if (std::adjacent_find(row.begin() + 1, row.end(), std::not_equal_to<>()) != row.end())
      rows.push_back(std::move(row));
  }
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
  if (std::ranges::all_of(runs, [](const RunFolder& run) { return run.facts.warnings.empty(); })) return;
  auto section = add_section(main, "warnings", "Warnings");
  auto list = add(section, "ul");
  for (const auto& run : runs)
    for (const auto& [kind, text] : run.facts.warnings)
      add(list, "li", {{"data-kind", kind}}, run.name + ": " + text);
}

}  // namespace

std::optional<bool> differ(const RateOf& a, const RateOf& b) {
  if (!a.half_width || !b.half_width) return std::nullopt;
  return std::abs(a.value - b.value) > std::hypot(*a.half_width, *b.half_width);
}

std::string comparison_page(std::vector<RunFolder> runs) {
  name_runs(runs);
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
  return page_of({fmt::format("{} runs compared", runs.size()), fmt::format("{}", fmt::join(names, ", ")),
                  version(), commit(), document});
}

void write_comparison(const std::vector<std::string>& folders, const std::filesystem::path& file) {
  std::vector<RunFolder> runs;
  for (const auto& folder : folders) runs.push_back(read_run_folder(folder));
  io::NamedFile(file).write([&](std::ostream& out) { out << comparison_page(runs); });
}

}  // namespace edmill::report
