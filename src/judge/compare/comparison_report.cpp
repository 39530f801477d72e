#include <fmt/format.h>

#include <boost/property_tree/xml_parser.hpp>
#include <sstream>

#include "base/clean_text.hpp"
#include "base/version.hpp"
#include "compare/comparison.hpp"
#include "io/fields.hpp"

namespace edmill::compare {

namespace {

std::string_view name_of_value(std::size_t value) { return model::logged_quantities[value].name; }

std::string describe(const Event& e) {
  std::string text = fmt::format("line {}: t = {} s, ball {} with {} {}", e.line, e.time, e.ball,
      e.with_wall ? "wall" : "ball", e.partner);
  for (std::size_t v = model::approach_speed; v < model::logged_count; ++v)
    if (!std::isnan(e[v])) text += fmt::format(", {} {}", name_of_value(v), e[v]);
  return text;
}

std::string interval_of(std::optional<double> value, std::optional<double> half_width) {
  return value ? with_interval(*value, half_width) : "-";
}

/// Indices of the logged quantities that both logs have.
auto values_of(const Comparison& c) {
  std::vector<std::size_t> list;
  for (std::size_t k = 0; k < model::logged_count; ++k)
    if (c.a.has[k] && c.b.has[k]) list.push_back(k);
  return list;
}

/// Visits the fields of a document. docs/files.md, "Comparison"
struct Fields {
  const Comparison& c;

  void operator()(auto& v) const {
    v("format", "", "", "edmill comparison 1");
    v("version", "", "version of the program", version());
    v("commit", "", "commit of the program", commit());
    v("verdict", "", "`agree`, `differ`, `too_few`", name_of(c.verdict));
    v.group("a", "the first log", [&] { log(v, c.a); });
    v.group("b", "the other log, with the same fields", [&] { log(v, c.b); });
    v("tolerance", "1", "relative tolerance of the comparison event by event",
        c.options.event_tolerance());
    v.group("event_by_event", "", [&] { events(v, c.events); });
    if (v.has(c.times.count > 0))
      v.group("statistics", "statistics of the common time, if it is long enough",
          [&] { statistics(v); });
  }
 private:
  static void log(auto& v, const LogScan& scan) {
    v("file", "", "", scan.file);
    v("events", "1", "number of events", scan.events);
    v("first_time", "s", "time of the first event", scan.first);
    v("last_time", "s", "time of the last event", scan.last);
  }
  void events(auto& v, const EventComparison& e) const {
    v("agreeing", "1", "events before the first difference", e.agreeing);
    v("horizon", "s", "time of the last of them",
        e.agreeing > 0 ? std::optional(e.horizon) : std::nullopt);
    v("same_partners", "1", "events before the bodies differ", e.same_partners);
    if (v.has(c.events_verdict.has_value())) {
      v("asked_for", "1", "number given with `--events`", c.options.events.value_or(0));
      v("verdict", "", "verdict if `--events` was given",
          name_of(c.events_verdict.value_or(Verdict::agree)));
    }
    if (v.has(e.first.has_value()))
      v.group("first_difference", "", [&] { difference(v, e.first.value_or(FirstDifference{})); });
    v.by_name("largest", "1", "relative difference of each value up to the horizon", values_of(c),
        name_of_value, [&](std::size_t k) { return e.largest[k]; });
    v("digits_lost_per_event", "1", "slope of a straight line through the differences",
        e.digits_lost_per_event);
  }
  static void difference(auto& v, const FirstDifference& first) {
    v("quantity", "", "`partners` or a value's name", first.quantity);
    v("relative_difference", "1", "relative difference of that value", first.relative_difference);
    v.group("a", "the event in A", [&] { event(v, first.a); });
    v.group("b", "the event in B, with the same fields", [&] { event(v, first.b); });
  }
  static void event(auto& v, const Event& e) {
    v("line", "1", "line of the log", e.line);
    v("ball", "", "", e.ball);
    v("partner_kind", "", "`wall` or `ball`", e.with_wall ? "wall" : "ball");
    v("partner", "", "", e.partner);
    for (std::size_t k = 0; k < model::logged_count; ++k) v(name_of_value(k), "", "", e[k]);
  }
  void statistics(auto& v) const {
    v("from", "s", "", c.times.from);
    v("until", "s", "", c.times.until());
    v("batch_length", "s", "", c.times.length);
    v("batches", "1", "number of batches", c.times.count);
    v.each("quantities", "by name", c.quantities, &Quantity::name, [&](const Quantity& q) {
      v("unit", "", "", q.unit);
      v("a", "`unit`", "mean in A; null for a spectrum", q.a);
      v("a_ci95", "`unit`", "half the width of its 95 % interval", q.a_half_width);
      v("b", "`unit`", "mean in B", q.b);
      v("b_ci95", "`unit`", "half the width of its 95 % interval", q.b_half_width);
      v("difference", "`unit`", "B - A; for a spectrum Kolmogorov's distance", q.difference);
      if (v.has(!q.is_spectrum()))
        v("difference_ci95", "`unit`", "half the width of its 95 % interval", q.half_width);
      if (v.has(q.is_spectrum()))
        v("limit95", "1", "for a spectrum: the distance that 5 % of permutations exceed",
            q.half_width);
      v("probability", "1",
          "probability of such a difference by chance, after Holm; null if not tested",
          q.probability);
      v("verdict", "", "`agree`, `differ`, `too_few`, `not_compared`", name_of(q.verdict));
      if (v.has(!q.reason.empty())) v("reason", "", "reason of `not_compared`", q.reason);
    });
  }
};

}  // namespace

std::string table(const Comparison& c) {
  std::string out = fmt::format(
      "A {}, {} collisions\nB {}, {} collisions\n", c.a.file, c.a.events, c.b.file, c.b.events);
  const auto row = [&](const std::string& name, const std::string& value) {
    out += fmt::format("  {:<26}{}\n", name, value);
  };
  const auto& e = c.events;
  std::string agree = fmt::format("{} agree within {:g}", e.agreeing, c.options.event_tolerance());
  if (e.agreeing > 0) agree += fmt::format(", up to {:g} s", e.horizon);
  if (c.events_verdict)
    agree += fmt::format(": {} ({} required)", name_of(*c.events_verdict), *c.options.events);
  row("event by event", agree);
  if (e.first) {
    row("  same partners", fmt::format("{} events", e.same_partners));
    const double off = e.first->relative_difference;  // nan for partners
    row("  first difference",
        e.first->quantity + (std::isnan(off) ? "" : fmt::format(" by {:.2g}", off)));
    row("    A", describe(e.first->a));
    row("    B", describe(e.first->b));
  }
  if (e.agreeing > 0) {
    std::string largest;
    for (const auto v : values_of(c))
      largest +=
          fmt::format("{}{} {:.1e}", largest.empty() ? "" : ", ", name_of_value(v), e.largest[v]);
    row("  largest before it", largest);
  }
  if (e.digits_lost_per_event)
    row("  digits lost per event", fmt::format("{:.3g}", *e.digits_lost_per_event));
  if (c.times.count > 0) {
    row("statistics",
        fmt::format("{:g} s to {:g} s, {} batches of {:g} s", c.times.from, c.times.until(),
            c.times.count, c.times.length));
    out += fmt::format(
        "  {:<32}{:>22}{:>22}{:>22}{:>9}  {}\n", "quantity", "A", "B", "B - A", "p", "verdict");
    for (const auto& q : c.quantities) {
      // A distance is printed with its limit, which is not an interval.
      out += fmt::format("  {:<32}{:>22}{:>22}{:>22}{:>9}  {}{}\n", q.name + " [" + q.unit + "]",
          interval_of(q.a, q.a_half_width), interval_of(q.b, q.b_half_width),
          q.is_spectrum() ? fmt::format("{:.3g} (< {:.3g})", *q.difference, *q.half_width)
                          : interval_of(q.difference, q.half_width),
          q.probability ? fmt::format("{:.2g}", *q.probability) : "-", name_of(q.verdict),
          q.reason.empty() ? "" : ": " + q.reason);
    }
  }
  row("verdict", std::string(name_of(c.verdict)));
  return out;
}

std::string to_json(const Comparison& c) { return io::JsonFields::of(Fields{c}); }

std::string comparison_keys() { return io::KeyTable::of(Fields{{}}); }

std::string junit_text(const std::string& suite, const std::vector<JunitCase>& cases) {
  using Tree = boost::property_tree::ptree;
  const auto set = [](Tree& element, const char* name, const std::string& value) {
    element.put(std::string("<xmlattr>.") + name, value);
  };
  const auto number_with = [&](std::string JunitCase::*text) {
    return std::count_if(cases.begin(), cases.end(), [=](auto& c) { return !(c.*text).empty(); });
  };
  Tree all;
  set(all, "name", clean_text(suite));
  set(all, "tests", std::to_string(cases.size()));
  set(all, "failures", std::to_string(number_with(&JunitCase::problem)));
  if (const auto skipped = number_with(&JunitCase::not_judged))
    set(all, "skipped", std::to_string(skipped));
  for (const auto& [name, problem, not_judged] : cases) {
    auto& one = all.add("testcase", "");
    set(one, "classname", "edmill");
    set(one, "name", clean_text(name));
    if (!problem.empty()) set(one.add("failure", ""), "message", clean_text(problem));
    if (!not_judged.empty()) set(one.add("skipped", ""), "message", clean_text(not_judged));
  }
  Tree document;
  document.add_child("testsuite", all);
  std::ostringstream text;
  boost::property_tree::write_xml(
      text, document, boost::property_tree::xml_writer_make_settings<std::string>(' ', 2, "UTF-8"));
  return text.str() + "\n";
}

std::string to_junit(const Comparison& c) {
  std::vector<JunitCase> cases;
  const auto add = [&](const std::string& name, Verdict verdict, const std::string& problem) {
    cases.push_back({name, verdict == Verdict::agree ? "" : problem});
  };
  if (c.events_verdict)
    add("events", *c.events_verdict,
        fmt::format("{} events agree, {} must", c.events.agreeing, *c.options.events));
  for (const auto& q : c.quantities)
    if (q.verdict != Verdict::not_compared)
      add(q.name, q.verdict,
          fmt::format("differs by {:.4g} {}, {:.4g} at most", q.difference.value_or(0), q.unit,
              q.half_width.value_or(0)));
  cases.push_back({"enough events", c.verdict == Verdict::too_few ? "too few to compare" : ""});
  return junit_text("edmill compare", cases);
}

}  // namespace edmill::compare
