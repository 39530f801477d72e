// A log of the faulty mill in a test's scratch folder, changes to its lines, and its audit.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <sstream>

#include "audit/audit.hpp"
#include "base/errors.hpp"
#include "faulty_mill.hpp"
#include "identify/identify.hpp"
#include "program.hpp"
#include "spex_case.hpp"

namespace edmill::testing {

/// A log of a faulty mill, and the audit of it.
class FaultyLog : public ProgramTest {
 protected:
  using Audit = audit::Audit;
  using Check = audit::Check;
  using Kind = audit::Kind;

  /// Two kinds of balls of unequal mass and inertia, gravity; the default least separation speed.
  void prepare(const std::string& contact = "restitution = 0.53") {
    spec = casefile::parse_case(
        testing::spex_text("end_time = \"10 s\"\nseed = 7", contact,
            testing::batch(2, "9.52 mm") + testing::batch(3, "4.76 mm", "reduced_inertia = 0.6\n")),
        "faulty.toml");
    built = casefile::build_case<double>(spec);
  }
  Audit judged(const std::string& name = "log.csv") {
    audit::Options options;
    options.log = scratch / name;
    options.from_start = true;
    return audit::audit(built.the_case, built.states, options);
  }
  /// The single cause of the violations, first of those that fit alike; "" for none.
  std::string cause() const {
    audit::Options options;
    options.log = scratch / "log.csv";
    const auto found = identify::identify(spec, options, identify::Search::single);
    return found.causes.empty() ? "" : found.causes[0].text();
  }
  void expect_cause(const std::string& beginning) const {
    EXPECT_EQ(cause().substr(0, beginning.size()), beginning);
  }
  /// Kinds found, and the whole table when they are not as wanted.
  static void expect_kinds(const Audit& result, const std::set<Kind>& wanted) {
    const auto ranked = result.findings.ranked();
    EXPECT_EQ(std::set<Kind>(ranked.begin(), ranked.end()), wanted) << audit::table(result);
    EXPECT_EQ(result.verdict, wanted.empty() ? audit::Verdict::agree : audit::Verdict::differ);
  }
  /// Runs the mill with a mistake. @return how often a periodic mistake was made
  int simulate(const Faults& faults, int events = 400) {
    return FaultyMill(built.the_case, built.states, faults).write_log(scratch / "log.csv", events);
  }
  static std::uint64_t count(const Audit& result, Kind kind) {
    return result.findings.of(kind).count;
  }
  static bool looks_like(const Audit& result, const std::string& name) {
    for (const auto& d : result.diagnoses)
      if (d.name == name) return true;
    return false;
  }

  // Changes to a log's lines.
  std::vector<std::string> lines() const {
    std::istringstream in(contents(scratch / "log.csv"));
    std::vector<std::string> all;
    for (std::string line; std::getline(in, line);) all.push_back(line);
    return all;
  }
  void write_lines(const std::vector<std::string>& all) const {
    std::string text;
    for (const auto& line : all) text += line + "\n";
    write("log.csv", text);
  }
  static std::vector<std::string> fields(const std::string& line) {
    std::vector<std::string> all{""};
    for (const char c : line)
      if (c == ',')
        all.emplace_back();
      else
        all.back() += c;
    return all;
  }
  /// Changes one field of one line. Columns: 1 time, 2 ball, 3 kind, 4 partner, 7 dose, 8 work, 9
  /// x, 15 wx_before.
  void change(std::size_t line, std::size_t column,
      const std::function<std::string(const std::string&)>& how) const {
    auto all = lines();
    auto parts = fields(all.at(line));
    parts.at(column) = how(parts.at(column));
    all[line].clear();
    for (std::size_t k = 0; k < parts.size(); ++k) all[line] += (k > 0 ? "," : "") + parts[k];
    write_lines(all);
  }
  /// The first line from `from` on with a partner of this kind and at least this dose.
  std::size_t line_with(const std::string& kind, std::size_t from = 100, double dose = 1e-5) const {
    const auto all = lines();
    for (std::size_t k = from; k < all.size(); ++k) {
      const auto parts = fields(all[k]);
      if (parts[3] == kind && std::stod(parts[7]) > dose) return k;
    }
    throw ContractError("no such line");
  }

  casefile::CaseSpec spec;
  casefile::InitialCase<double> built;
};

}  // namespace edmill::testing
