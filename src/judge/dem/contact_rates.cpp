#include "dem/contact_rates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/errors.hpp"
#include "compare/junit.hpp"
#include "dem/contacts.hpp"
#include "dem/statistics.hpp"
#include "io/json_text.hpp"
#include "logs/event_log.hpp"
#include "plot/chart.hpp"

namespace edmill::dem {

namespace {

/// What counts of a record.
struct Window {
  double from, until = INFINITY;
  bool compared = false;  ///< with that of another record: nothing beside it counts, and it is not empty
};

/// @param transient  until when a run that it is compared with takes no statistics, which a log leaves out,
/// too, if it is long enough [s]
ContactRates rates_of_contacts(const std::string& file, const Window& window, double transient) {
  ContactLogReader log(file);
  log.need_frames();
  ContactRates r{.log = file};
  if (log.facts().last < 2 * transient) transient = 0;
  r.first = std::max({window.from, log.facts().first, transient});
  r.last = std::min(window.until, log.facts().last);
  if (window.compared && !(r.last > r.first))
    throw InputError(file + ": found no frames in the time that is compared, expected some");
  if (!window.compared && !(r.last > window.from))
    throw InputError(fmt::format("{}: found a record that ends at {} s, expected one beyond {} s", file,
                                 r.last, window.from));
  DoseRate rate(r.first, r.last);
  std::vector<double> durations;
  double all = 0, grouped = 0;
  std::uint64_t singles = 0;
  while (const auto c = log.next()) {
    const double time = (c->begin + c->end) / 2;
    if (window.compared && (time < r.first || time > r.last)) continue;
    rate.add(time, c->dose);
    const bool single = c->kind == ContactClass::wall || c->kind == ContactClass::pair;
    all += c->dose;
    grouped += single ? 0 : c->dose;
    singles += single ? 1 : 0;
    if (c->kind == ContactClass::wall) durations.push_back(c->end - c->begin);
  }
  if (!window.compared && durations.size() < 20)
    throw InputError(
        fmt::format("{}: found {} single contacts with walls, expected at least 20", file, durations.size()));
  r.dose_rate = rate.mean();
  r.half_width = rate.half_width();
  r.contact_time = median_of(std::move(durations)).value;
  r.single_rate = static_cast<double>(singles) / (r.last - r.first);
  r.grouped = all > 0 ? grouped / all : 0;
  return r;
}

ContactRates rates_of_impacts(const std::string& place, const Window& window) {
  const auto scan = logs::scan_log(place);
  if (!scan.has[model::milling_dose])
    throw InputError(scan.file + ": found no column milling_dose, expected " +
                     (window.compared ? "one: the dose is compared" : "that of edmill's collision log"));
  ContactRates r{.log = place};
  r.first = std::max(window.from, scan.statistics_start.value_or(scan.first));
  r.last = std::min(window.until, scan.last);
  if (window.compared && !(r.last > r.first))
    throw InputError(scan.file + ": found no impacts in the time that is compared, expected some");
  DoseRate rate(r.first, r.last);
  std::uint64_t impacts = 0;
  logs::EventLog log(place);
  while (const auto event = log.next()) {
    const double time = event->time;
    if (window.compared && (time < r.first || time > r.last)) continue;
    rate.add(time, event->milling_dose);
    ++impacts;
  }
  r.dose_rate = rate.mean();
  r.half_width = rate.half_width();
  r.single_rate = static_cast<double>(impacts) / (r.last - r.first);
  return r;
}

std::string sentence(const ContactComparison& c) {
  return fmt::format("dose rate of B over that of A: {:.4f} ± {:.4f}", 1 + c.difference, c.half_width);
}

const char* word_for(compare::Verdict verdict) {
  return verdict == compare::Verdict::agree    ? "agree"
         : verdict == compare::Verdict::differ ? "differ"
                                               : "too few";
}

constexpr double widest = 0.05;  ///< interval with which rates are said to agree

std::string sentence(compare::Verdict verdict, double half_width, std::optional<double> within) {
  const auto bound = within ? fmt::format(" within {:g} %", 100 * *within) : std::string();
  if (verdict == compare::Verdict::agree) return "the dose rates agree" + bound;
  if (verdict == compare::Verdict::differ)
    return "the dose rates differ" + (within ? " by more than" + bound.substr(7) : "");
  return fmt::format("too few data: the ratio is known to ± {:.2g} %, {}", 100 * half_width,
                     within
                         ? "which leaves open whether it is" + bound
                         : fmt::format("± {:g} % are needed; --within asks for other bounds", 100 * widest));
}

}  // namespace

compare::Verdict verdict_of(double difference, double half_width, std::optional<double> within) {
  using compare::Verdict;
  const double off = std::abs(difference);
  if (within)
    return off + half_width <= *within  ? Verdict::agree
           : off - half_width > *within ? Verdict::differ
                                        : Verdict::too_few;
  return off > half_width ? Verdict::differ : half_width <= widest ? Verdict::agree : Verdict::too_few;
}

ContactComparison compare_contacts(const compare::ComparisonOptions& options) {
  const auto a = options.a.string(), b = options.b.string();
  ContactComparison c{.within = options.within};
  const Window window{options.limits.from.value_or(0), options.limits.until.value_or(INFINITY), true};
  c.a = is_contact_log(a) ? rates_of_contacts(a, window, 0) : rates_of_impacts(a, window);
  c.b = is_contact_log(b) ? rates_of_contacts(b, window, is_contact_log(a) ? 0 : c.a.first)
                          : rates_of_impacts(b, window);
  if (!(c.a.dose_rate > 0 && c.b.dose_rate > 0)) return c;
  const double ratio = c.b.dose_rate / c.a.dose_rate;
  c.difference = ratio - 1;
  c.half_width = ratio * std::hypot(c.a.half_width / c.a.dose_rate, c.b.half_width / c.b.dose_rate);
  c.verdict = verdict_of(c.difference, c.half_width, c.within);
  return c;
}

std::string table(const ContactComparison& c) {
  std::string out = fmt::format("  {:<32}{:>22}{:>22}\n", "", "A", "B");
  const auto row = [&](const std::string& name, const auto& text) {
    out += fmt::format("  {:<32}{:>22}{:>22}\n", name, text(c.a), text(c.b));
  };
  row("time [s]", [](const ContactRates& r) { return fmt::format("{:g} to {:g}", r.first, r.last); });
  row("a contact lasts [s]", [](const ContactRates& r) { return fmt::format("{:.3g}", r.contact_time); });
  row("single contacts per second",
      [](const ContactRates& r) { return fmt::format("{:.5g}", r.single_rate); });
  row("dose in groups and lasting ones",
      [](const ContactRates& r) { return fmt::format("{:.2f} %", 100 * r.grouped); });
  row("dose rate [W]",
      [](const ContactRates& r) { return fmt::format("{:.4f} ± {:.4f}", r.dose_rate, r.half_width); });
  out += fmt::format("\n  {}\n", sentence(c));
  if (c.b.contact_time > 0)
    out +=
        "  contacts that last do not have the dose rate of impacts exactly; `edmill limit` takes their "
        "duration to zero\n";
  const bool has_dose = c.a.dose_rate > 0 && c.b.dose_rate > 0;
  return out + fmt::format("\n  verdict: {}\n", has_dose ? sentence(c.verdict, c.half_width, c.within)
                                                         : "too few data: a record has no dose");
}

std::string to_json(const ContactComparison& c) {
  io::JsonText json;
  json.add("format", "edmill contact comparison 1");
  json.add("verdict", word_for(c.verdict));
  for (const auto* r : {&c.a, &c.b}) {
    json.begin(r == &c.a ? "a" : "b");
    json.add("log", r->log);
    json.add("from", r->first);
    json.add("until", r->last);
    json.add("contact_time", r->contact_time);
    json.add("single_rate", r->single_rate);
    json.add("grouped_dose_share", r->grouped);
    json.add("milling_dose_rate", r->dose_rate);
    json.add("milling_dose_rate_half_width", r->half_width);
    json.end();
  }
  json.add("difference", c.difference);
  json.add("half_width", c.half_width);
  if (c.within) json.add("within", *c.within);
  return json.finish();
}

std::string to_junit(const ContactComparison& c) {
  using compare::Verdict;
  return compare::junit_text("edmill compare",
                             {{.name = "dose rate",
                               .problem = c.verdict == Verdict::differ ? sentence(c) : "",
                               .not_judged = c.verdict == Verdict::too_few ? sentence(c) : ""}});
}

double Limit::ratio_half_width() const {
  return ratio() * std::hypot(half_width / value, edmill->half_width / edmill->dose_rate);
}

Limit limit_of(const std::vector<std::string>& logs, const std::string& run, double from) {
  Limit limit;
  for (const auto& log : logs) limit.points.push_back(rates_of_contacts(log, {from}, -INFINITY));
  std::sort(limit.points.begin(), limit.points.end(),
            [](const auto& a, const auto& b) { return a.contact_time > b.contact_time; });
  numerics::Line line;
  for (const auto& p : limit.points) line.add(p.contact_time, p.dose_rate, 1 / (p.half_width * p.half_width));
  const auto& slowest = limit.points.front();
  if (!(slowest.contact_time > 1.2 * limit.points.back().contact_time))
    throw InputError(fmt::format(
        "found contacts of {:.3g} s to {:.3g} s, expected durations that differ by more than a fifth",
        limit.points.back().contact_time, slowest.contact_time));
  limit.slope = line.slope();
  limit.value = line.value();
  limit.half_width = line.deviation();
  if (!run.empty()) limit.edmill = rates_of_impacts(run, {from});
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
    out += fmt::format("\n  limit over edmill: {:.4f} ± {:.4f}\n\n  verdict: {}\n", limit.ratio(),
                       limit.ratio_half_width(),
                       sentence(limit.verdict(), limit.ratio_half_width(), limit.within));
  }
  return out;
}

std::string to_json(const Limit& limit) {
  io::JsonText json;
  json.add("format", "edmill limit 1");
  json.groups("points", limit.points, &ContactRates::log, [&](const ContactRates& p) {
    json.add("contact_time", p.contact_time);
    json.add("milling_dose_rate", p.dose_rate);
    json.add("half_width", p.half_width);
  });
  json.add("limit", limit.value);
  json.add("half_width", limit.half_width);
  json.add("slope", limit.slope);
  if (limit.edmill) {
    json.add("edmill", limit.edmill->dose_rate);
    json.add("edmill_half_width", limit.edmill->half_width);
    json.add("ratio", limit.ratio());
    json.add("ratio_half_width", limit.ratio_half_width());
    json.add("verdict", word_for(limit.verdict()));
  }
  return json.finish();
}

std::string to_svg(const Limit& limit) {
  plot::Chart chart;
  chart.id = "limit";
  chart.title = "dose rate over contact time";
  chart.description = "dose rates of runs with contacts of several durations, and their limit";
  double low = limit.value - limit.half_width, high = limit.value + limit.half_width;
  const auto see = [&](const ContactRates& p) {
    low = std::min(low, p.dose_rate - p.half_width);
    high = std::max(high, p.dose_rate + p.half_width);
  };
  for (const auto& p : limit.points) see(p);
  if (limit.edmill) see(*limit.edmill);
  const double last = limit.points.front().contact_time, room = 0.08 * (high - low);
  chart.x = {"contact time [us]", 0, 1.08e6 * last};
  chart.y = {"dose rate [W]", low - room, high + room};
  const auto bar = [&](double time, double value, double half_width, const char* colour, const char* name) {
    const double x = 1e6 * time;
    chart.curves.push_back({name, colour, {{x, value - half_width}, {x, value + half_width}}});
  };
  chart.curves.push_back({"line", "c0", {{0, limit.value}, {1e6 * last, limit.value + limit.slope * last}}});
  bool first = true;
  for (const auto& p : limit.points)
    bar(p.contact_time, p.dose_rate, p.half_width, "c1", std::exchange(first, false) ? "runs" : "");
  bar(0.004 * last, limit.value, limit.half_width, "c0", "limit");
  if (limit.edmill) bar(0.012 * last, limit.edmill->dose_rate, limit.edmill->half_width, "c2", "edmill");
  std::ostringstream out;
  plot::save(out, chart);
  return out.str();
}

}  // namespace edmill::dem
