// No false alarm: edmill's own logs, in several scalars and of several mills, are clean.
#include <gtest/gtest.h>

#include "edmill/audit/audit.hpp"
#include "program.hpp"
#include "spex_case.hpp"

namespace edmill::audit {
namespace {

struct OwnLog {
  std::string name, contact, balls, run;
  std::string precision = "double";
};

class OwnLogs : public ProgramTest, public ::testing::WithParamInterface<OwnLog> {};

TEST_P(OwnLogs, AreClean) {
  const auto& p = GetParam();
  const auto text = testing::spex_text(p.run, p.contact, p.balls);
  write("case.toml", text);
  const auto run = edmill("run case.toml --quiet --out out --precision " + p.precision +
                          " --set 'output=[{type=\"collisions\", states=true}]'");
  ASSERT_TRUE(run.code == 0 || run.code == 3) << run.err;  // 3: collapsed without t_c, the log is there
  const auto built = setup::build_case<double>(casefile::parse_case(text, "case.toml"));
  Options options;
  options.log = scratch / "out";
  options.from_start = true;
  const auto result = audit(built.the_case, built.states, options);
  EXPECT_EQ(result.verdict, Verdict::clean) << table(result);
  EXPECT_TRUE(result.not_made.empty() || p.balls.find("count = 1\n") != std::string::npos) << table(result);
  EXPECT_EQ(result.undecided, 0u);
  EXPECT_GT(result.events, 200u);
  std::cout << p.name << ": " << result.events << " impacts\n";
}

const std::string demo = "restitution = 0.53\ncollapse_time = \"0.1 ms\"";

INSTANTIATE_TEST_SUITE_P(
    Audit, OwnLogs,
    ::testing::Values(
        OwnLog{"demo", demo, testing::batch(28, "4.76 mm"), "max_collisions = 8000\nseed = 1"},
        OwnLog{"seed_2", demo, testing::batch(28, "4.76 mm"), "max_collisions = 8000\nseed = 2"},
        OwnLog{"seed_3", demo, testing::batch(28, "4.76 mm"), "max_collisions = 8000\nseed = 3"},
        OwnLog{"late_start", demo, testing::batch(28, "4.76 mm"),
               "max_collisions = 5000\ninitial_time = \"1000 s\"\nseed = 4"},
        OwnLog{"without_t_c", "restitution = 0.97\ncollapse_time = \"0 s\"", testing::batch(12, "4.76 mm"),
               "max_collisions = 2000\nseed = 5"},
        OwnLog{"short_t_c", "restitution = 0.53\ncollapse_time = \"1 us\"", testing::batch(28, "4.76 mm"),
               "max_collisions = 10000\nseed = 6"},
        OwnLog{"constant", "model = \"constant\"\nrestitution = 0.7\nrestitution_tangential = 0.4",
               testing::batch(10, "6 mm"), "max_collisions = 5000\nseed = 7"},
        OwnLog{"polydisperse", demo,
               testing::batch(20, "4.76 mm", "diameter_spread = \"1.5 mm\"\n") +
                   testing::batch(2, "9.52 mm", "density = \"15 g/cm3\"\nreduced_inertia = 0.6\n"),
               "max_collisions = 8000\nseed = 8"},
        OwnLog{"single", demo, testing::batch(1, "9.52 mm"), "max_collisions = 8000\nseed = 4"},
        OwnLog{"many", demo, testing::batch(227, "2.36 mm", "gap_ball = \"0.2 mm\"\n"),
               "max_collisions = 10000\nseed = 9"},
        OwnLog{"float128", demo, testing::batch(28, "4.76 mm"), "max_collisions = 5000\nseed = 1",
               "float128"},
        OwnLog{"mpfr50", demo, testing::batch(28, "4.76 mm"), "max_collisions = 1500\nseed = 1", "mpfr50"}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace edmill::audit
