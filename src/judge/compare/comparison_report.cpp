#include <fmt/format.h>

#include <cmath>

#include "base/version.hpp"
#include "compare/comparison.hpp"
#include "io/json_text.hpp"

namespace edmill::compare {

namespace {

std::string describe(const Event& e) {
  std::string text = fmt::format("line {}: t = {} s, ball {} with {} {}", e.line, e.time, e.ball,
                                 e.with_wall ? "wall" : "ball", e.partner);
  for (std::size_t v = model::approach_speed; v < model::logged_count; ++v)
    if (!std::isnan(e[v])) text += fmt::format(", {} {}", model::logged_quantities[v].name, e[v]);
  return text;
}

/// "12.3 ± 0.4", without what is missing.
std::string with_interval(const std::optional<double>& value, const std::optional<double>& half_width) {
  if (!value) return "-";
  return half_width ? fmt::format("{:.6g} ± {:.2g}", *value, *half_width) : fmt::format("{:.6g}", *value);
}

void put(io::JsonText& json, std::string_view key, const Event& e) {
  json.begin(key);
  json.add("line", e.line, "ball", e.ball, "partner_kind", e.with_wall ? "wall" : "ball", "partner",
           e.partner);
  for (std::size_t v = 0; v < model::logged_count; ++v) json.add(model::logged_quantities[v].name, e[v]);
  json.end();
}

void put_log(io::JsonText& json, std::string_view key, const LogScan& scan) {
  json.add_group(key, "file", scan.file, "events", scan.events, "first_time", scan.first, "last_time",
                 scan.last);
}

}  // namespace

std::string table(const Comparison& c) {
  std::string out =
      fmt::format("A {}, {} collisions\nB {}, {} collisions\n", c.a.file, c.a.events, c.b.file, c.b.events);
  const auto row = [&](const std::string& name, const std::string& value) {
    out += fmt::format("  {:<26}{}\n", name, value);
  };
  const auto& e = c.events;
  row("event by event",
      fmt::format("{} agree within {:g}{}{}", e.agreeing, c.options.event_tolerance(),
                  e.agreeing > 0 ? fmt::format(", up to {:g} s", e.horizon) : "",
                  c.events_verdict
                      ? fmt::format(": {} ({} required)", name_of(*c.events_verdict), *c.options.events)
                      : ""));
  if (e.first) {
    row("  same partners", fmt::format("{} events", e.same_partners));
    row("  first difference", e.first->quantity == "partners" ? std::string("partners")
                                                              : fmt::format("{} by {:.2g}", e.first->quantity,
                                                                            e.first->relative_difference));
    row("    A", describe(e.first->a));
    row("    B", describe(e.first->b));
  }
  if (e.agreeing > 0) {
    std::string largest;
    for (std::size_t v = 0; v < model::logged_count; ++v)
      if (c.a.has[v] && c.b.has[v])
        largest += fmt::format("{}{} {:.1e}", largest.empty() ? "" : ", ", model::logged_quantities[v].name,
                               e.largest[v]);
    row("  largest before it", largest);
  }
  if (e.digits_lost_per_event)
    row("  digits lost per event", fmt::format("{:.3g}", *e.digits_lost_per_event));
  if (c.times.count > 0) {
    row("statistics", fmt::format("{:g} s to {:g} s, {} batches of {:g} s", c.times.from, c.times.until(),
                                  c.times.count, c.times.length));
    out +=
        fmt::format("  {:<32}{:>22}{:>22}{:>22}{:>9}  {}\n", "quantity", "A", "B", "B - A", "p", "verdict");
    for (const auto& q : c.quantities) {
      // A distance is printed with its limit, which is not an interval.
      const bool spectrum = q.difference && !q.a;
      out += fmt::format("  {:<32}{:>22}{:>22}{:>22}{:>9}  {}{}\n", q.name + " [" + q.unit + "]",
                         with_interval(q.a, q.a_half_width), with_interval(q.b, q.b_half_width),
                         spectrum ? fmt::format("{:.3g} (< {:.3g})", *q.difference, *q.half_width)
                                  : with_interval(q.difference, q.half_width),
                         q.probability ? fmt::format("{:.2g}", *q.probability) : "-", name_of(q.verdict),
                         q.reason.empty() ? "" : ": " + q.reason);
    }
  }
  row("verdict", std::string(name_of(c.verdict)));
  return out;
}

std::string to_json(const Comparison& c) {
  io::JsonText json;
  json.add("format", "edmill comparison 1", "version", version(), "commit", commit(), "verdict",
           name_of(c.verdict));
  put_log(json, "a", c.a);
  put_log(json, "b", c.b);
  json.add("tolerance", c.options.event_tolerance());

  const auto& e = c.events;
  json.begin("event_by_event");
  json.add("agreeing", e.agreeing, "horizon", e.agreeing > 0 ? std::optional(e.horizon) : std::nullopt,
           "same_partners", e.same_partners);
  if (c.events_verdict) json.add("asked_for", *c.options.events, "verdict", name_of(*c.events_verdict));
  if (e.first) {
    json.begin("first_difference");
    json.add("quantity", e.first->quantity, "relative_difference", e.first->relative_difference);
    put(json, "a", e.first->a);
    put(json, "b", e.first->b);
    json.end();
  }
  json.begin("largest");
  for (std::size_t v = 0; v < model::logged_count; ++v)
    if (c.a.has[v] && c.b.has[v]) json.add(model::logged_quantities[v].name, e.largest[v]);
  json.end();
  json.add("digits_lost_per_event", e.digits_lost_per_event);
  json.end();

  if (c.times.count > 0) {
    json.begin("statistics");
    json.add("from", c.times.from, "until", c.times.until(), "batch_length", c.times.length, "batches",
             c.times.count);
    json.groups("quantities", c.quantities, &Quantity::name, [&](const auto& q) {
      json.add("unit", q.unit, "a", q.a, "a_ci95", q.a_half_width);
      json.add("b", q.b, "b_ci95", q.b_half_width, "difference", q.difference);
      json.add(q.difference && !q.a ? "limit95" : "difference_ci95", q.half_width, "probability",
               q.probability, "verdict", name_of(q.verdict));
      if (!q.reason.empty()) json.add("reason", q.reason);
    });
    json.end();
  }
  return json.finish();
}

}  // namespace edmill::compare
