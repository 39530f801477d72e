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

void put(io::JsonText& json, std::string_view key, const std::optional<double>& value) {
  if (value)
    json.number(key, *value);
  else
    json.null(key);
}

void put(io::JsonText& json, std::string_view key, const Event& e) {
  json.begin(key);
  json.integer("line", e.line);
  json.integer("ball", e.ball);
  json.text("partner_kind", e.with_wall ? "wall" : "ball");
  json.integer("partner", e.partner);
  for (std::size_t v = 0; v < model::logged_count; ++v) json.number(model::logged_quantities[v].name, e[v]);
  json.end();
}

void put_log(io::JsonText& json, std::string_view key, const LogScan& scan) {
  json.begin(key);
  json.text("file", scan.file);
  json.integer("events", scan.events);
  json.number("first_time", scan.first);
  json.number("last_time", scan.last);
  json.end();
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
      fmt::format("{} agree within {:g}{}{}", e.agreeing, c.options.tolerance,
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
  json.text("format", "edmill comparison 1");
  json.text("version", version());
  json.text("commit", commit());
  json.text("verdict", name_of(c.verdict));
  put_log(json, "a", c.a);
  put_log(json, "b", c.b);
  json.number("tolerance", c.options.tolerance);

  const auto& e = c.events;
  json.begin("event_by_event");
  json.integer("agreeing", e.agreeing);
  put(json, "horizon", e.agreeing > 0 ? std::optional(e.horizon) : std::nullopt);
  json.integer("same_partners", e.same_partners);
  if (c.events_verdict) {
    json.integer("asked_for", *c.options.events);
    json.text("verdict", name_of(*c.events_verdict));
  }
  if (e.first) {
    json.begin("first_difference");
    json.text("quantity", e.first->quantity);
    json.number("relative_difference", e.first->relative_difference);
    put(json, "a", e.first->a);
    put(json, "b", e.first->b);
    json.end();
  }
  json.begin("largest");
  for (std::size_t v = 0; v < model::logged_count; ++v)
    if (c.a.has[v] && c.b.has[v]) json.number(model::logged_quantities[v].name, e.largest[v]);
  json.end();
  put(json, "digits_lost_per_event", e.digits_lost_per_event);
  json.end();

  if (c.times.count > 0) {
    json.begin("statistics");
    json.number("from", c.times.from);
    json.number("until", c.times.until());
    json.number("batch_length", c.times.length);
    json.integer("batches", c.times.count);
    json.begin("quantities");
    for (const auto& q : c.quantities) {
      json.begin(q.name);
      json.text("unit", q.unit);
      put(json, "a", q.a);
      put(json, "a_ci95", q.a_half_width);
      put(json, "b", q.b);
      put(json, "b_ci95", q.b_half_width);
      put(json, "difference", q.difference);
      put(json, q.difference && !q.a ? "limit95" : "difference_ci95", q.half_width);
      put(json, "probability", q.probability);
      json.text("verdict", name_of(q.verdict));
      if (!q.reason.empty()) json.text("reason", q.reason);
      json.end();
    }
    json.end();
    json.end();
  }
  return json.finish();
}

}  // namespace edmill::compare
