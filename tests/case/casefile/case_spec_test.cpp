// A valid case: what is read, what is assumed, what the command line changes, and the digest.
#include "casefile/case_spec.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/errors.hpp"
#include "casefile/rational.hpp"
#include "core.hpp"

namespace edmill {
namespace {

using boost::multiprecision::cpp_rational;
using casefile::CaseSpec;
using casefile::parse_case;
using casefile::Quantity;
using WaltonBraun = model::WaltonBraun<Quantity>;

/// A parameter of the law, by its key.
cpp_rational parameter(const casefile::ContactSpec& c, const std::string& key) {
  cpp_rational found = -2;
  c.parameters([&](const model::Parameter& p, const Quantity& q) {
    if (p.key == key) found = rational(q);
  });
  return found;
}
cpp_rational restitution(const casefile::ContactSpec& c) { return parameter(c, "restitution"); }
cpp_rational friction(const casefile::ContactSpec& c) { return parameter(c, "friction"); }

using Overrides = std::vector<std::string>;

const std::string least = R"([run]
end_time = "10 s"
[vessel]
diameter = "38 mm"
height = "57 mm"
[contact]
restitution = 0.53
friction = 0.4
[[balls]]
diameter = "4.76 mm"
)";

const std::string full = R"(
[run]
initial_time = "0.25 s"
start_time = "0.5 s"
end_time = "10 s"
max_collisions = 1_000_000
max_milling_dose = "2.5 J"
max_ball_speed = "40 m/s"
seed = 7
precision = "float128"
gravity = [0, "-980 cm/s2", 0.125]

[mill]
type = "spex8000"
speed = "1054 rpm"
arm = "9.5 cm"
theta_max = "0.25 rad"
gamma_max = "10 deg"

[vessel]
type = "cylinder"
diameter = "38 mm"
height = "57 mm"

[powder]
mass = "5 g"

[contact]
model = "walton-braun"
restitution = 0.53
friction = 0.4
min_tangential = -0.5
least_separation = "2 mm/s"

[contact.ball_wall]
restitution_normal = 0.75

[contact.ball_ball]
model = "constant"
restitution_tangential = 0.25

[[ball]]
diameter = "6 mm"
density = "15 g/cm3"
reduced_inertia = 0.5
position = ["10 cm", "1 mm", 0.002]
velocity = [0, -1.5, "3 ft/s"]
spin = ["60 rpm", 0, "-1 rad/s"]

[[balls]]
count = 28
diameter = "4.76 mm"
diameter_spread = "0.1 mm"
random_speed = "1 m/s"
gap_ball = "0.5 mm"
gap_wall = "0.25 mm"
max_relocations = 500

[[balls]]
diameter = "3 mm"
velocity = [1, 0, 0]

[[output]]
type = "collisions"
file = "first.csv"
start_time = "1 s"
end_time = "2 s"
)";

cpp_rational ratio(long long a, long long b = 1) { return cpp_rational(a, b); }

CaseSpec read(const std::string& text, const Overrides& overrides = {}) {
  return parse_case(text, "case.toml", overrides);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(CaseSpec, EveryValueOfAFullCaseIsReadExactly) {
  const CaseSpec c = read(full);
  EXPECT_EQ(c.file, "case.toml");
  EXPECT_EQ(c.precision, "float128");
  EXPECT_EQ(c.seed, 7u);
  EXPECT_EQ(rational(c.initial_time), ratio(1, 4));
  EXPECT_EQ(rational(c.statistics_start), ratio(1, 2));
  EXPECT_EQ(rational(*c.end_time), 10);
  EXPECT_EQ(rational(*c.stop_limits[model::place_of_rule<model::MaxCollisions>]), 1000000);
  EXPECT_EQ(rational(*c.stop_limits[model::place_of_rule<model::MaxMillingDose>]), ratio(5, 2));
  EXPECT_EQ(rational(*c.stop_limits[model::place_of_rule<model::MaxBallSpeed>]), 40);
  EXPECT_EQ(rational(c.gravity[0]), 0);
  EXPECT_EQ(rational(c.gravity[1]), ratio(-98, 10));
  EXPECT_EQ(rational(c.gravity[2]), ratio(1, 8));
  const auto& mill = std::get<model::Spex8000<Quantity>>(c.mill);
  EXPECT_EQ(rational(mill.period), ratio(60, 1054));
  EXPECT_EQ(mill.period.pi_power, 0);
  EXPECT_EQ(rational(mill.arm), ratio(95, 1000));
  EXPECT_EQ(mill.theta_max.text(), "1/4");
  EXPECT_EQ(mill.gamma_max.text(), "1/18*pi");
  const auto& vessel = std::get<model::Cylinder<Quantity>>(c.vessel);
  EXPECT_EQ(rational(vessel.diameter), ratio(38, 1000));
  EXPECT_EQ(rational(vessel.height), ratio(57, 1000));
  EXPECT_EQ(rational(*c.powder_mass), ratio(5, 1000));
  ASSERT_EQ(c.balls.size(), 1u);
  const auto& ball = c.balls[0];
  EXPECT_EQ(rational(ball.diameter), ratio(6, 1000));
  EXPECT_EQ(rational(ball.density), 15000);
  EXPECT_EQ(rational(ball.reduced_inertia), ratio(1, 2));
  EXPECT_EQ(rational(ball.position[0]), ratio(1, 10));
  EXPECT_EQ(rational(ball.position[1]), ratio(1, 1000));
  EXPECT_EQ(rational(ball.position[2]), ratio(2, 1000));
  EXPECT_EQ(rational(ball.velocity[1]), ratio(-3, 2));
  EXPECT_EQ(rational(ball.velocity[2]), ratio(9144, 10000));
  EXPECT_EQ(ball.spin[0].text(), "2*pi");
  EXPECT_EQ(rational(ball.spin[2]), -1);
  ASSERT_EQ(c.batches.size(), 2u);
  const auto& batch = c.batches[0];
  EXPECT_EQ(batch.count, 28);
  EXPECT_EQ(rational(batch.diameter), ratio(476, 100000));
  EXPECT_EQ(rational(batch.diameter_spread), ratio(1, 10000));
  EXPECT_EQ(rational(*batch.random_speed), 1);
  EXPECT_EQ(rational(batch.gap_ball), ratio(1, 2000));
  EXPECT_EQ(rational(batch.gap_wall), ratio(1, 4000));
  EXPECT_EQ(batch.max_relocations, 500u);
  EXPECT_EQ(rational(c.batches[1].velocity[0]), 1);
  EXPECT_EQ(c.ball_count(), 30u);
  ASSERT_EQ(c.outputs.size(), 1u);
  EXPECT_EQ(c.outputs[0].type, "collisions");
  EXPECT_EQ(c.outputs[0].file, "first.csv");
  EXPECT_EQ(rational(*c.outputs[0].timer.start_time), 1);
  EXPECT_EQ(rational(*c.outputs[0].timer.end_time), 2);
}

TEST(CaseSpec, DefaultsAreThoseOfTheThesis) {
  const CaseSpec c = read(least);
  const auto& mill = std::get<model::Spex8000<Quantity>>(c.mill);
  EXPECT_EQ(mill.arm.text(), "1/10");
  EXPECT_EQ(mill.theta_max.text(), "1/12*pi");
  EXPECT_EQ(mill.gamma_max.text(), "1/12*pi");
  EXPECT_EQ(rational(mill.period), ratio(60, 1098));
  EXPECT_EQ(rational(c.batches[0].density), 8000);
  EXPECT_EQ(rational(c.batches[0].reduced_inertia), ratio(2, 5));
  EXPECT_EQ(rational(c.batches[0].gap_ball), ratio(1, 1000));
  EXPECT_EQ(rational(c.batches[0].gap_wall), ratio(1, 1000));
  EXPECT_EQ(c.batches[0].count, 1);
  EXPECT_FALSE(c.batches[0].random_speed);
  for (const auto* law : {&c.ball_ball, &c.ball_wall}) {
    EXPECT_EQ(rational(std::get<WaltonBraun>(law->law).min_tangential), -1);
    EXPECT_EQ(rational(law->least_separation), ratio(1, 100));
  }
  EXPECT_EQ(c.precision, "double");
  EXPECT_EQ(c.seed, 1u);
  EXPECT_EQ(rational(c.initial_time), 0);
  EXPECT_EQ(rational(c.statistics_start), 0);
  for (const auto& limit : c.stop_limits) EXPECT_FALSE(limit);
  EXPECT_FALSE(c.powder_mass);
  for (const auto& g : c.gravity) EXPECT_TRUE(g.zero());
}

TEST(CaseSpec, AContactPairOverridesOnlyItsOwnKeys) {
  const CaseSpec c = read(full);
  const auto& balls = std::get<model::ConstantRestitution<Quantity>>(c.ball_ball.law);
  EXPECT_EQ(rational(balls.normal), ratio(53, 100));
  EXPECT_EQ(rational(balls.tangential), ratio(1, 4));
  const auto& walls = std::get<WaltonBraun>(c.ball_wall.law);
  EXPECT_EQ(rational(walls.normal), ratio(3, 4));
  EXPECT_EQ(rational(walls.friction), ratio(2, 5));
  EXPECT_EQ(rational(walls.min_tangential), ratio(-1, 2));
  for (const auto* law : {&c.ball_ball, &c.ball_wall})
    EXPECT_EQ(rational(law->least_separation), ratio(2, 1000));
}

TEST(CaseSpec, TwoPairsTogetherReplaceTheCommonKeys) {
  const CaseSpec c = read(replaced(least, "restitution = 0.53\nfriction = 0.4\n",
      "[contact.ball_ball]\nrestitution = 0.9\nfriction = 0.1\n"
      "[contact.ball_wall]\nrestitution = 0.8\nfriction = 0.2\n"));
  EXPECT_EQ(restitution(c.ball_ball), ratio(9, 10));
  EXPECT_EQ(friction(c.ball_wall), ratio(1, 5));
}

TEST(CaseSpec, GravityAsOneNumberPointsAlongMinusY) {
  const CaseSpec c = read(least, {"run.gravity=9.8 m/s2"});
  EXPECT_TRUE(c.gravity[0].zero());
  EXPECT_EQ(rational(c.gravity[1]), ratio(-98, 10));
  EXPECT_TRUE(c.gravity[2].zero());
}

TEST(CaseSpec, DecimalsOfTheFileStayExactInEveryLayout) {
  for (const auto* line : {"restitution = 0.53", "restitution=0.53", "restitution\t=\t0.53\t# 0.99",
           "restitution = +5_3.0e-2", "restitution = 0.53\r", "\"restitution\" = 0.53 ",
           "restitution = 0.53#µ", "restitution = \"0.53\"", "restitution = 53e-2"})
    EXPECT_EQ(
        restitution(read(replaced(least, "restitution = 0.53", line)).ball_ball), ratio(53, 100))
        << line;
  const std::string inline_table =
      replaced(least, "[contact]\nrestitution = 0.53\nfriction = 0.4\n", "");
  EXPECT_EQ(
      restitution(
          read("contact = { 'friction' = 0.4, \"restitution\" = 0.53}\n" + inline_table).ball_ball),
      ratio(53, 100));
  EXPECT_EQ(restitution(read("\xEF\xBB\xBF"
                             "contact.restitution = 0.53\ncontact.friction = 0.4\n" +
                inline_table)
                            .ball_ball),
      ratio(53, 100))
      << "after a byte order mark";
}

TEST(CaseSpec, NumbersOfAnArrayStayExactInEveryLayout) {
  for (const auto* line : {"velocity = [0.1,-0.2,0.3]", "velocity = [ 0.1 , -0.2 , 0.3 ]",
           "velocity = [\n  0.1, # one\n  -0.2,\n  0.3,\n]"}) {
    const CaseSpec c = read(least + line + "\n");
    EXPECT_EQ(rational(c.batches[0].velocity[0]), ratio(1, 10)) << line;
    EXPECT_EQ(rational(c.batches[0].velocity[1]), ratio(-2, 10)) << line;
    EXPECT_EQ(rational(c.batches[0].velocity[2]), ratio(3, 10)) << line;
  }
}

TEST(CaseSpec, TheCommandLineOverridesTheFile) {
  const CaseSpec c = read(full,
      {"run.end_time=0.75 s", "balls.0.count=5", "balls.01.diameter=\"2 mm\"",
          "ball.0.density=7 g/cm3", "contact.restitution=0.1", "mill.speed=1000 rpm",
          "output.0.file=other.csv", "contact.ball_wall.friction=0.3"});
  EXPECT_EQ(rational(*c.end_time), ratio(3, 4));
  EXPECT_EQ(c.batches[0].count, 5);
  EXPECT_EQ(rational(c.batches[1].diameter), ratio(2, 1000));
  EXPECT_EQ(rational(c.balls[0].density), 7000);
  EXPECT_EQ(restitution(c.ball_ball), ratio(1, 10));
  EXPECT_EQ(rational(period_of(c.mill)), ratio(60, 1000));
  EXPECT_EQ(c.outputs[0].file, "other.csv");
  EXPECT_EQ(friction(c.ball_wall), ratio(3, 10));
}

TEST(CaseSpec, NumbersOfTheCommandLineStayExact) {
  // The first line of the file must not be shown as the text of the setting.
  const std::string text = "#       [1, 2, 3, 4, 5, 6, 7, 8, 9]\n" + least;
  const CaseSpec c = read(text,
      {"run.gravity=[0.1, -9.81, 1e-3]", "balls.00.reduced_inertia=0.35",
          "contact.ball_ball={restitution=0.7, friction=0.3}",
          "contact.ball_wall.restitution=0.6 # a comment"});
  EXPECT_EQ(rational(c.gravity[0]), ratio(1, 10));
  EXPECT_EQ(rational(c.gravity[1]), ratio(-981, 100));
  EXPECT_EQ(rational(c.gravity[2]), ratio(1, 1000));
  EXPECT_EQ(rational(c.batches[0].reduced_inertia), ratio(35, 100));
  EXPECT_EQ(restitution(c.ball_ball), ratio(7, 10));
  EXPECT_EQ(friction(c.ball_ball), ratio(3, 10));
  EXPECT_EQ(restitution(c.ball_wall), ratio(6, 10));
}

TEST(CaseSpec, TheLastOfTwoSettingsCounts) {
  EXPECT_EQ(friction(read(least, {"contact.friction=0.1", "contact.friction=0.2"}).ball_ball),
      ratio(2, 10));
  EXPECT_EQ(
      friction(read(least, {"contact.friction=0.1", "contact={friction=0.25, restitution=0.5}"})
                   .ball_ball),
      ratio(25, 100));
  EXPECT_EQ(
      friction(read(least, {"contact={friction=0.25, restitution=0.5}", "contact.friction=0.1"})
                   .ball_ball),
      ratio(1, 10));
}

TEST(CaseSpec, ASettingCanAddASection) {
  EXPECT_EQ(rational(*read(least, {"powder.mass=5 g"}).powder_mass), ratio(5, 1000));
}

TEST(CaseSpec, TheDigestIgnoresHowAValueIsWritten) {
  const std::string digest = read(least).digest;
  EXPECT_EQ(digest.size(), 64u);
  EXPECT_EQ(read(replaced(least, "38 mm", "3.8 cm")).digest, digest);
  EXPECT_EQ(read("# a comment\n\n" + least + "# another\n").digest, digest);
  EXPECT_EQ(read(replaced(least, "0.53", "5.3e-1")).digest, digest);
  EXPECT_EQ(read(least + "density = \"8 g/cm3\"\ncount = 1\n").digest, digest);
  EXPECT_EQ(read(least, {"mill.speed=18.3 Hz", "run.seed=1"}).digest, digest);
  EXPECT_EQ(parse_case(least, "elsewhere.toml").digest, digest);
}

TEST(CaseSpec, TheDigestChangesWithEveryValue) {
  const Overrides changes = {"run.seed=2", "run.precision=mpfr50", "run.initial_time=1 us",
      "run.start_time=1 us", "run.end_time=9.999999999999999999999 s", "run.max_collisions=10",
      "run.max_milling_dose=1 J", "run.max_ball_speed=10 m/s", "run.gravity=9.8 m/s2",
      "mill.type=still", "mill.arm=9 cm", "mill.theta_max=14 deg", "mill.gamma_max=14 deg",
      "mill.speed=1097 rpm", "vessel.diameter=39 mm", "vessel.height=58 mm",
      "contact.model=constant", "contact.restitution=0.5300000000000000000001",
      "contact.friction=0.41", "contact.min_tangential=0", "contact.least_separation=0 m/s",
      "contact.ball_wall.friction=0.5", "balls.0.diameter=4.75 mm", "balls.0.density=7 g/cm3",
      "balls.0.reduced_inertia=0.5", "balls.0.count=2", "balls.0.diameter_spread=0.1 mm",
      "balls.0.random_speed=1 m/s", "balls.0.velocity=[0, 0, 1]", "balls.0.gap_ball=2 mm",
      "balls.0.gap_wall=2 mm", "balls.0.max_relocations=7"};
  std::map<std::string, std::string> seen{{read(least).digest, "the case itself"}};
  for (const auto& change : changes) {
    Overrides overrides{change};
    if (change == "contact.model=constant") overrides.push_back("contact.restitution_tangential=1");
    const auto [at, is_new] = seen.emplace(read(least, overrides).digest, change);
    EXPECT_TRUE(is_new) << change << " and " << at->second;
  }
}

TEST(CaseSpec, EveryProblemIsReportedOnce) {
  try {
    read(replaced(replaced(full, "friction = 0.4", "friction = -1"), "position = [\"10 cm\"",
             "position = [\"10 kg\""),
        {"run.seed=-1"});
    FAIL();
  } catch (const InputError& error) {
    ASSERT_EQ(error.problems().size(), 3u) << error.what();
    EXPECT_EQ(error.problems()[0],
        "--set run.seed=-1: key 'run.seed': found \"-1\", expected an integer, 0 or more");
    EXPECT_EQ(error.problems()[1],
        "case.toml:31: key 'contact.friction': found \"-1\", expected a number from 0 to 1000000");
    EXPECT_EQ(error.problems()[2],
        "case.toml:46: key 'ball.0.position.0': found \"10 kg\" (a mass), expected a length (m, "
        "dm, cm, "
        "mm, um, in, ft)");
  }
}

TEST(CaseSpec, GapsAreKeptBetweenBatchesOfOtherSizesAndGaps) {
  // Large balls without gaps first, then small ones with a wide gap.
  const std::string text = replaced(least, "[[balls]]\ndiameter = \"4.76 mm\"\n",
      "[[balls]]\ncount = 3\ndiameter = \"10 mm\"\ngap_ball = \"0 mm\"\n"
      "[[balls]]\ncount = 3\ndiameter = \"2 mm\"\ngap_ball = \"8 mm\"\n");
  int placed = 0;
  for (int seed = 1; seed <= 400; ++seed) {
    const CaseSpec spec = read(
        text, {"run.seed=" + std::to_string(seed), "vessel.diameter=80 mm", "vessel.height=80 mm"});
    const auto built = casefile::build_case<double>(spec);
    for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t b = std::max<std::size_t>(a + 1, 3); b < 6; ++b, ++placed) {
        const Vec3<double> between = built.states[a].position - built.states[b].position;
        const double gap =
            norm<double>(between) - built.the_case.balls[a].radius - built.the_case.balls[b].radius;
        ASSERT_GT(gap, 0.008 - 1e-12) << "seed " << seed << ", balls " << a << " and " << b;
      }
  }
  EXPECT_EQ(placed, 400 * 12);
}

}  // namespace
}  // namespace edmill
