// The fields of a summary: those of its file, in double, by their keys.
#include "io/facts.hpp"

#include <gtest/gtest.h>

#include "base/scalar_list.hpp"
#include "io/json_file.hpp"
#include "io/summary.hpp"

namespace edmill::io {
namespace {

/// With every part.
template <class Real> Summary<Real> whole_summary() {
  Summary<Real> s(model::Partners(std::vector<model::WallInfo>{{"a", "wall a"}, {"b", "wall b"}}));
  s.provenance = {"a \"case\".toml", "digest", {"run.seed=3"}, true, "mpfr50", "1", "2", "3", 7, 5};
  s.error = "why";
  s.start_time = Real(1) / 3, s.end_time = Real(7) / 3;
  s.collisions = {1, 2, 3}, s.impacts = {1, 1, 2},
  s.dose_by_partner = {Real(1) / 7, Real(2) / 7, Real(3) / 7};
  s.milling_dose = Real(6) / 7, s.wall_work = Real(1) / 11;
  s.energy_at_start = {Real(1) / 13, Real(-2)}, s.energy_at_end = {Real(1) / 17, Real(-3)};
  s.energy_closure = Real(1) / 1000000007;
  s.touched_impacts = 2, s.touched_dose = Real(1) / 19, s.supplied_energy = Real(1) / 23;
  s.stall_impacts = 1, s.stall_dose = Real(1) / 29;
  s.collapse = {4, true, 1, Real(5) / 3};
  s.stall = {Real(4) / 3, {1, 2}, {0}, 99};
  s.escalations = {{"float128", 1, 2, 3}, {"rule", 0, 0, 1}};
  s.powder_mass = Real(1) / 250, s.ball_mass = Real(1) / 50;
  s.simultaneous_contacts = 2, s.deepest_overlap = Real(1) / 3000000, s.cpu_seconds = 0.5,
  s.total_impacts = 8, s.fast_impacts = 4;
  s.notes = {{"fastest", Real(2) / 3}};
  s.intervals = {5, 0.4, {{{1, 2}, 0.1}, {{}, 0.2}, {{}, 0.3}}, {{{}, 0.4}, {{}, 0.5}, {{}, 0.6}},
      {{}, 0.7}, {{}, 0.75}, {{1, 2, 3, 4, 5}, 0.8}, {{}, 0.9}, {{}, 1}, "its impacts repeat"};
  s.warnings = {{"transient", "The dose rate drifts."}};
  s.target = {Real(1000), "all of the dose", Real(1) / 31};
  return s;
}

template <class Real> class FactsOf : public testing::Test {};
using Scalars = testing::Types<double, float128>;
TYPED_TEST_SUITE(FactsOf, Scalars);

TYPED_TEST(FactsOf, ASummaryAreThoseOfItsFile) {
  const auto s = whole_summary<TypeParam>();
  const auto facts = facts_of(s);
  const auto file = nlohmann::json::parse(summary_json(s));
  EXPECT_EQ(nlohmann::json::parse(facts.json()), file);
  EXPECT_EQ(nlohmann::json::parse(facts_in(file, "").json()), file);
  EXPECT_EQ(facts.number("collision_rate/total"), 3);
  EXPECT_EQ(facts.number("intervals/milling_dose_rate_by_partner/ball_ball"), 0.6);
  EXPECT_EQ(facts.text("case_file"), "a \"case\".toml");
  EXPECT_EQ(facts.keys_of("escalations"), (Facts::Texts{"float128", "rule"}));
  EXPECT_EQ(end_reason_of(facts), model::EndReason::end_time);
}

TEST(Facts, WhatIsNullIsNothing) {
  const auto facts = facts_of(Summary<double>());
  EXPECT_TRUE(facts.has("milling_dose_rate"));
  for (const auto* path : {"milling_dose_rate", "energy/closure_relative", "powder_mass"})
    EXPECT_FALSE(facts.find(path)) << path;
  EXPECT_NE(facts.json().find("\"closure_relative\": null"), std::string::npos);
}

TEST(Facts, ProblemsNameTheFileAndTheKey) {
  const auto facts = facts_in(
      nlohmann::json::parse(R"({"a": {"b": "x", "c": null}, "end_reason": "bored"})"), "s.json");
  const auto problem = [](const auto& call) {
    try {
      call();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_EQ(problem([&] { facts.number("a/b"); }), "s.json: a.b: found \"x\", expected a number");
  EXPECT_EQ(problem([&] { facts.find("a/b"); }), "s.json: a.b: found \"x\", expected a number");
  EXPECT_EQ(problem([&] { facts.number("a/c"); }), "s.json: a.c: found null, expected a number");
  EXPECT_EQ(problem([&] { facts.text("d"); }), "s.json: d: missing, expected a text");
  EXPECT_EQ(problem([&] { end_reason_of(facts); }),
      "s.json: end_reason: found \"bored\", expected why the run ended");
}

TEST(SummaryReference, HasEveryKeyOfAWholeSummary) {
  const auto table = summary_reference();
  for (const auto* key :
      {"`format`", "`collisions.wall_0`", "`collisions.ball_ball`", "`charge_ratio`",
          "`target.milling_time_half_width`", "`inelastic_collapse.accumulation_time`",
          "`stalled.walls`", "`notes.NAME`", "`escalations.SCALAR.order`"})
    EXPECT_NE(table.find(std::string("| ") + key + " |"), std::string::npos) << key;
}

}  // namespace
}  // namespace edmill::io
