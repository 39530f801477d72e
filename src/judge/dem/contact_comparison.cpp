#include "dem/contact_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/errors.hpp"
#include "compare/log_reader.hpp"
#include "dem/contact_log.hpp"
#include "dem/statistics.hpp"
#include "io/json_text.hpp"

namespace edmill::dem {

namespace {

struct Window {
  double from, until;
};

/// @param transient  until when a run that it is compared with takes no statistics, which a log leaves out,
/// too, if it is long enough [s]
ContactRates rates_of_contacts(const std::string& file, const Window& window, double transient = 0) {
  ContactLogReader log(file);
  log.need_frames();
  ContactRates r{.log = file};
  if (log.facts().last < 2 * transient) transient = 0;
  r.first = std::max({window.from, log.facts().first, transient}),
  r.last = std::min(window.until, log.facts().last);
  if (!(r.last > r.first))
    throw InputError(file + ": found no frames in the time that is compared, expected some");
  DoseRate rate(r.first, r.last);
  std::vector<double> durations;
  double all = 0, grouped = 0;
  std::uint64_t singles = 0;
  while (const auto c = log.next()) {
    const double time = (c->begin + c->end) / 2;
    if (time < r.first || time > r.last) continue;
    rate.add(time, c->dose);
    const bool single = c->kind == ContactClass::wall || c->kind == ContactClass::pair;
    all += c->dose, grouped += single ? 0 : c->dose;
    singles += single ? 1 : 0;
    if (c->kind == ContactClass::wall) durations.push_back(c->end - c->begin);
  }
  r.dose_rate = rate.mean(), r.dose_rate_half_width = rate.half_width();
  r.contact_time = median_of(std::move(durations)).value;
  r.single_rate = static_cast<double>(singles) / (r.last - r.first);
  r.grouped = all > 0 ? grouped / all : 0;
  return r;
}

ContactRates rates_of_impacts(const std::string& place, const Window& window) {
  const auto scan = compare::scan_log(place);
  if (!scan.has[model::milling_dose])
    throw InputError(scan.file + ": found no column milling_dose, expected one: the dose is compared");
  ContactRates r{.log = place};
  r.first = std::max(window.from, scan.statistics_start.value_or(scan.first)),
  r.last = std::min(window.until, scan.last);
  if (!(r.last > r.first))
    throw InputError(scan.file + ": found no impacts in the time that is compared, expected some");
  DoseRate rate(r.first, r.last);
  std::uint64_t impacts = 0;
  compare::LogReader log(place);
  while (const auto event = log.next()) {
    const double time = event->time;
    if (time < r.first || time > r.last) continue;
    rate.add(time, event->milling_dose);
    ++impacts;
  }
  r.dose_rate = rate.mean(), r.dose_rate_half_width = rate.half_width();
  r.single_rate = static_cast<double>(impacts) / (r.last - r.first);
  return r;
}

std::string sentence(const ContactComparison& c) {
  return fmt::format("dose rate of B over that of A: {:.4f} ± {:.4f}", 1 + c.difference, c.half_width);
}

}  // namespace

ContactComparison compare_contacts(const std::string& a, const std::string& b, double from, double until) {
  ContactComparison c;
  const Window window{from, until};
  c.a = is_contact_log(a) ? rates_of_contacts(a, window) : rates_of_impacts(a, window);
  c.b = is_contact_log(b) ? rates_of_contacts(b, window, is_contact_log(a) ? 0 : c.a.first)
                          : rates_of_impacts(b, window);
  c.known = c.a.dose_rate > 0 && c.b.dose_rate > 0;
  if (!c.known) return c;
  const double ratio = c.b.dose_rate / c.a.dose_rate;
  const double one = c.a.dose_rate_half_width / c.a.dose_rate,
               other = c.b.dose_rate_half_width / c.b.dose_rate;
  c.difference = ratio - 1;
  c.half_width = ratio * std::sqrt(one * one + other * other);
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
  row("dose rate [W]", [](const ContactRates& r) {
    return fmt::format("{:.4f} ± {:.4f}", r.dose_rate, r.dose_rate_half_width);
  });
  out += fmt::format("\n  {}\n", sentence(c));
  if (c.b.contact_time > 0)
    out +=
        "  contacts that last do not have the dose rate of impacts exactly; `edmill limit` takes their "
        "duration to zero\n";
  return out + fmt::format("\n  verdict: {}\n", !c.known    ? "too few data: a record has no dose"
                                                : c.agree() ? "the dose rates agree"
                                                            : "the dose rates differ");
}

std::string to_json(const ContactComparison& c) {
  io::JsonText json;
  json.text("format", "edmill contact comparison 1");
  json.text("verdict", !c.known ? "too few" : c.agree() ? "agree" : "differ");
  for (const auto* r : {&c.a, &c.b}) {
    json.begin(r == &c.a ? "a" : "b");
    json.text("log", r->log);
    json.number("from", r->first);
    json.number("until", r->last);
    json.number("contact_time", r->contact_time);
    json.number("single_rate", r->single_rate);
    json.number("grouped_dose_share", r->grouped);
    json.number("milling_dose_rate", r->dose_rate);
    json.number("milling_dose_rate_half_width", r->dose_rate_half_width);
    json.end();
  }
  json.number("difference", c.difference);
  json.number("half_width", c.half_width);
  return json.finish();
}

std::string to_junit(const ContactComparison& c) {
  io::JunitText junit("edmill compare");
  junit.add("dose rate", c.known && c.agree() ? "" : sentence(c));
  return junit.finish();
}

}  // namespace edmill::dem
