// Proofs against closed forms, and what cannot be proven.
#include <gtest/gtest.h>

#include <atomic>
#include <boost/multiprecision/mpfr.hpp>
#include <map>
#include <vector>

#include "casefile/case_spec.hpp"
#include "program.hpp"
#include "prove/proof.hpp"

namespace edmill {
namespace {

using Number = boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<60>>;
using Row = std::map<std::string, std::string>;

class ProveTest : public ProgramTest {
 protected:
  static std::string suite(const std::string& name) {
    return std::string(EDMILL_SOURCE_DIR) + "/regression/reference/suite/" + name;
  }
  static std::vector<Row> rows(const std::string& file) {
    std::istringstream text(contents(file));
    std::vector<std::string> header;
    std::vector<Row> all;
    for (std::string line; std::getline(text, line);) {
      if (line.rfind('#', 0) == 0) continue;
      std::vector<std::string> cells;
      std::istringstream parts(line);
      for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
      if (header.empty()) {
        header = cells;
        continue;
      }
      for (std::size_t k = 0; k < cells.size(); ++k)
        all.resize(all.size() + (k == 0)), all.back()[header[k]] = cells[k];
    }
    return all;
  }
  /// A case of the suite, whose events are known in 40 digits from elsewhere.
  void holds_the_closed_form(const std::string& name) {
    const auto exact = rows(suite(name) + "/events.csv");
    ASSERT_GE(exact.size(), 8u);
    const auto made = edmill("prove '" + suite(name) + "/case.toml' --collisions " +
        std::to_string(exact.size()) + " --out events.csv");
    ASSERT_EQ(made.code, 0) << made.err;
    const auto proven = rows((scratch / "events.csv").string());
    ASSERT_EQ(proven.size(), exact.size());
    for (std::size_t k = 0; k < exact.size(); ++k) {
      for (const std::string body : {"ball", "partner_kind", "partner"})
        EXPECT_EQ(proven[k].at(body), exact[k].at(body)) << name << ", event " << k;
      for (const std::string value : {"time", "approach_speed", "slip_speed"}) {
        const Number off = abs(Number(proven[k].at(value)) - Number(exact[k].at(value)));
        // The closed forms are rounded to 40 digits.
        EXPECT_LE(off, Number(proven[k].at(value + "_radius")) + Number("1e-38"))
            << name << ", event " << k << " " << value;
        // The slip speed of a central impact is the root of a square that is zero within its
        // radius.
        EXPECT_LT(Number(proven[k].at(value + "_radius")), Number("1e-20"));
      }
    }
  }
  static std::string box_case(const std::string& more) {
    return "[run]\nend_time = \"1 s\"\n[mill]\ntype = \"still\"\n[vessel]\ntype = \"box\"\n"
           "size = [\"1 m\", \"1 m\", \"1 m\"]\n[contact]\nmodel = \"constant\"\nrestitution = 1\n"
           "restitution_tangential = 1\nleast_separation = \"0 m/s\"\n" +
        more;
  }
};

TEST_F(ProveTest, BouncingBall) { holds_the_closed_form("bouncing_ball"); }
TEST_F(ProveTest, NewtonsCradle) { holds_the_closed_form("newtons_cradle"); }
TEST_F(ProveTest, ObliqueImpacts) { holds_the_closed_form("oblique_impact"); }

TEST_F(ProveTest, SimultaneousContactsOfABallAreSaid) {
  // The ball between two others is struck from both sides at once.
  write("case.toml",
      box_case("[[ball]]\ndiameter = \"0.1 m\"\nposition = [\"0 m\", \"0 m\", \"0 m\"]\n"
               "[[ball]]\ndiameter = \"0.1 m\"\nposition = [\"-0.3 m\", \"0 m\", \"0 m\"]\n"
               "velocity = [\"1 m/s\", \"0 m/s\", \"0 m/s\"]\n"
               "[[ball]]\ndiameter = \"0.1 m\"\nposition = [\"0.3 m\", \"0 m\", \"0 m\"]\n"
               "velocity = [\"-1 m/s\", \"0 m/s\", \"0 m/s\"]\n"));
  const auto outcome =
      edmill("prove case.toml --collisions 3 --certificate certificate --out events.csv");
  EXPECT_EQ(outcome.code, 4);
  EXPECT_NE(outcome.err.find("has another contact of its ball at the same time"), std::string::npos)
      << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(scratch / "certificate"));
  EXPECT_FALSE(std::filesystem::exists(scratch / "events.csv"));
}

TEST_F(ProveTest, TwoContactsAtOnceOfDifferentBallsAreNotOrdered) {
  write("case.toml",
      box_case("[[ball]]\ndiameter = \"0.1 m\"\nposition = [\"0 m\", \"0 m\", \"0 m\"]\n"
               "velocity = [\"1 m/s\", \"0 m/s\", \"0 m/s\"]\n"
               "[[ball]]\ndiameter = \"0.1 m\"\nposition = [\"0 m\", \"0.3 m\", \"0 m\"]\n"
               "velocity = [\"1 m/s\", \"0 m/s\", \"0 m/s\"]\n"));
  const auto outcome = edmill("prove case.toml --collisions 2 --most-bits 512");
  EXPECT_EQ(outcome.code, 4);
  EXPECT_NE(outcome.err.find("512 bits do not decide"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("may be simultaneous"), std::string::npos) << outcome.err;
}

/// Also where it looks for the events, which takes minutes here.
TEST_F(ProveTest, EndsWhenItIsInterrupted) {
  std::atomic<bool> interrupt{true};
  const auto proof = prove::prove(casefile::read_case(EDMILL_SOURCE_DIR "/docs/examples/demo.toml"),
      {100000, 16384, &interrupt, {}});
  EXPECT_TRUE(proof.interrupted);
  EXPECT_TRUE(proof.events.empty());
}

TEST_F(ProveTest, WhatHasNoExactNumbersIsRefused) {
  const auto refused = [&](const std::string& settings, const std::string& expected) {
    const auto outcome = edmill("prove '" EDMILL_SOURCE_DIR
                                "/regression/reference/three_balls.toml' --collisions 3 " +
        settings);
    EXPECT_EQ(outcome.code, 2) << settings;
    EXPECT_NE(outcome.err.find(expected), std::string::npos) << outcome.err;
  };
  refused("--set vessel.type=capsule --set 'vessel.height=\"60 mm\"'",
      "walls that are planes, a cylinder or a sphere");
  refused("--set 'balls.0.random_speed=\"1 m/s\"'", "`prove` needs exact ones");
  refused("--set 'balls.0.diameter_spread=\"1 mm\"'", "`prove` needs exact ones");
  refused(
      "--set contact.model=viscoelastic --set 'contact.effective_modulus=\"1 GPa\"' --set "
      "'contact.dissipative_time=\"1 us\"'",
      "`prove` supports no others");
}

}  // namespace
}  // namespace edmill
