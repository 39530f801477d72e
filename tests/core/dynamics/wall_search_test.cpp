// The certified ball-wall search: plain situations with a closed form, and which scalar decides
// which case.
#include "dynamics/wall_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "mill_parts.hpp"
#include "spex_case.hpp"
#include "wall_states.hpp"

namespace edmill::dynamics {
namespace {

// A still vessel whose numbers are exact in every scalar. Its y axis points along -X, x along Y, z
// along Z.
constexpr double ball_radius = 1.0 / 256;

template <class Real>
model::Mill<Real> still_mill(
    const Vec3<double>& gravity, double across = 1.0 / 32, double along = 1.0 / 64) {
  model::Mill<Real> mill{};
  mill.motion = model::SpexMotion<Real>(Real(0), Real(0), Real(0), Real(1));
  mill.vessel = model::CylinderVessel<Real>{Real(across + ball_radius), Real(along + ball_radius)};
  mill.gravity = vector_cast<Real>(gravity);
  return mill;
}

/// A query from the start of the flight on.
WallQuery<double> query_of(
    const Vec3<double>& position, const Vec3<double>& velocity, double length) {
  return {{position, velocity, {0, 0.0}}, ball_radius, {0, 0.0}, length};
}

WallAnswer<double> ask(const Vec3<double>& gravity, const WallQuery<double>& query) {
  DecisionLadder<double> ladder(still_mill<double>(gravity), 2 * ball_radius, 10.0);
  return over_window([&](const WallQuery<double>& q) { return ladder.wall(q); }, query, 1.0);
}

/// Thrown towards cap 0 against gravity, so that the highest point at 1/16 s misses it by
/// `distance`, exactly.
const Vec3<double> grazing_gravity{-8, 0, 0};
WallQuery<double> grazing_query(double distance) {
  auto query = query_of({-distance, 0, 0}, {0.5, 0, 0}, 1.0 / 16);
  query.begin.offset = 1.0 / 32;
  return query;
}

/// The same throw towards the round wall, whose gap no polynomial of second degree describes.
template <class Real> model::Mill<Real> round_grazing_mill() {
  return still_mill<Real>({0, 0, -8}, 1.0 / 64, 1.0 / 32);
}
WallQuery<double> round_grazing_query(double distance) {
  auto query = query_of({0, 0, -distance}, {0, 0, 0.5}, 1.0 / 16);
  query.begin.offset = 1.0 / 32;
  return query;
}

template <class Real> class WideWallSearch : public ::testing::Test {};
using WideScalars = ::testing::Types<float128, mpfr>;
TYPED_TEST_SUITE(WideWallSearch, WideScalars);

TYPED_TEST(WideWallSearch, GrazingAndTouchingStatesAreLeftToTheWideSearch) {
  using Real = TypeParam;
  const auto graze = testing::general_search(still_mill<Real>(grazing_gravity));
  for (const double d : {0x1p-57, -0x1p-57, 0x1p-120, -0x1p-120}) {
    const auto query = widened<Real>(grazing_query(d));
    EXPECT_EQ(graze.search_by_double(query).verdict, Verdict::undecided);
    EXPECT_EQ(graze(query).verdict, graze.search(query).verdict);
  }
  EXPECT_EQ(graze.search_by_double(widened<Real>(grazing_query(0x1p-30))).verdict, Verdict::none);
  EXPECT_EQ(
      graze.search_by_double(widened<Real>(grazing_query(-0x1p-30))).verdict, Verdict::contact);

  // On a cap and approaching, overlapped or not, and two walls at one time.
  const auto still = testing::general_search(still_mill<Real>({0, 0, 0}));
  for (const double overlap : {0.0, 0x1p-58, -0x1p-58}) {
    const auto query = widened<Real>(query_of({1.0 / 64 + overlap, 0, 0}, {1e-3, 0, 0}, 0.1));
    EXPECT_EQ(still.search_by_double(query).verdict, Verdict::undecided);
    const auto hit = still(query);
    EXPECT_EQ(hit.verdict, Verdict::contact);
    EXPECT_EQ(hit.wall, 0);
    EXPECT_NEAR(static_cast<double>(hit.time.offset), overlap < 0 ? -overlap / 1e-3 : 0.0, 1e-25);
  }
  const auto corner = widened<Real>(query_of({0, 0, 1.0 / 64}, {0.5, 0, 0.5}, 0.0625));
  EXPECT_EQ(still.search_by_double(corner).verdict, Verdict::undecided);
}

template <class Real> Verdict grazing_verdict(double distance) {
  const auto search = testing::general_search(round_grazing_mill<Real>());
  const auto decide = [&](const WallQuery<Real>& query) { return search(query); };
  return over_window(decide, widened<Real>(round_grazing_query(distance)), Real(1)).verdict;
}

/// Windows as long as the test without rates allows, for balls from rest to 6 m/s.
TEST(WallSearch, WhatIsOutOfReachIsNotHit) {
  constexpr std::uint64_t seed = 20110101;
  std::cout << "seed " << seed << "\n";
  const auto mill = testing::spex_mill<double>();
  DecisionLadder<double> ladder(mill, 0.00236, 12.0);
  const auto walls = testing::general_search(mill);
  Draw draw(seed);
  int proven = 0, soon_after = 0;
  for (int k = 0; k < 5000; ++k) {
    WallQuery<double> q{};
    q.radius = draw.uniform(0.00118, 0.00635);
    q.begin = {3, draw.uniform(0, mill.motion.period())};
    const double across = testing::cylinder(mill).radius - q.radius,
                 along = testing::cylinder(mill).half_height - q.radius;
    Vec3<double> place, velocity;
    do
      place = {draw.uniform(-across, across), draw.uniform(-along, along),
          draw.uniform(-across, across)};
    while (place[0] * place[0] + place[2] * place[2] > across * across);
    for (int axis = 0; axis < 3; ++axis)
      velocity[axis] = draw.chance(0.3) ? 0 : draw.uniform(-3.4, 3.4);
    const auto pose = mill.motion.pose({0, q.begin.offset});
    q.flight = {mill.motion.to_inertial(pose, place), velocity, q.begin};
    const testing::GeneralFunctions<double> functions(
        walls.mill(), q.flight, q.radius, q.begin.period);
    const auto excluded = [&](double length) {
      const double fastest = norm<double>(velocity) + walls.mill().gravity_size * length;
      const auto reach = walls.within_reach(functions, place, fastest, length);
      return !reach[0] && !reach[1] && !reach[2];
    };
    double longest = 0, too_long = walls.longest_window();
    if (excluded(too_long)) continue;
    for (int halving = 0; halving < 30; ++halving) {
      const double middle = (longest + too_long) / 2;
      (excluded(middle) ? longest : too_long) = middle;
    }
    if (!(longest > 1e-6)) continue;
    ++proven;
    const auto hit_within = [&](double length) {
      q.length = length;
      const auto decide = [&](const WallQuery<double>& query) { return ladder.wall(query); };
      return over_window(decide, q, mill.motion.period()).verdict == Verdict::contact;
    };
    ASSERT_FALSE(hit_within(longest));
    soon_after += 2 * longest < walls.longest_window() && hit_within(2 * longest);
  }
  EXPECT_GT(proven, 4000);
  EXPECT_GT(soon_after, 50);  // of 86: a proof that allowed half the time would leave none
}

TEST(WallSearch, APathThatGrazesByANanometreIsDecidedInDouble) {
  EXPECT_EQ(grazing_verdict<double>(0x1p-30), Verdict::none);
  EXPECT_EQ(grazing_verdict<double>(-0x1p-30), Verdict::contact);
}

TEST(WallSearch, APathThatGrazesWithinTheRoundingOfDoubleIsDecidedInFloat128) {
  for (const double d : {0x1p-57, -0x1p-57}) {
    EXPECT_EQ(grazing_verdict<double>(d), Verdict::undecided);
    EXPECT_EQ(grazing_verdict<float128>(d), d > 0 ? Verdict::none : Verdict::contact);
    EXPECT_EQ(grazing_verdict<mpfr50>(d), d > 0 ? Verdict::none : Verdict::contact);
  }
}

TEST(WallSearch, APathThatGrazesWithinTheRoundingOfFloat128IsDecidedInMpfr50) {
  for (const double d : {0x1p-120, -0x1p-120}) {
    EXPECT_EQ(grazing_verdict<double>(d), Verdict::undecided);
    EXPECT_EQ(grazing_verdict<float128>(d), Verdict::undecided);
    EXPECT_EQ(grazing_verdict<mpfr50>(d), d > 0 ? Verdict::none : Verdict::contact);
  }
}

/// Exactly, whatever the scalar: a path that touches the cap at its highest point does not hit it.
TEST(WallSearch, APathThatGrazesAFlatWallIsDecidedInDoubleByExactArithmetic) {
  DecisionLadder<double> ladder(still_mill<double>(grazing_gravity), 2 * ball_radius, 10.0);
  for (const double distance : {0x1p-30, 0x1p-57, 0x1p-120, 0x1p-200, 0.0}) {
    EXPECT_EQ(ladder.wall(grazing_query(distance)).verdict, Verdict::none);
    if (distance == 0) continue;
    const auto hit = ladder.wall(grazing_query(-distance));
    ASSERT_EQ(hit.verdict, Verdict::contact);
    EXPECT_EQ(hit.wall, 0);
    // sqrt(2 d / g) before the highest point; by bounds, so nearly level, the gap is zero within
    // rounding for some 1e-14 s.
    EXPECT_NEAR(hit.time.offset, 1.0 / 16 - std::sqrt(distance) / 2, 1e-13);
    EXPECT_LE(hit.time.offset, 1.0 / 16);
  }
  for (const auto& row : ladder.escalations()) EXPECT_EQ(row.wall, 0u);
}

TEST(WallSearch, TheLadderClimbsAsFarAsTheCaseNeedsAndCountsIt) {
  DecisionLadder<double> ladder(round_grazing_mill<double>(), 2 * ball_radius, 10.0);
  const auto expect_counts = [&](std::uint64_t to_float128, std::uint64_t to_mpfr50,
                                 std::uint64_t by_rule) {
    const auto rows = ladder.escalations();
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[0].scalar, "float128");
    EXPECT_EQ(rows[1].scalar, "mpfr50");
    EXPECT_EQ(rows[2].scalar, "rule");
    EXPECT_EQ(rows[0].wall, to_float128);
    EXPECT_EQ(rows[1].wall, to_mpfr50);
    EXPECT_EQ(rows[2].wall, by_rule);
  };
  const auto first = [&](double distance) {
    const auto decide = [&](const WallQuery<double>& query) { return ladder.wall(query); };
    return over_window(decide, round_grazing_query(distance), 1.0);
  };
  EXPECT_EQ(first(0x1p-30).verdict, Verdict::none);
  expect_counts(0, 0, 0);
  EXPECT_EQ(first(0x1p-57).verdict, Verdict::none);
  expect_counts(1, 0, 0);
  const auto hit = first(-0x1p-120);
  expect_counts(2, 1, 0);
  // sqrt(2 d / g) = 2^-61 s before the highest point
  EXPECT_EQ(hit.verdict, Verdict::contact);
  EXPECT_EQ(hit.wall, 2);
  EXPECT_LE(hit.time.offset, 1.0 / 16);
  EXPECT_GE(hit.time.offset, std::nextafter(1.0 / 16, 0.0));
  EXPECT_EQ(first(0x1p-120).verdict, Verdict::none);
  expect_counts(3, 2, 0);
  first(0x1p-200);
  expect_counts(4, 3, 1);
}

TEST(WallSearch, GrazingWithinRoundingInTheMovingMillNeedsFloat128) {
  const auto mill = testing::spex_mill<double>();
  const auto narrow = testing::general_search(mill);
  const auto wide = testing::general_search(widened<float128>(mill));
  StateMaker make(mill, narrow.longest_window());
  make.grazing_distance = 1e-17;
  Draw draw(20110103);
  int undecided = 0;
  constexpr int count = 200;
  for (int k = 0; k < count; ++k) {
    const auto query = make(draw, Kind::grazing, false);
    // Another wall may be hit before.
    if (over_window(narrow, query, mill.motion.period()).verdict != Verdict::undecided) continue;
    ++undecided;
    EXPECT_NE(over_window(wide, widened<float128>(query), float128(mill.motion.period())).verdict,
        Verdict::undecided);
  }
  EXPECT_GT(undecided, count * 9 / 10);
}

TEST(WallSearch, ABallThatFliesStraightHitsACapAfterDistanceOverSpeed) {
  // y = -X: the cap at +y is wall 1.
  const auto up = ask({0, 0, 0}, query_of({1.0 / 128, 0, 0}, {-0.5, 0, 0}, 0.0625));
  EXPECT_EQ(up.verdict, Verdict::contact);
  EXPECT_EQ(up.wall, 1);
  EXPECT_NEAR(up.time.offset, 3.0 / 128 / 0.5, 1e-16);
  const auto down = ask({0, 0, 0}, query_of({1.0 / 128, 0, 0}, {0.5, 0, 0}, 0.0625));
  EXPECT_EQ(down.verdict, Verdict::contact);
  EXPECT_EQ(down.wall, 0);
  EXPECT_NEAR(down.time.offset, 1.0 / 128 / 0.5, 1e-16);
}

TEST(WallSearch, ABallThatFliesStraightHitsTheCylinderAfterDistanceOverSpeed) {
  const auto hit = ask({0, 0, 0}, query_of({0, 0, -1.0 / 64}, {0, 0, 1.0}, 0.0625));
  EXPECT_EQ(hit.verdict, Verdict::contact);
  EXPECT_EQ(hit.wall, 2);
  EXPECT_NEAR(hit.time.offset, 3.0 / 64, 1e-16);
}

TEST(WallSearch, ABallThatEndsItsWindowBeforeTheWallHasNoContact) {
  EXPECT_EQ(ask({0, 0, 0}, query_of({1.0 / 128, 0, 0}, {0.5, 0, 0}, 0.015)).verdict, Verdict::none);
  EXPECT_EQ(
      ask({0, 0, 0}, query_of({1.0 / 128, 0, 0}, {0.5, 0, 0}, 0.016)).verdict, Verdict::contact);
}

TEST(WallSearch, AWallThatWasJustLeftIsNotHitAgainAtOnce) {
  for (const double speed : {1e-12, 1e-6, 1e-3, 0.2})
    for (const double overlap : {0.0, 1e-18, -1e-18}) {
      EXPECT_EQ(ask({0, 0, 0}, query_of({1.0 / 64 + overlap, 0, 0}, {-speed, 0, 0}, 0.125)).verdict,
          Verdict::none);
      EXPECT_EQ(ask({0, 0, 0}, query_of({0, 0, 1.0 / 32 + overlap}, {0, 0, -speed}, 0.125)).verdict,
          Verdict::none);
    }
}

TEST(WallSearch, AThrownBallReturnsToTheWallAtTheClosedFormTime) {
  for (const double speed : {0x1p-30, 0x1p-16, 0x1p-8, 0x1p-3}) {
    // Leaves cap 0 at X = 1/64, falls back with g = 8 m/s2.
    const auto cap = ask({8, 0, 0}, query_of({1.0 / 64, 0, 0}, {-speed, 0, 0}, 0.125));
    EXPECT_EQ(cap.verdict, Verdict::contact);
    EXPECT_EQ(cap.wall, 0);
    EXPECT_NEAR(cap.time.offset, 2 * speed / 8, 1e-16 + 4e-16 / speed);
    const auto side = ask({0, 0, 8}, query_of({0, 0, 1.0 / 32}, {0, 0, -speed}, 0.125));
    EXPECT_EQ(side.verdict, Verdict::contact);
    EXPECT_EQ(side.wall, 2);
    EXPECT_NEAR(side.time.offset, 2 * speed / 8, 1e-16 + 4e-16 / speed);
  }
}

TEST(WallSearch, AnOverlappedBallThatApproachesIsInContactAtOnce) {
  const auto hit = ask({0, 0, 0}, query_of({1.0 / 64 + 0x1p-58, 0, 0}, {1e-3, 0, 0}, 0.1));
  EXPECT_EQ(hit.verdict, Verdict::contact);
  EXPECT_EQ(hit.wall, 0);
  EXPECT_EQ(hit.time, (Instant<double>{0, 0.0}));
}

TEST(WallSearch, AnOverlappedBallThatTurnsBackInsideTheWallIsInContactThere) {
  // Overlap 2^-50 m, leaves with 2^-30 m/s against g = 8 m/s2: rises 2^-64 m, turns after 2^-33 s.
  const auto hit = ask({8, 0, 0}, query_of({1.0 / 64 + 0x1p-50, 0, 0}, {-0x1p-30, 0, 0}, 0.1));
  EXPECT_EQ(hit.verdict, Verdict::contact);
  EXPECT_EQ(hit.wall, 0);
  EXPECT_NEAR(hit.time.offset, 0x1p-33, 0x1p-47);
}

/// Gap and rate are zero: the second derivative decides, in every scalar.
TEST(WallSearch, ABallAtRestOnAWallIsInContactAtOnceWhenItIsPressed) {
  for (const double g : {8.0, 1e-3}) {
    const auto cap = ask({g, 0, 0}, query_of({1.0 / 64, 0, 0}, {0, 0, 0}, 0.1));
    EXPECT_EQ(cap.verdict, Verdict::contact);
    EXPECT_EQ(cap.wall, 0);
    EXPECT_EQ(cap.time, (Instant<double>{0, 0.0}));
    const auto side = ask({0, 0, g}, query_of({0, 0, 1.0 / 32}, {0, 0, 0}, 0.1));
    EXPECT_EQ(side.verdict, Verdict::contact);
    EXPECT_EQ(side.wall, 2);
    EXPECT_EQ(side.time, (Instant<double>{0, 0.0}));
  }
}

TEST(WallSearch, ABallAtRestOnAWallThatFallsOffComesToTheOtherWall) {
  // From cap 0 at X = 1/64 to cap 1 at -1/64, g = 8 m/s2: sqrt(2 / 32 / 8) s.
  const auto cap = ask({-8, 0, 0}, query_of({1.0 / 64, 0, 0}, {0, 0, 0}, 0.125));
  EXPECT_EQ(cap.verdict, Verdict::contact);
  EXPECT_EQ(cap.wall, 1);
  EXPECT_NEAR(cap.time.offset, std::sqrt(2.0 / 32 / 8), 1e-15);
}

TEST(WallSearch, ABallAtRestOnAWallWithoutGravityStays) {
  EXPECT_EQ(ask({0, 0, 0}, query_of({1.0 / 64, 0, 0}, {0, 0, 0}, 0.125)).verdict, Verdict::none);
}

TEST(WallSearch, AContactExactlyAtTheEndOfTheWindowIsLeftToTheNext) {
  // 1/64 m at 1/8 m/s: the cap is reached after 1/8 s, the longest window.
  const auto query = query_of({0, 0, 0}, {0.125, 0, 0}, 0.125);
  const auto walls = testing::general_search(still_mill<double>({0, 0, 0}));
  ASSERT_EQ(walls.longest_window(), 0.125);
  const auto first = walls(query);
  EXPECT_EQ(first.verdict, Verdict::none);
  EXPECT_GT(first.searched, 0.05);
  EXPECT_LT(first.searched, 0.125);
  EXPECT_EQ(
      testing::general_search(still_mill<float128>({0, 0, 0}))(widened<float128>(query)).verdict,
      Verdict::none);
  auto later = query;
  later.begin.offset = 0.0625;
  const auto found = ask({0, 0, 0}, later);
  EXPECT_EQ(found.verdict, Verdict::contact);
  EXPECT_NEAR(found.time.offset, 0.125, 1e-16);
}

/// The gap is not negative at the time that is given, and negative a unit of the clock later.
TYPED_TEST(WideWallSearch, ARootIsClosedToTheLastDigitOfTheScalar) {
  using Real = TypeParam;
  const auto mill = testing::spex_mill<Real>();
  const auto walls = testing::general_search(mill);
  const auto narrow = model::mill_cast<double>(mill);
  StateMaker make(narrow, static_cast<double>(walls.longest_window()));
  Draw draw(20110104);
  int contacts = 0;
  for (int k = 0; k < 1000; ++k) {
    auto query = widened<Real>(make(draw, Kind::anywhere, false));
    const auto answer = walls(query);
    if (answer.verdict != Verdict::contact || answer.time.period != query.begin.period) continue;
    ++contacts;
    const auto constants = testing::moving(mill);
    const testing::GeneralFunctions<Real> gaps(
        constants, query.flight, query.radius, query.begin.period);
    const Real unit = epsilon<Real>() * mill.motion.period();
    EXPECT_GE(gaps(Real(answer.time.offset - 16 * answer.time_error)).gap[answer.wall], 0);
    EXPECT_LT(
        gaps(Real(answer.time.offset + 2 * unit + 16 * answer.time_error)).gap[answer.wall], 0);
  }
  EXPECT_GT(contacts, 60);
}

TEST(WallSearch, AWindowBeyondTheBoundsIsRefused) {
  DecisionLadder<double> ladder(still_mill<double>({0, 0, 0}), 2 * ball_radius, 10.0);
  const double longest = ladder.walls().longest_window();
  EXPECT_THROW(ladder.wall(query_of({0, 0, 0}, {0, 0, 0.1}, 1.01 * longest)), ContractError);
  EXPECT_THROW(ladder.wall(query_of({0, 0, 0}, {0, 0, 0.1}, 0.0)), ContractError);
}

}  // namespace
}  // namespace edmill::dynamics
