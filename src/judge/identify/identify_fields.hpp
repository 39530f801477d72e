// The fields of an identification, within the document of an audit.
#pragma once

#include "identify/identify.hpp"
#include "io/fields.hpp"

namespace edmill::identify {

struct Fields {
  const Identification& found;

  void operator()(auto& v) const {
    v.group("identified", "causes; present if there are violations, or with `--identify`",
        [&] { all(v); });
  }
 private:
  void all(auto& v) const {
    v("events", "1", "number of events searched", found.events);
    v("violations", "1", "number of violations in them", found.violations);
    if (v.has(found.too_few || found.interrupted))
      v("ended", "",
          "why the search for causes was not completed: `too few impacts`, `interrupted`",
          found.interrupted ? "interrupted" : "too few impacts");
    if (v.has(found.follows.has_value()))
      v("follows", "1",
          "number of impacts that a run of the case reproduces, for a log without states",
          found.follows);
    v.group("tried", "the extent of the search", [&] {
      v("numbers", "1", "numbers of the case and terms of the equations", found.tried.numbers);
      v("mistakes", "1", "mistakes other than wrong numbers", found.tried.mistakes);
      v("parts", "1", "parts of the log", found.tried.parts);
      v("stages", "", "", fmt::format("{}", fmt::join(found.tried.stages, "; ")));
    });
    v.numbered("causes", "by rank ([audit.md](audit.md#causes))", found.causes,
        [&](const Cause& cause) { one(v, cause); });
    v.group("time_stepping", "signs of time steps", [&] { stepping(v, found.stepping); });
  }
  static void one(auto& v, const Cause& cause) {
    v("text", "", "", cause.text());
    v("explains", "1", "number of violations that it explains", cause.explains);
    if (v.has(!cause.others.empty()))
      v("others", "", "kinds of the violations that it does not explain", cause.others);
    if (v.has(cause.could_follow > 0)) {
      v("follows", "1", "number of impacts that a run with it reproduces, for a log without states",
          cause.follows);
      v("could_follow", "1", "number of impacts that a run can reproduce in spite of rounding",
          cause.could_follow);
    }
    v("gain", "1", "gain in Schwarz's criterion over no cause", cause.gain);
    const auto numbers = fitted(cause);
    std::vector<std::string> mistakes;
    for (std::size_t m = 0; m + numbers.size() < cause.found.size(); ++m)
      mistakes.push_back(cause.found[m].what.name());
    v.texts("mistakes", "by number", mistakes);
    const auto key = [](const Found& f) { return f.what.key; };
    v.each("values", "by key", std::vector<Found>(numbers.begin(), numbers.end()), key,
        [&](const Found& f) {
          v("value", "", "SI", f.value);
          v("half_width", "", "half-width of its interval", f.half_width);
          v("nominal", "", "value of the case", f.what.value);
          if (v.has(!f.what.in_place_of.empty()))
            v("in_place_of", "", "for a number of another contact law: the law of the case",
                f.what.in_place_of);
          if (v.has(!f.what.equation.empty()))
            v("equation", "", "equation of a term", f.what.equation);
        });
    v.texts("alike", "causes that the log cannot distinguish from it, by number", cause.alike);
  }
  static void stepping(auto& v, const TimeStepping& found) {
    const auto time = [&](const char* key, const char* meaning, const auto& value) {
      if (v.has(value.has_value())) v(key, "s", meaning, value);
    };
    time("step", "all times are multiples of it", found.step);
    time("step_by_depth", "step by overlaps: contacts are detected up to a step late",
        found.step_by_depth);
    time("first_order_step", "step of an integrator of first order", found.first_order_step);
    time("jitter", "root mean square of the errors of single times", found.jitter);
    if (v.has(found.second_order)) v("order", "1", "2 if flights show no error of first order", 2);
    if (!v.has(found.soft.has_value())) return;
    const auto soft = found.soft.value_or(SoftContacts{});
    v.group("soft_contacts", "contacts that last", [&] {
      v("duration", "s", "median", soft.duration);
      v("low", "s", "lower quartile", soft.low);
      v("high", "s", "upper quartile", soft.high);
      v("logged_at", "", "`begin` or `end` of a contact",
          soft.at == LoggedAt::end ? "end" : "begin");
      v("contacts", "1", "number of contacts that show it", soft.contacts);
      v("exponent", "1",
          "exponent of the duration over approach speed: 0 for a linear spring, -1/5 for Hertz's "
          "contacts",
          soft.exponent);
      v("spring", "N/m", "stiffness of a linear spring with this duration", soft.spring);
      v("modulus", "Pa", "effective modulus of Hertz's contacts with this duration", soft.modulus);
    });
  }
};

}  // namespace edmill::identify
