#include "compare/junit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/property_tree/xml_parser.hpp>
#include <sstream>

#include "base/clean_text.hpp"
#include "compare/comparison.hpp"

namespace edmill::compare {

std::string junit_text(const std::string& suite, const std::vector<JunitCase>& cases) {
  using Tree = boost::property_tree::ptree;
  const auto set = [](Tree& element, const char* name, const std::string& value) {
    element.put(std::string("<xmlattr>.") + name, value);
  };
  const auto number_with = [&](std::string JunitCase::*text) {
    return std::count_if(cases.begin(), cases.end(), [=](const auto& one) { return !(one.*text).empty(); });
  };
  Tree all;
  set(all, "name", clean_text(suite));
  set(all, "tests", std::to_string(cases.size()));
  set(all, "failures", std::to_string(number_with(&JunitCase::problem)));
  if (const auto skipped = number_with(&JunitCase::not_judged)) set(all, "skipped", std::to_string(skipped));
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
