#include "dem/contact_rates.hpp"

#include <fmt/format.h>

#include "base/clean_text.hpp"
#include "base/errors.hpp"
#include "io/fields.hpp"

namespace edmill::dem {

namespace {

/// The part of a record that is evaluated [s].
struct Window {
  double from, until = INFINITY;
  bool compared = false;  ///< contacts outside are ignored, and it must not be empty
};

/// Rates of a record within a window. @param what  "contacts" or "impacts"
ContactRates rates_of(const std::string& log, const char* what, double first, double last,
    const Window& window, const auto& next) {
  ContactRates r{
      .log = log, .first = std::max(first, window.from), .last = std::min(last, window.until)};
  if (window.compared && !(r.last > r.first))
    throw InputError(fmt::format("{}: no {} in the time that is compared", log, what));
  if (!window.compared && !(r.last > window.from))
    throw InputError(fmt::format("{}: found a record that ends at {} s, expected one beyond {} s",
        log, r.last, window.from));
  DoseRate rate(r.first, r.last);
  std::vector<double> durations;
  double all = 0, grouped = 0;
  std::uint64_t singles = 0;
  while (const std::optional<Contact> c = next()) {
    const double time = (c->begin + c->end) / 2;
    if (window.compared && (time < r.first || time > r.last)) continue;
    rate.add(time, c->dose);
    all += c->dose;
    if (is_single(c->kind))
      ++singles;
    else
      grouped += c->dose;
    if (c->kind == ContactClass::wall) durations.push_back(c->end - c->begin);
  }
  if (!window.compared && durations.size() < 20)
    throw InputError(fmt::format(
        "{}: found {} single {} with walls, expected at least 20", log, durations.size(), what));
  const auto estimate = rate.estimate();
  r.dose_rate = *estimate.mean;
  r.half_width = *estimate.half_width;
  r.contact_time = numerics::median_of(std::move(durations)).value;
  r.single_rate = static_cast<double>(singles) / (r.last - r.first);
  r.grouped = all > 0 ? grouped / all : 0;
  return r;
}

/// @param transient  time at which the statistics of the run it is compared with begin; earlier
/// contacts are left out if the log is at least twice as long [s]
ContactRates rates_of_contacts(const std::string& file, const Window& window, double transient) {
  ContactLogReader log(file);
  const double first = log.facts().first, last = log.facts().last;
  return rates_of(file, "contacts", last < 2 * transient ? first : std::max(first, transient), last,
      window, [&] { return log.next(); });
}

ContactRates rates_of_impacts(const std::string& place, const Window& window) {
  const auto scan = logs::scan_log(place);
  if (!scan.has[model::milling_dose])
    throw InputError(scan.file + ": no column milling_dose: " +
        (window.compared ? "the dose rates cannot be compared" : "give a collision log of edmill"));
  logs::EventLog log(place);
  return rates_of(
      place, "impacts", scan.statistics_start.value_or(scan.first), scan.last, window, [&] {
        std::optional<Contact> contact;
        if (const auto event = log.next())
          contact = {.kind = event->with_wall ? ContactClass::wall : ContactClass::pair,
              .begin = event->time,
              .end = event->time,
              .dose = event->milling_dose};
        return contact;
      });
}

std::string sentence(const ContactComparison& c) {
  return "dose rate of B over that of A: " + with_interval(c.ratio, c.half_width);
}

const char* word_for(Verdict verdict) {
  return std::array{"agree", "differ", "too few"}.at(static_cast<std::size_t>(verdict));
}

constexpr double widest = 0.05;  ///< half-width with which rates may be said to agree

std::string verdict_of(const ContactComparison& c) {
  const auto bound = c.within ? fmt::format(" within {:g} %", 100 * *c.within) : "";
  if (c.verdict == Verdict::agree) return "the dose rates agree" + bound;
  if (c.verdict == Verdict::differ)
    return "the dose rates differ" + (c.within ? " by more than" + bound.substr(7) : "");
  return fmt::format("too few data: the ratio is known to ± {:.2g} %, {}", 100 * c.half_width,
      c.within ? "which leaves open whether it is" + bound
               : fmt::format("± {:g} % are needed; --within sets another bound", 100 * widest));
}

void judge(ContactComparison& c) {
  const auto &a = c.a, &b = c.b;
  c.ratio = b.dose_rate / a.dose_rate;
  c.half_width = c.ratio * std::hypot(a.half_width / a.dose_rate, b.half_width / b.dose_rate);
  const double off = std::abs(c.ratio - 1);
  const bool agrees = c.within ? off + c.half_width <= *c.within : c.half_width <= widest;
  c.verdict = off - c.half_width > c.within.value_or(0) ? Verdict::differ
      : agrees                                          ? Verdict::agree
                                                        : Verdict::too_few;
}

/// Visits the fields of a document. docs/files.md, "Logs of contacts"
struct ComparisonFields {
  const ContactComparison& c;

  void operator()(auto& v) const {
    v("format", "", "", "edmill contact comparison 1");
    v("verdict", "", "`agree`, `differ`, `too few`", word_for(c.verdict));
    v.group("a", "the first record", [&] { rates(v, c.a); });
    v.group("b", "the other one, with the same fields", [&] { rates(v, c.b); });
    v("difference", "1", "difference of the dose rates, relative to A", c.ratio - 1);
    v("half_width", "1", "half-width of its 95 % interval", c.half_width);
    if (v.has(c.within.has_value())) v("within", "1", "largest difference that agrees", c.within);
  }
 private:
  static void rates(auto& v, const ContactRates& r) {
    v("log", "", "", r.log);
    v("from", "s", "", r.first);
    v("until", "s", "", r.last);
    v("contact_time", "s", "median duration of single contacts with walls; 0 for impacts",
        r.contact_time);
    v("single_rate", "1/s", "rate of single contacts", r.single_rate);
    v("grouped_dose_share", "1", "share of the dose in groups and lasting contacts", r.grouped);
    v("milling_dose_rate", "W", "dose rate by the balance of energy", r.dose_rate);
    v("milling_dose_rate_half_width", "W", "half-width of its 95 % interval", r.half_width);
  }
};

struct LimitFields {
  const Limit& limit;

  void operator()(auto& v) const {
    v("format", "", "", "edmill limit 1");
    v.each("points", "by log", limit.points, &ContactRates::log, [&](const ContactRates& p) {
      v("contact_time", "s", "", p.contact_time);
      v("milling_dose_rate", "W", "", p.dose_rate);
      v("half_width", "W", "half-width of its 95 % interval", p.half_width);
    });
    v("limit", "W", "dose rate with contacts that take no time", limit.at_zero.dose_rate);
    v("half_width", "W", "half-width of its 95 % interval", limit.at_zero.half_width);
    v("slope", "W/s", "slope of the dose rate over the contact time", limit.slope);
    if (!v.has(limit.to_edmill.has_value())) return;
    const auto c = limit.to_edmill.value_or(ContactComparison{});
    v("edmill", "W", "with `--edmill`: dose rate of the run", c.a.dose_rate);
    v("edmill_half_width", "W", "half-width of its 95 % interval", c.a.half_width);
    v("ratio", "1", "limit divided by the dose rate of the run", c.ratio);
    v("ratio_half_width", "1", "half-width of its 95 % interval", c.half_width);
    v("verdict", "", "`agree`, `differ`, `too few`", word_for(c.verdict));
  }
};

}  // namespace

ContactComparison compare_contacts(const compare::ComparisonOptions& options) {
  const auto a = options.a.string(), b = options.b.string();
  ContactComparison c{.within = options.within};
  const Window window{
      options.limits.from.value_or(0), options.limits.until.value_or(INFINITY), true};
  c.a = is_contact_log(a) ? rates_of_contacts(a, window, 0) : rates_of_impacts(a, window);
  c.b = is_contact_log(b) ? rates_of_contacts(b, window, is_contact_log(a) ? 0 : c.a.first)
                          : rates_of_impacts(b, window);
  if (c.a.dose_rate > 0 && c.b.dose_rate > 0) judge(c);
  return c;
}

std::string table(const ContactComparison& c) {
  std::string out = fmt::format("  {:<32}{:>22}{:>22}\n", "", "A", "B");
  const auto row = [&](const std::string& name, const auto& text) {
    out += fmt::format("  {:<32}{:>22}{:>22}\n", name, text(c.a), text(c.b));
  };
  row("time [s]", [](auto& r) { return fmt::format("{:g} to {:g}", r.first, r.last); });
  row("a contact lasts [s]", [](auto& r) { return fmt::format("{:.3g}", r.contact_time); });
  row("single contacts per second", [](auto& r) { return fmt::format("{:.5g}", r.single_rate); });
  row("dose in groups and lasting ones",
      [](auto& r) { return fmt::format("{:.2f} %", 100 * r.grouped); });
  row("dose rate [W]", [](auto& r) { return with_interval(r.dose_rate, r.half_width); });
  out += fmt::format("\n  {}\n", sentence(c));
  if (c.b.contact_time > 0)
    out +=
        "  contacts that last do not have the dose rate of impacts exactly; `edmill limit` takes "
        "their "
        "duration to zero\n";
  const bool has_dose = c.a.dose_rate > 0 && c.b.dose_rate > 0;
  return out +
      fmt::format(
          "\n  verdict: {}\n", has_dose ? verdict_of(c) : "too few data: a record has no dose");
}

std::string to_json(const ContactComparison& c) { return io::JsonFields::of(ComparisonFields{c}); }

std::string contact_comparison_keys() { return io::KeyTable::of(ComparisonFields{{}}); }

std::string to_junit(const ContactComparison& c) {
  return compare::junit_text("edmill compare",
      {{.name = "dose rate",
          .problem = c.verdict == Verdict::differ ? sentence(c) : "",
          .not_judged = c.verdict == Verdict::too_few ? sentence(c) : ""}});
}

Limit limit_of(const std::vector<std::string>& logs, const std::string& run, double from,
    std::optional<double> within) {
  Limit limit;
  for (const auto& log : logs) limit.points.push_back(rates_of_contacts(log, {from}, -INFINITY));
  std::sort(limit.points.begin(), limit.points.end(),
      [](auto& a, auto& b) { return a.contact_time > b.contact_time; });
  numerics::Line line;
  for (const auto& p : limit.points)
    line.add(p.contact_time, p.dose_rate, 1 / (p.half_width * p.half_width));
  const double least = limit.points.back().contact_time, most = limit.points.front().contact_time;
  if (!(most > 1.2 * least))
    throw InputError(
        fmt::format("found contacts of {:.3g} s to {:.3g} s, expected durations that differ by "
                    "more than a fifth",
            least, most));
  limit.slope = line.slope();
  limit.at_zero.dose_rate = line.value();
  limit.at_zero.half_width = line.deviation();
  if (!run.empty()) {
    limit.to_edmill = {.a = rates_of_impacts(run, {from}), .b = limit.at_zero, .within = within};
    judge(*limit.to_edmill);
  }
  return limit;
}

std::string table(const Limit& limit) {
  std::string out = fmt::format("  {:>12}  {:<24}{}\n", "contact time", "dose rate [W]", "log");
  const auto row = [&](const auto& t, const ContactRates& r) {
    out += fmt::format("  {:>12}  {:<24}{}\n", t, with_interval(r.dose_rate, r.half_width), r.log);
  };
  for (const auto& p : limit.points) row(fmt::format("{:.3g} s", p.contact_time), p);
  row("0", limit.at_zero);
  if (const auto& c = limit.to_edmill) {
    row("0", c->a);
    out += fmt::format("\n  limit over edmill: {}\n\n  verdict: {}\n",
        with_interval(c->ratio, c->half_width), verdict_of(*c));
  }
  return out;
}

std::string to_json(const Limit& limit) { return io::JsonFields::of(LimitFields{limit}); }

std::string limit_keys() { return io::KeyTable::of(LimitFields{{}}); }

}  // namespace edmill::dem
