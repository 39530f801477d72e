// The command `edmill compare` on runs of edmill: exit codes, messages, JSON.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "program.hpp"

namespace edmill {
namespace {

class CompareCommand : public ProgramTest {
 protected:
  void run(const std::string& folder, const std::string& settings) const {
    const auto outcome = edmill("run " EDMILL_SOURCE_DIR "/docs/examples/demo.toml --quiet --out " +
        folder + " --set 'output=[{type=\"collisions\"}]' " + settings);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  nlohmann::json result() const { return nlohmann::json::parse(contents(scratch / "result.json")); }
};

TEST_F(CompareCommand, DoubleAndFloat128PartByRoundingAndAgreeInStatistics) {
  run("reference", "--precision float128 --set run.end_time='2 s'");
  run("double", "--set run.end_time='2 s'");
  // Rounding grows by about a digit in 75 events here: 1e-9 is reached before 1e-4.
  const auto strict = edmill("compare reference double --json result.json");
  EXPECT_EQ(strict.code, 0) << strict.out << strict.err;
  const auto events = result()["event_by_event"];
  EXPECT_GE(events["agreeing"], 150);
  EXPECT_GE(events["same_partners"], 500);
  EXPECT_GT(events["digits_lost_per_event"], 0.005);
  EXPECT_LT(events["digits_lost_per_event"], 0.05);
  EXPECT_LE(events["largest"]["approach_speed"], 1e-9);
  EXPECT_EQ(result()["statistics"]["from"], 0.5);  // where the run's own statistics begin

  EXPECT_EQ(
      edmill("compare reference double --tolerance 1e-4 --events 500 --json result.json").code, 0);
  EXPECT_GE(result()["event_by_event"]["agreeing"], 500);
  EXPECT_EQ(result()["verdict"], "agree");
  const auto demanding = edmill("compare reference double --events 100000 --json result.json");
  EXPECT_EQ(demanding.code, 6);
  EXPECT_EQ(result()["event_by_event"]["verdict"], "differ");
}

TEST_F(CompareCommand, ARestitutionThatIsFivePercentOffIsFound) {
  run("a", "--set run.seed=1");
  // Equal cases are reported to differ with a probability of 5 %: more than one of six with one of
  // 3 %.
  int alarms = 0;
  for (int seed = 2; seed <= 7; ++seed) {
    run("b", "--set run.seed=" + std::to_string(seed));
    run("c", "--set run.seed=" + std::to_string(seed + 10));
    const auto good = edmill("compare b c");
    EXPECT_TRUE(good.code == 0 || good.code == 6) << good.err;
    alarms += good.code == 6;
  }
  EXPECT_LE(alarms, 1);
  run("off", "--set run.seed=3 --set contact.restitution=0.5565");
  const auto bad = edmill("compare a off --json result.json");
  EXPECT_EQ(bad.code, 6) << bad.out;
  EXPECT_EQ(result()["statistics"]["quantities"]["milling_dose_spectrum"]["verdict"], "differ");
  EXPECT_NE(bad.out.find("differ"), std::string::npos);
}

TEST_F(CompareCommand, TheTableAndTheJsonHoldTheSameRows) {
  run("a", "--set run.end_time='1 s'");
  const auto outcome = edmill("compare a a/collisions.csv --json result.json");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(result()["format"], "edmill comparison 1");
  EXPECT_EQ(result()["event_by_event"]["agreeing"], result()["a"]["events"]);
  const auto quantities = result()["statistics"]["quantities"];
  EXPECT_EQ(quantities.size(), 10u);
  for (const auto& [name, row] : quantities.items()) {
    EXPECT_NE(outcome.out.find(name), std::string::npos) << name;
    EXPECT_EQ(row["verdict"], "agree");
  }
  // The batches contain what summary.json counts, except for the last moments before the end.
  const auto summary = nlohmann::json::parse(contents(scratch / "a/summary.json"));
  for (const std::string kind : {"wall_2", "ball_ball"}) {
    const double rate = summary["collision_rate"][kind];
    EXPECT_NEAR(quantities["collision_rate_" + kind]["a"], rate, 0.005 * rate) << kind;
  }
  const double power = summary["milling_dose_rate"];
  EXPECT_NEAR(quantities["milling_dose_rate"]["a"], power, 0.005 * power);
  EXPECT_EQ(edmill("compare a a --quiet").out, "");
}

TEST_F(CompareCommand, BadInputIsExplained) {
  const std::string header = "time,ball,partner_kind,partner,approach_speed\n";
  write("good.csv", header + "1,0,wall,0,1\n2,0,wall,1,1\n");
  write("later.csv", header + "3,0,wall,0,1\n4,0,wall,1,1\n");
  write("bad.csv", header + "1,0,wall,0,fast\n");
  write("other.csv", "t,v\n1,2\n");
  const auto expect = [&](const std::string& arguments, const std::string& message,
                          std::size_t lines = 1) {
    const auto outcome = edmill("compare " + arguments + " --json result.json");
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << outcome.err << "wanted: " << message;
    EXPECT_EQ(
        static_cast<std::size_t>(std::count(outcome.err.begin(), outcome.err.end(), '\n')), lines)
        << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(scratch / "result.json"));
  };
  expect("good.csv bad.csv",
      "bad.csv:2: column 5 (approach_speed): found 'fast', expected a finite number");
  expect("bad.csv other.csv", "other.csv:1: the header has no column 'time'", 6);
  expect("good.csv missing.csv", "missing.csv: no readable file");
  expect("good.csv .", "type \"collisions\"");
  expect("good.csv later.csv", "time in common");
  expect("good.csv", "B is required");
  expect("good.csv good.csv --tolerance -1", "--tolerance");
  expect("good.csv good.csv --batch 0", "--batch");
}

TEST_F(CompareCommand, TooFewEventsHaveTheirExitCode) {
  const std::string header = "time,ball,partner_kind,partner,approach_speed\n";
  write("a.csv", header + "1,0,wall,0,1\n2,0,wall,1,1\n");
  write("b.csv", header + "1,0,wall,0,1\n2,0,wall,2,1\n");
  EXPECT_EQ(edmill("compare a.csv b.csv").code, 7);
  EXPECT_EQ(edmill("compare a.csv a.csv").code, 0);
}

}  // namespace
}  // namespace edmill
