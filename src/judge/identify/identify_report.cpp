#include <fmt/format.h>
#include <fmt/ranges.h>

#include "identify/identify.hpp"

namespace edmill::identify {

std::string Cause::text() const {
  std::string text;
  const auto join = [&](const std::string& part) { text += (text.empty() ? "" : ", and ") + part; };
  for (const auto& v : found) {
    const auto& n = v.what;
    if (!n.is_fitted()) {
      join(n.name());
      continue;
    }
    const bool is_factor = !n.equation.empty() && n.dimension == Dimension::none;
    const auto word = is_factor ? word_for(v.value, v.half_width) : "";
    const auto equation = n.equation.empty() ? "" : " " + n.equation;
    join(fmt::format("{}{}{} = {} in place of {}{}", n.key, equation, is_factor ? ": factor" : "",
        value_text(n.dimension, v.value, v.half_width),
        n.in_place_of.empty() ? value_text(n.dimension, n.value) : n.in_place_of,
        word.empty() ? "" : ", " + word));
  }
  return text;
}

std::string table(const TimeStepping& found) {
  std::string out;
  if (found.soft) {
    const auto& s = *found.soft;
    const std::string law = !std::isfinite(s.exponent) ? ""
        : s.exponent < -0.1
        ? fmt::format("; it falls as speed^{:.2f}, as for Hertz's contacts", s.exponent)
        : fmt::format("; it scales as speed^{:.2f}, as for a linear spring", s.exponent);
    out += fmt::format(
        "  looks like   soft contacts that last {:.3g} us (quartiles {:.3g} and {:.3g}), shown by "
        "{} "
        "impacts, logged at their {}{}\n"
        "    stiffness {:.3g} N/m of a linear spring, or E* {:.3g} GPa of Hertz's contacts\n",
        s.duration * 1e6, s.low * 1e6, s.high * 1e6, s.contacts,
        s.at == LoggedAt::begin ? "start" : "end", law, s.spring, s.modulus / 1e9);
  }
  const auto sign = [&](const std::optional<double>& time, fmt::format_string<const double&> text) {
    if (time) out += "  looks like   " + fmt::format(text, *time) + "\n";
  };
  sign(found.step,
      "time steps: all times are multiples of {:.6g} s, the step or the rounding of times");
  sign(found.step_by_depth,
      "contacts found by overlap, with a step near {:.3g} s; a --gap-tolerance of the worst "
      "overlap accepts "
      "them");
  sign(found.first_order_step,
      "an integrator of first order with steps of {:.3g} s: flights leave the parabola by g h t/2, "
      "h the "
      "step");
  sign(found.jitter,
      "times with errors of {:.3g} s (root mean square), early and late alike: flights deviate "
      "along their "
      "paths alone");
  if (found.second_order)
    out += "    flights under gravity have no error of first order in the step\n";
  return out;
}

std::string table(const Identification& found) {
  std::string out = "\n";
  for (const auto& cause : found.causes) {
    if (cause.could_follow > 0) {
      out += fmt::format(
          "  looks like   {}: a run with it reproduces the first {} impacts of the log, the case "
          "as given "
          "{}\n",
          cause.text(), cause.follows, found.follows.value_or(0));
      continue;
    }
    out += fmt::format(
        "  looks like   {}: explains {} of {} violations", cause.text(), cause.explains, cause.of);
    if (!cause.others.empty())
      out += fmt::format("; {} others: {}", cause.of - cause.explains, cause.others);
    out += '\n';
    for (const auto& other : cause.alike)
      out += fmt::format("    this log cannot distinguish it from   {}\n", other);
  }
  out += table(found.stepping);
  if (found.interrupted)
    return out +
        (found.causes.empty() ? "  interrupted before a cause was found\n"
                              : "  interrupted: better causes were not sought\n");
  if (found.too_few) return out + "  no cause sought: too few impacts\n";
  const auto& causes = found.causes;
  const bool explained = !causes.empty() && audit::accounts_for(causes[0].explains, causes[0].of);
  std::string further;
  if (found.search == Search::single && !explained)
    further = "  --identify searches parts of the log, and two and three causes together\n";
  if (!causes.empty()) return out + further;
  if (found.follows)
    out += found.follows_all
        ? fmt::format(
              "  no cause: a run of the case reproduces the log, {} impacts, as far as rounding "
              "lets "
              "it\n",
              *found.follows)
        : fmt::format("  no cause found: a run of the case reproduces the first {} impacts\n",
              *found.follows);
  else if (found.violations > 0 && !found.stepping.found())
    out += fmt::format(
               "  no cause explains nine tenths of the {} violations of {} impacts\n  tried: {}; "
               "{} numbers and "
               "terms, {} mistakes, {} parts of the log\n",
               found.violations, found.events, fmt::join(found.tried.stages, ", "),
               found.tried.numbers, found.tried.mistakes, found.tried.parts) +
        further;
  else if (found.violations == 0)
    out += fmt::format(
        "  no cause: no violation in the columns of the first {} impacts\n", found.events);
  return out;
}

}  // namespace edmill::identify
