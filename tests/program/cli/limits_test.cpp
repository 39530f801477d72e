// What no scalar decides or resolves: exit codes, messages and what is left on disk. docs/usage.md
#include <gtest/gtest.h>

#include "program.hpp"

namespace edmill {
namespace {

class LimitsTest : public ProgramTest {
 protected:
  static std::string demo() {
    return "'" + (std::filesystem::path(EDMILL_SOURCE_DIR) / "docs/examples/demo.toml").string() +
        "'";
  }
  /// A still vessel of 1 m, gravity of 8 m/s2 along -X.
  void write_still(
      const std::string& balls, const std::string& contact = "restitution = 1\nfriction = 0\n") {
    write("still.toml",
        "[run]\nend_time = \"1 s\"\ngravity = [\"-8\", \"0\", \"0\"]\n[mill]\ntype = "
        "\"still\"\n[vessel]\n"
        "diameter = \"1 m\"\nheight = \"1 m\"\n[contact]\n" +
            contact + balls);
  }
  static std::string ball(const std::string& position, const std::string& velocity) {
    return "[[ball]]\ndiameter = \"0.25 m\"\nposition = " + position + "\nvelocity = " + velocity +
        "\n";
  }
};

/// Thrown up by 1/32 m/s the ball rises 1/16384 m in 1/256 s, just to the cap: its path touches it,
/// and exact arithmetic knows that it does not hit it. It falls back 7/8 m less the rise.
TEST_F(LimitsTest, ATangentFirstFlightHitsNothing) {
  write_still(ball("[0.37493896484375, \"0\", \"0\"]", "[\"0.03125\", \"0\", \"0\"]"));
  const auto outcome = edmill("run still.toml --out out --quiet");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(edmill("check still.toml").code, 0);
  const auto certified = edmill("certify still.toml --collisions 1 --out events.csv");
  EXPECT_EQ(certified.code, 0) << certified.err;
  // From the highest point at 1/256 s down 0.75 m: sqrt(2 0.75 / 8) s later.
  EXPECT_NE(contents(scratch / "events.csv").find("4.369189518922193"), std::string::npos)
      << contents(scratch / "events.csv");
}

/// 0.375 m at 1.5 m/s without gravity: the wall is reached at the end of the 32nd search.
TEST_F(LimitsTest, AContactAtTheEndOfASearchIsAnOrdinaryOne) {
  write_still(ball("[\"0\", \"0\", \"0\"]", "[\"1.5\", \"0\", \"0\"]"));
  const auto outcome = edmill("run still.toml --set 'run.gravity=\"0 m/s2\"' --out out --quiet");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(contents(scratch / "out/summary.json").find("\"wall_0\": 1"), std::string::npos);
}

TEST_F(LimitsTest, ABallThatLiesOnAWallHopsAtTheLeastSeparationSpeed) {
  write_still(ball("[-0.375, \"0\", \"0\"]", "[\"0\", \"0\", \"0\"]"),
      "restitution = 0.5\nfriction = 0.4\n");
  const auto outcome = edmill("run still.toml --out out --quiet");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  // 1 s of hops of 2 v_s / g = 2.5 ms, the first at once.
  EXPECT_NE(contents(scratch / "out/summary.json").find("\"wall_1\": 40"), std::string::npos)
      << contents(scratch / "out/summary.json");
  EXPECT_EQ(
      edmill("run still.toml --set contact.least_separation='\"0 m/s\"' --out exact --quiet").code,
      3);
}

TEST_F(LimitsTest, WhatARuleDecidesIsNotCertified) {
  // Two balls reach a third one at the same time.
  write_still(ball("[\"-0.3\", \"0.25\", \"0\"]", "[\"0.1\", \"0\", \"0\"]") +
          ball("[\"0\", \"0.25\", \"0\"]", "[\"0\", \"0\", \"0\"]") +
          ball("[\"0.3\", \"0.25\", \"0\"]", "[\"-0.1\", \"0\", \"0\"]"),
      "restitution = 0.5\nfriction = 0\n");
  const std::string no_gravity = " --set 'run.gravity=\"0 m/s2\"' ";
  const auto certified = edmill("certify still.toml --collisions 1 --out events.csv" + no_gravity);
  EXPECT_EQ(certified.code, 4) << certified.out << certified.err;
  EXPECT_NE(certified.err.find("a rule and not the equations orders them"), std::string::npos)
      << certified.err;
  EXPECT_FALSE(std::filesystem::exists(scratch / "events.csv"));
  ASSERT_EQ(edmill("run still.toml --out out --quiet" + no_gravity).code, 0);
  EXPECT_EQ(contents(scratch / "out/summary.json").find("\"simultaneous_contacts\": 0"),
      std::string::npos);
}

TEST_F(LimitsTest, WhatTheScalarCannotResolveIsRefused) {
  const auto refused = [&](const std::string& settings, const std::string& message) {
    const auto outcome = edmill("check " + demo() + settings);
    EXPECT_EQ(outcome.code, 2) << settings << outcome.out << outcome.err;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << outcome.err;
    EXPECT_EQ(edmill("run " + demo() + settings + " --out out --quiet").code, 2);
    EXPECT_FALSE(std::filesystem::exists(scratch / "out/summary.json"));
  };
  refused(
      " --set 'balls.0.diameter=\"1e-15 m\"'", "found a ball of radius 5e-16 m, expected at least");
  refused(" --set 'vessel.diameter=\"1e15 m\"' --set 'vessel.height=\"1e15 m\"'",
      "found a ball of radius");
  refused(" --set 'contact.least_separation=\"1e-9 m/s\"'",
      "key 'contact.ball_ball.least_separation': found 1e-09 m/s, expected 0 or at least");
  // A wider scalar resolves them.
  EXPECT_EQ(
      edmill("check " + demo() + " --set 'balls.0.diameter=\"1e-15 m\"' --set run.precision=mpfr50")
          .code,
      0);
  EXPECT_EQ(edmill("check " + demo() +
                " --set 'contact.least_separation=\"1e-9 m/s\"' --set run.precision=float128")
                .code,
      0);
}

TEST_F(LimitsTest, AnOutputCannotTakeTheNameOfAFileOfTheRun) {
  for (const std::string file :
      {"case.toml", "report.html", "summary.json", "final_state.csv", "checkpoint"})
    for (const std::string folder : {"", ", folder=\"./\"", ", folder=\"x/./..\""}) {
      const auto outcome = edmill("check " + demo() +
          " --set 'output=[{type=\"trace\", variables=[\"time\"], file=\"" + file + "\"" + folder +
          "}]'");
      EXPECT_EQ(outcome.code, 2) << file << folder << outcome.out;
    }
}

}  // namespace
}  // namespace edmill
