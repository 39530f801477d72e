#include "compare/junit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>
#include <sstream>

#include "base/clean_text.hpp"
#include "compare/comparison.hpp"

namespace edmill::compare {

std::string junit_text(const std::string& suite, const std::vector<JunitCase>& cases) {
  pugi::xml_document document;
  auto declaration = document.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "UTF-8";
  auto all = document.append_child("testsuite");
  all.append_attribute("name") = clean_text(suite).c_str();
  all.append_attribute("tests") = cases.size();
  const auto number_with = [&](std::string JunitCase::*text) {
    return std::count_if(cases.begin(), cases.end(), [=](const auto& one) { return !(one.*text).empty(); });
  };
  all.append_attribute("failures") = number_with(&JunitCase::problem);
  if (const auto skipped = number_with(&JunitCase::not_judged)) all.append_attribute("skipped") = skipped;
  for (const auto& [name, problem, not_judged] : cases) {
    auto one = all.append_child("testcase");
    one.append_attribute("classname") = "edmill";
    one.append_attribute("name") = clean_text(name).c_str();
    if (!problem.empty())
      one.append_child("failure").append_attribute("message") = clean_text(problem).c_str();
    if (!not_judged.empty())
      one.append_child("skipped").append_attribute("message") = clean_text(not_judged).c_str();
  }
  std::ostringstream text;
  document.save(text, "  ");
  return text.str();
}

std::string to_junit(const Comparison& c) {
  std::vector<JunitCase> cases;
  if (c.events_verdict)
    cases.push_back(
        {"events", *c.events_verdict == Verdict::agree
                       ? ""
                       : fmt::format("{} events agree, {} must", c.events.agreeing, *c.options.events)});
  for (const auto& q : c.quantities) {
    if (q.verdict == Verdict::not_compared) continue;
    cases.push_back({q.name, q.verdict == Verdict::agree
                                 ? ""
                                 : fmt::format("differs by {:.4g} {}, {:.4g} at most",
                                               q.difference.value_or(0), q.unit, q.half_width.value_or(0))});
  }
  cases.push_back({"enough events", c.verdict == Verdict::too_few ? "too few to compare" : ""});
  return junit_text("edmill compare", cases);
}

}  // namespace edmill::compare
