// The program reproduces the reference sequences from the cases, and reports when it cannot.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "program.hpp"

namespace edmill {
namespace {

class CertifyTest : public ProgramTest {
 protected:
  static std::filesystem::path reference(const std::string& name) {
    return std::filesystem::path(EDMILL_SOURCE_DIR) / "regression/reference" / name;
  }
  /// The lines of events, without the comments, which name the program that made them.
  static std::vector<std::string> events(const std::filesystem::path& file) {
    std::istringstream text(contents(file));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);)
      if (line.rfind('#', 0) != 0) lines.push_back(line);
    return lines;
  }
  void is_made_again(const std::string& name, int count) {
    const auto expected = events(reference(name + ".events.csv"));
    ASSERT_EQ(expected.size(), static_cast<std::size_t>(count) + 1);
    const auto made = edmill("certify '" + reference(name + ".toml").string() + "' --collisions " +
        std::to_string(count) + " --out events.csv");
    ASSERT_EQ(made.code, 0) << made.err;
    std::cout << "claim certified events, " << name << ": " << made.out;
    const auto found = events(scratch / "events.csv");
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k)
      ASSERT_EQ(found[k], expected[k]) << "line " << k;
  }
};

TEST_F(CertifyTest, OneBall) { is_made_again("one_ball", 500); }
TEST_F(CertifyTest, ThreeBalls) { is_made_again("three_balls", 500); }
TEST_F(CertifyTest, TwentyEightBalls) { is_made_again("balls_28", 2000); }
TEST_F(CertifyTest, PlanetaryJar) { is_made_again("planetary", 500); }
TEST_F(CertifyTest, ShakenBox) { is_made_again("box", 500); }
TEST_F(CertifyTest, StirredTank) { is_made_again("stirred", 500); }

TEST_F(CertifyTest, GoesOnWhereTheWidestScalarOfFixedDigitsDoesNotSuffice) {
  const auto outcome = edmill("certify '" + reference("balls_28.toml").string() +
      "' --collisions 6000 --digits 90 --out events.csv");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("mpfr100 and mpfr200: 6000 events in common"), std::string::npos)
      << outcome.out;
  EXPECT_NE(outcome.out.find("\nmpfr:"), std::string::npos) << outcome.out;
  EXPECT_TRUE(std::filesystem::exists(scratch / "events.csv"));
}

/// Three walls at one time: a rule orders them, in every scalar.
TEST_F(CertifyTest, WhatTheEquationsDoNotOrderIsNotWritten) {
  std::ofstream(scratch / "corner.toml")
      << "[run]\nend_time = \"1 s\"\n[mill]\ntype = \"still\"\n[vessel]\ntype = \"box\"\nsize = "
         "[\"40 mm\", "
         "\"40 mm\", "
         "\"40 mm\"]\n[contact]\nrestitution = 0.5\nfriction = 0\n[[ball]]\ndiameter = \"10 "
         "mm\"\nposition = "
         "[0, 0, "
         "0]\nvelocity = [\"1 m/s\", \"1 m/s\", \"1 m/s\"]\n";
  const auto outcome = edmill("certify corner.toml --collisions 3 --out events.csv");
  EXPECT_EQ(outcome.code, 4);
  EXPECT_NE(outcome.err.find("a rule and not the equations orders them"), std::string::npos)
      << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(scratch / "events.csv"));
}

TEST_F(CertifyTest, AnotherCaseHasOtherEvents) {
  const auto outcome = edmill("certify '" + reference("one_ball.toml").string() +
      "' --set contact.friction=0.41 --collisions 500 --out events.csv --quiet");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(events(scratch / "events.csv"), events(reference("one_ball.events.csv")));
}

TEST_F(CertifyTest, ShadowTellsWhereTheRunsPart) {
  const auto outcome = edmill("run '" + reference("balls_28.toml").string() +
      "' --set 'run.end_time=\"0.2 s\"' --shadow float128 --quiet --out out");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(std::filesystem::exists(scratch / "out/summary.json"));
  int common = 0;
  ASSERT_EQ(std::sscanf(outcome.out.c_str(), "Shadow run: float128 and double, %d events in common",
                &common),
      1)
      << outcome.out;
  // 16 digits, of which each ball loses about 0.1 per collision.
  EXPECT_GT(common, 500);
  EXPECT_LT(common, 3000);
  EXPECT_NE(outcome.out.find("they diverge at event " + std::to_string(common)), std::string::npos)
      << outcome.out;
  EXPECT_NE(outcome.out.find("digits lost"), std::string::npos) << outcome.out;
}

TEST_F(CertifyTest, AShadowMustBeWider) {
  const auto outcome = edmill("run '" + reference("balls_28.toml").string() +
      "' --precision float128 --shadow double --out out");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find(
                "option '--shadow': found \"double\", expected a scalar wider than float128"),
      std::string::npos)
      << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(scratch / "out"));
}

}  // namespace
}  // namespace edmill
