// Filling a vessel: gaps are kept, the seed decides, and every scalar gets the same places.
#include "casefile/build_case.hpp"

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "spex_case.hpp"

namespace edmill::casefile {
namespace {

casefile::CaseSpec spec(const std::string& balls, const std::string& run = "end_time = \"1 s\"") {
  return casefile::parse_case(testing::spex_text(run, "restitution = 0.5", balls), "fill.toml");
}

TEST(BuildCase, PlacedBallsKeepTheirGaps) {
  const auto built = build_case<double>(
      spec(testing::batch(150, "3.16 mm", "gap_ball = \"0.3 mm\"\ngap_wall = \"0.7 mm\"\n")));
  const auto& mill = built.the_case.mill;
  const auto pose = mill.motion.pose({0, 0.0});
  ASSERT_EQ(built.states.size(), 150u);
  for (std::size_t i = 0; i < built.states.size(); ++i) {
    const auto& r = built.states[i].position;
    const auto p = mill.motion.to_vessel_frame(pose, r, r).position;
    EXPECT_LE(std::hypot(p[0], p[2]), 0.019 - 0.00158 - 0.0007 + 1e-12);
    EXPECT_LE(std::abs(p[1]), 0.0285 - 0.00158 - 0.0007 + 1e-12);
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GE((r - built.states[j].position).norm(), 0.00316 + 0.0003 - 1e-12);
  }
}

TEST(BuildCase, SeedDecidesThePlaces) {
  const auto one =
      build_case<double>(spec(testing::batch(20, "4 mm"), "end_time = \"1 s\"\nseed = 5"));
  const auto same =
      build_case<double>(spec(testing::batch(20, "4 mm"), "end_time = \"1 s\"\nseed = 5"));
  const auto other =
      build_case<double>(spec(testing::batch(20, "4 mm"), "end_time = \"1 s\"\nseed = 6"));
  EXPECT_EQ(one.states[19].position, same.states[19].position);
  EXPECT_NE(one.states[19].position, other.states[19].position);
}

TEST(BuildCase, EveryScalarGetsTheSamePlaces) {
  const auto s =
      spec(testing::batch(30, "4 mm", "diameter_spread = \"0.2 mm\"\nrandom_speed = \"2 m/s\"\n"));
  const auto narrow = build_case<double>(s);
  const auto wide = build_case<mpfr>(s);
  for (std::size_t k = 0; k < 30; ++k)
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(narrow.states[k].position[axis],
          static_cast<double>(wide.states[k].position[axis]), 1e-16);
      EXPECT_NEAR(narrow.states[k].velocity[axis],
          static_cast<double>(wide.states[k].velocity[axis]), 1e-14);
    }
}

TEST(BuildCase, MassesAreDensityTimesVolume) {
  const auto built = build_case<mpfr>(spec(testing::batch(1, "9.52 mm")));
  // Table 5.1 of the thesis: 3.614 g.
  const mpfr expected = mpfr(8000) * numerics::pi<mpfr>() / 6 * pow(mpfr("0.00952"), 3);
  EXPECT_LT(abs(built.the_case.balls[0].mass - expected), mpfr("1e-50"));
  EXPECT_NEAR(static_cast<double>(expected), 3.614e-3, 1e-6);
}

TEST(BuildCase, RandomSpeedsStayBelowTheLimitAndPointEverywhere) {
  const auto built =
      build_case<double>(spec(testing::batch(200, "2 mm", "random_speed = \"2 m/s\"\n")));
  Vec3<double> mean(0, 0, 0);
  double fastest = 0;
  for (const auto& s : built.states) {
    fastest = std::max(fastest, s.velocity.norm());
    mean += s.velocity / 200;
  }
  EXPECT_LE(fastest, 2);
  EXPECT_GT(fastest, 1.8);
  EXPECT_LT(mean.norm(), 0.3);  // three standard deviations of the mean of 200
}

TEST(BuildCase, FinalStateContinuesTheRunExactly) {
  // A run of 0.2 s, and one of 0.1 s continued from its final state: the same trajectory except for
  // the rounding of advancing every ball at 0.1 s, so the first events after it agree closely.
  const auto s = spec(testing::batch(5, "9.52 mm"), "end_time = \"0.1 s\"");
  const auto built = build_case<mpfr>(s);
  engine::Simulation<mpfr> whole(built.the_case, built.states, built.start);
  whole.run_until(whole.clock().at(mpfr("0.1")));
  std::vector<model::BallState<mpfr>> states;
  for (int k = 0; k < 5; ++k) states.push_back(whole.state_at(k, whole.now()));
  engine::Simulation<mpfr> rest(built.the_case, states, whole.now());
  whole.run_until(whole.clock().at(mpfr("0.11")));
  rest.run_until(rest.clock().at(mpfr("0.11")));
  for (int k = 0; k < 5; ++k)
    EXPECT_LT(norm<mpfr>(Vec3<mpfr>(
                  whole.state_at(k, whole.now()).position - rest.state_at(k, rest.now()).position)),
        mpfr("1e-30"));
}

template <class Real>
Instant<Real> start_at(const std::string& time, const std::string& speed = "1054 rpm") {
  const auto spec = casefile::parse_case(
      testing::spex_text("initial_time = \"" + time + "\"\nend_time = \"1e13 s\"",
          "restitution = 0.5", testing::batch(1, "4 mm")),
      "late.toml", {"mill.speed=" + speed});
  return build_case<Real>(spec).start;
}

/// At 1054 rpm a period lasts 60/1054 s, and 1054 10^k leaves 40 when divided by 60.
template <class Real> void expect_reduced_exactly() {
  const Real exact = Real(40) / 1054;
  std::int64_t tenths = 1054000 / 60;
  for (const char* time : {"1000 s", "1e4 s", "1e5 s", "1e6 s", "1e9 s", "1e12 s"}) {
    const auto start = start_at<Real>(time);
    EXPECT_EQ(start.offset, exact) << time;
    if (time == std::string("1e6 s")) {
      EXPECT_EQ(start.period, 17566666);
    }
    EXPECT_GE(start.period, tenths);
    tenths = start.period;
  }
}

TEST(Instants, ALateInstantIsReducedExactly) {
  expect_reduced_exactly<double>();
  expect_reduced_exactly<float128>();
  expect_reduced_exactly<mpfr>();
}

/// A speed in rad/s makes the period a multiple of pi: 1e6 s at 100 rad/s are 1e8 / (2 pi) periods.
TEST(Instants, ALateInstantOfAnIrrationalPeriodIsReducedToTheLastDigit) {
  using Exact = mpfr_of<200>;
  const Exact period = 2 * numerics::pi<Exact>() / 100,
              count = floor(Exact(Exact(1000000) / period));
  const Exact offset = 1000000 - count * period;
  EXPECT_EQ(start_at<double>("1e6 s", "100 rad/s").period, static_cast<std::int64_t>(count));
  EXPECT_EQ(start_at<double>("1e6 s", "100 rad/s").offset, static_cast<double>(offset));
  EXPECT_EQ(start_at<float128>("1e6 s", "100 rad/s").offset, static_cast<float128>(offset));
}

TEST(Instants, ATimeOfWholePeriodsHasNoOffset) {
  const auto start = start_at<double>("30 s");
  EXPECT_EQ(start.period, 527);
  EXPECT_EQ(start.offset, 0);
}

/// A chain of a turn and a swing, each with a constant part [deg or rad].
std::string turned(const std::string& angle, const std::string& phase) {
  return "[mill]\ntype = \"chain\"\n[[mill.joint]]\nrotate = \"y\"\nangle = \"" + angle +
      "\"\nspeed = \"300 rpm\"\n[[mill.joint]]\nrotate = \"x\"\nangle = \"" + angle +
      "\"\n[[mill.joint]]\ntranslate = \"x\"\nswing = [{amplitude = \"3 mm\", speed = \"700 rpm\", "
      "phase "
      "= \"" +
      phase +
      "\"}]\n[vessel]\ntype = \"box\"\nsize = [\"40 mm\", \"40 mm\", \"40 mm\"]\n"
      "[run]\nend_time = \"1 s\"\n[contact]\nrestitution = 0.5\nfriction = 0.4\n[[balls]]\ncount = "
      "1\n"
      "diameter = \"4 mm\"\n";
}
template <class Real> void expect_same_poses(const std::string& one, const std::string& other) {
  const auto pose = [](const std::string& text, const Instant<Real>& when) {
    const auto mill = build_mill<Real>(parse_case(text, "turned.toml"));
    const auto pose_then = mill.motion.pose(when);
    return *std::get_if<model::ChainPose<Real>>(&pose_then);
  };
  for (const int eighth : {0, 3, 7}) {
    const Instant<Real> when{eighth, Real(eighth) / 100};
    const auto a = pose(one, when), b = pose(other, when);
    EXPECT_EQ(a.x, b.x) << one;
    EXPECT_EQ(a.y, b.y) << one;
    EXPECT_EQ(a.centre, b.centre) << one;
    EXPECT_EQ(a.velocity, b.velocity) << one;
  }
}

/// 1e9 turns and more, of either sign.
TEST(BuildCase, WholeTurnsOfConstantAnglesAndPhasesAreDroppedExactly) {
  const auto same = [](const std::string& angle, const std::string& phase, const std::string& less,
                        const std::string& less_phase) {
    expect_same_poses<double>(turned(angle, phase), turned(less, less_phase));
    expect_same_poses<float128>(turned(angle, phase), turned(less, less_phase));
    const mpfr::Digits digits(200);
    expect_same_poses<mpfr>(turned(angle, phase), turned(less, less_phase));
  };
  same("240278471 deg", "720000000324 deg", "71 deg", "324 deg");
  same("360000000000030.5 deg", "-719 deg", "30.5 deg", "1 deg");
  same("-240278471 deg", "1080 deg", "289 deg", "0 deg");
}

/// 1e9 rad are no rational part of a turn: 1e9 - 159154943 * 2 pi rad.
TEST(BuildCase, WholeTurnsOfRadiansAreDroppedToTheLastDigit) {
  const auto mill = build_mill<double>(parse_case(turned("1e9 rad", "0 deg"), "turned.toml"));
  const mpfr::Digits digits(200);
  const mpfr turns = mpfr(1000000000) / (2 * numerics::pi<mpfr>());
  const auto* chain = mill.motion.get_if<model::ChainMotion<double>>();
  ASSERT_TRUE(chain);
  EXPECT_EQ(chain->joints().list[1].angle, static_cast<double>(turns - floor(turns)));
}

}  // namespace
}  // namespace edmill::casefile
