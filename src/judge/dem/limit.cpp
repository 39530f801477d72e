#include "dem/limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/errors.hpp"
#include "compare/log_reader.hpp"
#include "dem/contact_log.hpp"
#include "dem/statistics.hpp"
#include "io/json_text.hpp"
#include "plot/chart.hpp"

namespace edmill::dem {

namespace {

LimitPoint point_of(const std::string& file, double from) {
  ContactLogReader log(file);
  log.need_frames();
  const auto& facts = log.facts();
  if (!(facts.last > from))
    throw InputError(fmt::format("{}: found a record that ends at {} s, expected one beyond {} s", file,
                                 facts.last, from));
  DoseRate rate(std::max(from, facts.first), facts.last);
  std::vector<double> durations;
  while (const auto c = log.next()) {
    rate.add((c->begin + c->end) / 2, c->dose);
    if (c->kind == ContactClass::wall) durations.push_back(c->end - c->begin);
  }
  if (durations.size() < 20)
    throw InputError(
        fmt::format("{}: found {} single contacts with walls, expected at least 20", file, durations.size()));
  return {file, median_of(std::move(durations)).value, rate.mean(), rate.half_width()};
}

LimitPoint point_of_edmill(const std::string& run, double from) {
  const auto scan = compare::scan_log(run);
  if (!scan.has[model::milling_dose])
    throw InputError(scan.file + ": found no column milling_dose, expected that of edmill's collision log");
  DoseRate rate(std::max(from, scan.statistics_start.value_or(scan.first)), scan.last);
  compare::LogReader log(run);
  while (const auto event = log.next()) rate.add(event->time, event->milling_dose);
  return {run, 0, rate.mean(), rate.half_width()};
}

}  // namespace

double Limit::ratio_half_width() const {
  const double own = half_width / value, other = edmill->half_width / edmill->dose_rate;
  return ratio() * std::sqrt(own * own + other * other);
}

Limit limit_of(const std::vector<std::string>& logs, const std::string& run, double from) {
  Limit limit;
  for (const auto& log : logs) limit.points.push_back(point_of(log, from));
  std::sort(limit.points.begin(), limit.points.end(),
            [](const auto& a, const auto& b) { return a.contact_time > b.contact_time; });
  double weights = 0, times = 0, rates = 0;
  for (const auto& p : limit.points) {
    const double w = 1 / (p.half_width * p.half_width);
    weights += w, times += w * p.contact_time, rates += w * p.dose_rate;
  }
  const double mean_time = times / weights, mean_rate = rates / weights;
  double squares = 0, products = 0;
  for (const auto& p : limit.points) {
    const double w = 1 / (p.half_width * p.half_width), t = p.contact_time - mean_time;
    squares += w * t * t, products += w * t * (p.dose_rate - mean_rate);
  }
  const auto& slowest = limit.points.front();
  if (!(slowest.contact_time > 1.2 * limit.points.back().contact_time))
    throw InputError(fmt::format(
        "found contacts of {:.3g} s to {:.3g} s, expected durations that differ by more than a fifth",
        limit.points.back().contact_time, slowest.contact_time));
  limit.slope = products / squares;
  limit.value = mean_rate - limit.slope * mean_time;
  limit.half_width = std::sqrt(1 / weights + mean_time * mean_time / squares);
  if (!run.empty()) limit.edmill = point_of_edmill(run, from);
  return limit;
}

std::string table(const Limit& limit) {
  std::string out = fmt::format("  {:>12}  {:<24}{}\n", "contact time", "dose rate [W]", "log");
  const auto row = [&](const std::string& time, double value, double half_width, const std::string& log) {
    out += fmt::format("  {:>12}  {:<24}{}\n", time, fmt::format("{:.4f} ± {:.4f}", value, half_width), log);
  };
  for (const auto& p : limit.points)
    row(fmt::format("{:.3g} s", p.contact_time), p.dose_rate, p.half_width, p.log);
  row("0", limit.value, limit.half_width, "limit, by a weighted line");
  if (limit.edmill) {
    row("0", limit.edmill->dose_rate, limit.edmill->half_width, limit.edmill->log);
    out += fmt::format("\n  limit over edmill: {:.4f} ± {:.4f}\n", limit.ratio(), limit.ratio_half_width());
  }
  return out;
}

std::string to_json(const Limit& limit) {
  io::JsonText json;
  json.text("format", "edmill limit 1");
  json.begin("points");
  for (const auto& p : limit.points) {
    json.begin(p.log);
    json.number("contact_time", p.contact_time);
    json.number("milling_dose_rate", p.dose_rate);
    json.number("half_width", p.half_width);
    json.end();
  }
  json.end();
  json.number("limit", limit.value);
  json.number("half_width", limit.half_width);
  json.number("slope", limit.slope);
  if (limit.edmill) {
    json.number("edmill", limit.edmill->dose_rate);
    json.number("edmill_half_width", limit.edmill->half_width);
    json.number("ratio", limit.ratio());
    json.number("ratio_half_width", limit.ratio_half_width());
  }
  return json.finish();
}

std::string to_svg(const Limit& limit) {
  plot::Chart chart;
  chart.id = "limit";
  chart.title = "dose rate over contact time";
  chart.description = "dose rates of runs with contacts of several durations, and their limit";
  double low = limit.value - limit.half_width, high = limit.value + limit.half_width;
  const auto see = [&](const LimitPoint& p) {
    low = std::min(low, p.dose_rate - p.half_width), high = std::max(high, p.dose_rate + p.half_width);
  };
  for (const auto& p : limit.points) see(p);
  if (limit.edmill) see(*limit.edmill);
  const double last = limit.points.front().contact_time, room = 0.08 * (high - low);
  chart.x = {"contact time [us]", 0, 1.08e6 * last};
  chart.y = {"dose rate [W]", low - room, high + room};
  const auto bar = [&](const LimitPoint& p, const std::string& colour, const std::string& name) {
    const double x = 1e6 * p.contact_time;
    chart.curves.push_back(
        {name, colour, {{x, p.dose_rate - p.half_width}, {x, p.dose_rate + p.half_width}}});
  };
  chart.curves.push_back({"line", "c0", {{0, limit.value}, {1e6 * last, limit.value + limit.slope * last}}});
  bool first = true;
  for (const auto& p : limit.points) bar(p, "c1", std::exchange(first, false) ? "runs" : "");
  bar({"", 0.004 * last, limit.value, limit.half_width}, "c0", "limit");
  if (limit.edmill)
    bar({"", 0.012 * last, limit.edmill->dose_rate, limit.edmill->half_width}, "c2", "edmill");
  std::ostringstream out;
  plot::save(out, chart);
  return out.str();
}

}  // namespace edmill::dem
