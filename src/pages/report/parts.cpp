// Common parts of the sections of a report.
#include <cctype>

#include "model/variables.hpp"
#include "report/sections.hpp"

namespace edmill::report {

using plot::add;

std::string name_of(const model::PartnerInfo& partner) {
  std::string name;
  for (const char c : partner.label)
    name += c != '-' ? std::string(1, c) : name.ends_with(' ') ? "\u2212" : "\u2013";
  return name;
}

std::string partner_colour(const model::Partners& partners, int place) {
  if (place == partners.ball_ball()) return "c3";
  return "c" + std::to_string(place < 3 ? place : 5 + (place - 3) % 3);  // c4 is that of all impacts
}

std::string run_colour(std::size_t place) { return "c" + std::to_string(place % 8); }

std::vector<MainRate> main_rates(const RunFacts& f) {
  const auto per_time = [&](double amount, const char* name) -> std::optional<RateOf> {
    if (!(f.duration() > 0)) return std::nullopt;
    return RateOf{amount / f.duration(), f.half_width(name)};
  };
  const auto dose = per_time(f.milling_dose, "milling_dose_rate");
  std::optional<RateOf> inverse, specific, time;
  if (dose && dose->value > 0) inverse = {1 / dose->value, f.half_width("inverse_milling_dose_rate")};
  if (dose && f.powder_mass)
    specific = {dose->value / *f.powder_mass, f.half_width("specific_milling_dose_rate")};
  if (f.milling_time) time = RateOf{*f.milling_time, f.milling_time_half_width}.in_units_of(3600);
  return {{"milling dose rate", "W", dose},
          {"inverse milling dose rate", "s/J", inverse},
          {"specific milling dose rate", "W/kg", specific},
          {"milling time", "h", time},
          {"power from the walls", "W", per_time(f.wall_work, "wall_work_rate")},
          {"collisions", "1/s", per_time(f.all_collisions(), "collision_rate/total")}};
}

std::string capitalised(std::string text) {
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

plot::Curve bars(const std::string& name, const std::string& colour, double first, double width,
                 const std::vector<double>& heights) {
  plot::Curve curve{name, colour, {}, true};
  const auto place = [&](std::size_t k) { return first + width * static_cast<double>(k); };
  for (std::size_t k = 0; k < heights.size(); ++k) curve.points.emplace_back(place(k), heights[k]);
  curve.points.emplace_back(place(heights.size()), 0);
  return curve;
}

std::string text_of(const RateOf& rate) {
  const auto [value, width] = plot::with_interval(rate.value, rate.half_width.value_or(0));
  return rate.half_width ? value + " \u00b1 " + width : plot::readable(rate.value);
}

void add_point(plot::Chart& chart, double x, double half_length, const RateOf& rate, const std::string& name,
               const std::string& colour) {
  const double half = rate.half_width.value_or(0), left = x - half_length, right = x + half_length;
  chart.bands.push_back({colour,
                         {left, right},
                         {rate.value - half, rate.value - half},
                         {rate.value + half, rate.value + half}});
  chart.curves.push_back({name, colour, {{left, rate.value}, {right, rate.value}}, false});
}

pugi::xml_node add_section(pugi::xml_node main, const std::string& id, const std::string& heading) {
  auto section = add(main, "section", {{"id", id}, {"aria-labelledby", id + "-heading"}});
  add(section, "h2", {{"id", id + "-heading"}}, heading);
  return section;
}

void add_missing(pugi::xml_node section, const std::string& what, const std::string& output) {
  auto line = add(section, "p", {{"class", "missing"}}, "No " + what + ": add an [[output]] with ");
  add(line, "code", {}, output);
  add(line, "span", {}, " to the case, or run it with --report.");
}

void add_table(pugi::xml_node section, const std::string& id, const std::string& caption,
               const std::vector<std::string>& headings, const Rows& rows) {
  add(section, "h3", {{"id", id}}, caption);
  // Wide tables scroll inside their own box, which can be focused by keyboard.
  auto box = add(section, "div",
                 {{"class", "table"}, {"tabindex", "0"}, {"role", "region"}, {"aria-labelledby", id}});
  auto table = add(box, "table", {{"aria-labelledby", id}});
  auto head = add(add(table, "thead"), "tr");
  for (const auto& heading : headings) add(head, "th", {{"scope", "col"}}, heading);
  auto body = add(table, "tbody");
  for (const auto& row : rows) {
    auto line = add(body, "tr");
    for (std::size_t k = 0; k < row.size(); ++k)
      k == 0 ? add(line, "th", {{"scope", "row"}}, row[k]) : add(line, "td", {}, row[k]);
  }
}

namespace {

/// Whether an output contains the impacts with one partner; with any for -1.
bool records(const casefile::OutputSpec& output, const model::Partners& partners, int partner) {
  const int ball_ball = *model::find_variable("ball_ball"), id = *model::find_variable("partner");
  if (partner < 0) return output.only.empty();
  const auto is = [&](const casefile::Restriction& r, int variable, std::uint64_t value) {
    return r.variable == variable && r.value == value;
  };
  const auto& only = output.only;
  if (partner == partners.ball_ball()) return only.size() == 1 && is(only[0], ball_ball, 1);
  const auto wall = static_cast<std::uint64_t>(partner);
  return only.size() == 2 && ((is(only[0], ball_ball, 0) && is(only[1], id, wall)) ||
                              (is(only[1], ball_ball, 0) && is(only[0], id, wall)));
}

}  // namespace

std::optional<Series> rate_of(const RunFolder& run, const char* variable, int partner) {
  const int row = *model::find_variable(variable);
  const auto fits = [&](const casefile::OutputSpec& output) {
    bool shown = false;
    for (const auto& column : output.columns)
      for (const auto statistic : column.statistics)
        shown = shown || (column.variable == row && statistic == casefile::Statistic::rate);
    return shown && !output.accumulated && !output.timer.start_collision &&
           records(output, run.partners, partner);
  };
  const auto* output = run.output("trends", fits);
  if (!output) return std::nullopt;
  const auto table = read_table(run.file_of(*output), "a table of trends");
  if (table.numbers.empty()) return std::nullopt;
  return series_of(*output, table, row, run.spec.initial_time.to<double>());
}

}  // namespace edmill::report
