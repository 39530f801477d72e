// No false alarm: edmill's own logs, in several scalars, of several mills and laws, are clean, and
// their energy closes.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "audit/audit.hpp"
#include "program.hpp"
#include "spex_case.hpp"

namespace edmill::audit {
namespace {

struct OwnLog {
  std::string name, contact, balls, run;
  std::string precision = "double";
};

const std::string demo = "restitution = 0.53";
const std::string constant =
    "model = \"constant\"\nrestitution = 0.7\nrestitution_tangential = 0.4";
const std::string none = "\nleast_separation = \"0 m/s\"",
                  high = "\nleast_separation = \"0.1 m/s\"";

class OwnLogs : public ProgramTest, public ::testing::WithParamInterface<OwnLog> {};

TEST_P(OwnLogs, AreClean) {
  const auto& p = GetParam();
  const auto text = testing::spex_text(p.run, p.contact, p.balls);
  write("case.toml", text);
  const auto run = edmill("run case.toml --quiet --out out --precision " + p.precision +
      " --set 'output=[{type=\"collisions\", states=true}]'");
  ASSERT_TRUE(run.code == 0 || run.code == 3)
      << run.err;  // 3: inelastic collapse, the log is there
  const auto built = casefile::build_case<double>(casefile::parse_case(text, "case.toml"));
  Options options;
  options.log = scratch / "out";
  options.from_start = true;
  const auto result = audit(built.the_case, built.states, options);
  EXPECT_EQ(result.verdict, Verdict::agree) << table(result);
  EXPECT_TRUE(result.not_made.empty() || p.balls.find("count = 1\n") != std::string::npos)
      << table(result);
  EXPECT_EQ(result.undecided, 0u);
  EXPECT_GT(result.events, 200u);
  // The run has added up its energies impact by impact, the audit derives them from the states.
  const auto summary = nlohmann::json::parse(contents(scratch / "out/summary.json"));
  const double dose = summary["milling_dose"];
  const auto& energies = result.energies;
  EXPECT_EQ(energies.impacts, result.events);
  EXPECT_NEAR(
      energies.supplied.value(), summary["least_separation"]["supplied_energy"], 1e-12 * dose);
  EXPECT_NEAR(energies.wall_work.value(), summary["wall_work"], 1e-12 * dose);
  EXPECT_NEAR(energies.closure(), 0, 1e-12 * dose);
  const bool exact = p.contact.ends_with(none);
  EXPECT_EQ(energies.supplied.value() > 0, !exact);
  EXPECT_EQ(energies.supplying > 0, !exact);
  EXPECT_EQ(energies.creating, 0u);
  std::cout << p.name << ": " << result.events << " impacts\n";
}

INSTANTIATE_TEST_SUITE_P(Audit, OwnLogs,
    ::testing::Values(
        OwnLog{"demo", demo, testing::batch(28, "4.76 mm"), "max_collisions = 8000\nseed = 1"},
        OwnLog{"seed_2", demo, testing::batch(28, "4.76 mm"), "max_collisions = 8000\nseed = 2"},
        OwnLog{"seed_3", demo, testing::batch(28, "4.76 mm"), "max_collisions = 8000\nseed = 3"},
        OwnLog{"late_start", demo, testing::batch(28, "4.76 mm"),
            "max_collisions = 5000\ninitial_time = \"1000 s\"\nseed = 4"},
        OwnLog{"no_least_separation", "restitution = 0.97" + none, testing::batch(12, "4.76 mm"),
            "max_collisions = 2000\nseed = 5"},
        OwnLog{"collapse", "restitution = 0.8" + none, testing::batch(28, "4.76 mm"),
            "max_collisions = 10000\nseed = 6"},
        OwnLog{"high_least_separation", demo + high, testing::batch(28, "4.76 mm"),
            "max_collisions = 8000\nseed = 6"},
        OwnLog{"constant", constant, testing::batch(10, "6 mm"), "max_collisions = 5000\nseed = 7"},
        OwnLog{"constant_no_least_separation", constant + none, testing::batch(10, "6 mm"),
            "max_collisions = 5000\nseed = 7"},
        OwnLog{"constant_high_least_separation", constant + high, testing::batch(10, "6 mm"),
            "max_collisions = 5000\nseed = 7"},
        OwnLog{"two_least_separations",
            demo +
                "\n[contact.ball_wall]\nleast_separation = \"5 cm/s\"\n[contact.ball_ball]\n"
                "least_separation = \"0.2 cm/s\"",
            testing::batch(28, "4.76 mm"), "max_collisions = 8000\nseed = 10"},
        OwnLog{"polydisperse", demo,
            testing::batch(20, "4.76 mm", "diameter_spread = \"1.5 mm\"\n") +
                testing::batch(2, "9.52 mm", "density = \"15 g/cm3\"\nreduced_inertia = 0.6\n"),
            "max_collisions = 8000\nseed = 8"},
        OwnLog{"single", demo, testing::batch(1, "9.52 mm"), "max_collisions = 8000\nseed = 4"},
        OwnLog{"many", demo, testing::batch(227, "2.36 mm", "gap_ball = \"0.2 mm\"\n"),
            "max_collisions = 10000\nseed = 9"},
        OwnLog{"float128", demo, testing::batch(28, "4.76 mm"), "max_collisions = 5000\nseed = 1",
            "float128"},
        OwnLog{"mpfr50", demo, testing::batch(28, "4.76 mm"), "max_collisions = 1500\nseed = 1",
            "mpfr50"}),
    [](const auto& info) { return info.param.name; });

/// Examples of other mills: regions of a rounded jar, a box, pistons, materials and laws by pairs.
class ExampleLogs : public ProgramTest, public ::testing::WithParamInterface<const char*> {};

TEST_P(ExampleLogs, AreClean) {
  const auto file = std::filesystem::path(EDMILL_SOURCE_DIR) / "docs/examples" /
      (std::string(GetParam()) + ".toml");
  const auto run =
      edmill("run " + file.string() + " --quiet --out out --set run.max_collisions=6000" +
          " --set 'output=[{type=\"collisions\", states=true}]'");
  ASSERT_EQ(run.code, 0) << run.err;
  const auto built = casefile::build_case<double>(casefile::read_case(file.string()));
  Options options;
  options.log = scratch / "out";
  options.from_start = true;
  const auto result = audit(built.the_case, built.states, options);
  EXPECT_EQ(result.verdict, Verdict::agree) << table(result);
  EXPECT_EQ(result.events, 6000u);
  const auto summary = nlohmann::json::parse(contents(scratch / "out/summary.json"));
  const double dose = summary["milling_dose"];
  EXPECT_NEAR(result.energies.wall_work.value(), summary["wall_work"], 1e-12 * dose);
  EXPECT_NEAR(result.energies.closure(), 0, 1e-12 * dose);
}
INSTANTIATE_TEST_SUITE_P(Audit, ExampleLogs,
    ::testing::Values("planetary", "shaken_box", "materials"),
    [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace edmill::audit
