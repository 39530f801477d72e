// What holds for every motion and every vessel: certified roots, bounds on rounding and on
// derivatives, and the same bits from the search of the SPEX and from that for any mill.
#include <gtest/gtest.h>

#include "any_mills.hpp"
#include "casefile/random.hpp"
#include "wall_comparison.hpp"

namespace edmill::dynamics {
namespace {

class AnyMill : public ::testing::TestWithParam<testing::MillText> {
 protected:
  model::Mill<double> mill = testing::mill_of(GetParam());

  template <class Real> void expect_agreement(std::uint64_t seed, long count) const {
    std::cout << "seed " << seed << ", " << count << " states\n";
    Comparison<Real> compare(mill);
    const StateMaker make(mill, compare.longest_window());
    Draw draw(seed);
    std::map<std::string, Tally> tallies;
    const bool turns_back = mill.motion.wall_speed(0) > 0 || norm<double>(mill.gravity) > 0;
    for (long k = 0; k < count; ++k) {
      Kind kind = all_kinds[k % std::size(all_kinds)];
      if (!turns_back && (kind == Kind::grazing || kind == Kind::dipping)) kind = Kind::anywhere;
      compare(make(draw, kind, draw.chance(0.25)), tallies[name(kind)]);
    }
    print(tallies);
    long bad = 0, contacts = 0;
    for (const auto& [name, tally] : tallies) bad += tally.bad(), contacts += tally.contacts;
    EXPECT_EQ(bad, 0);
    EXPECT_GT(contacts, count / 4);
  }
};
INSTANTIATE_TEST_SUITE_P(All, AnyMill, ::testing::ValuesIn(testing::all_mills),
    [](const auto& info) { return std::string(info.param.name); });

TEST_P(AnyMill, AgreesWithAnIndependentSolver) {
  expect_agreement<double>(20261101, wanted_states() / 250);
}
TEST_P(AnyMill, AgreesWithAnIndependentSolverInFloat128) {
  expect_agreement<float128>(20261102, wanted_states() / 1000);
}
TEST_P(AnyMill, AgreesWithAnIndependentSolverIn50Digits) {
  expect_agreement<mpfr50>(20261103, wanted_states() / 1000);
}
// Behind the label `long`: EDMILL_WALL_STATES of each mill, a tenth in wide scalars.
TEST_P(AnyMill, LongAgreesWithAnIndependentSolver) {
  expect_agreement<double>(20261104, wanted_states());
}
TEST_P(AnyMill, LongAgreesWithAnIndependentSolverInFloat128) {
  expect_agreement<float128>(20261105, wanted_states() / 10);
}
TEST_P(AnyMill, LongAgreesWithAnIndependentSolverIn50Digits) {
  expect_agreement<mpfr50>(20261106, wanted_states() / 10);
}

/// One state of a mill beside the independent solver.
Tally compared(const char* mill, const WallQuery<double>& query) {
  Comparison<double> compare(testing::mill_of(testing::mill_named(mill)));
  Tally tally;
  compare(query, tally);
  return tally;
}

// The ball crosses into the next region sooner after its window begins than double can resolve. A
// wider scalar that decides this has to go on into the next region before double asks again; double
// decides it by itself, since it excludes what it leaves however short the window is.
TEST(AnyMillStates, ASearchGetsAheadOfABorderThatDoubleCannotTellFromItsBegin) {
  WallQuery<double> query{};
  query.flight = {{0x1.544ddbb6d5966p-6, -0x1.552f86aa59e6ap-6, 0x1.b7327914f8987p-5},
      {0x1.cdd9b2f179f8fp+0, 0x1.e22ddac30033bp-2, -0x1.cfe696605c731p-1},
      {1000000007, 0x1.efcda4cda4bbcp-4}};
  query.radius = 0x1.4153518b98faep-10;
  query.begin = {1000000007, 0x1.fbae78ba5ec75p-4};
  query.length = 0x1.08cdb66eb178cp-11;
  const auto tally = compared("planetary_rounded", query);
  EXPECT_EQ(tally.bad(), 0);
}

// The gap is zero to within the rounding of 50 digits, and falls slowly: the window that is looked
// at first has to be long enough for the fall to show.
TEST(AnyMillStates, ATouchingBallThatApproachesSlowlyIsInContact) {
  WallQuery<double> query{};
  query.flight = {{0x1.e584ccd143043p-7, -0x1.4d29f395127dap-6, -0x1.5ed53ab94a7fap-4},
      {-0x1.1fe49dffe901dp+1, -0x1.487290cede1f7p-21, 0x1.3dc580197f1acp+0},
      {0, 0x1.3333333333333p-5}};
  query.radius = 0x1.b939daff1f2a8p-10;
  query.begin = {0, 0x1.3333333333333p-5};
  query.length = 0x1.194466dc44c86p-10;
  const auto tally = compared("planetary_box", query);
  EXPECT_EQ(tally.bad(), 0);
  EXPECT_EQ(tally.contacts, 1);
}

/// A ball of random size somewhere in the vessel at the instant, flying at random.
struct RandomFlight {
  Flight<double> flight;
  double radius;
  std::int64_t period;
  double offset;

  RandomFlight(Draw& draw, const model::Mill<double>& mill) {
    radius = draw.uniform(0.001, 0.006);
    std::optional<Vec3<double>> place;
    while (!place)
      place =
          mill.vessel.inset(radius).place({draw.symmetric(), draw.symmetric(), draw.symmetric()});
    const double drive = mill.motion.period();
    flight.start = {0, draw.uniform(0, drive)};
    flight.position = mill.motion.to_inertial(mill.motion.pose(flight.start), *place);
    flight.velocity =
        Vec3<double>(draw.symmetric(), draw.symmetric(), draw.symmetric()) * draw.uniform(0, 10);
    const double later = flight.start.offset + 0.1 * drive * draw.uniform();
    period = later < drive ? 0 : 1;
    offset = period ? later - drive : later;
  }
};

/// @param least  of the worst gap over its bound: the bound is not idle; that of a chain counts
/// every joint at its worst
void expect_rounding_below_bounds(const model::Mill<double>& mill, double least, int count) {
  const auto narrow_mill = testing::moving(mill);
  const auto wide_mill = testing::moving(model::mill_cast<mpfr50>(mill));
  Draw draw(21);
  double worst_gap = 0, worst_rate = 0, worst_curvature = 0;
  for (int k = 0; k < count; ++k) {
    const RandomFlight r(draw, mill);
    const testing::GeneralFunctions<double> narrow(narrow_mill, r.flight, r.radius, r.period);
    const testing::GeneralFunctions<mpfr50> exact(
        wide_mill, flight_cast<mpfr50>(r.flight), mpfr50(r.radius), r.period);
    const auto found = narrow.start(r.offset);
    const auto truth = exact.start(mpfr50(r.offset));
    const double elapsed = narrow.elapsed(r.offset);
    const double speed = norm<double>(r.flight.velocity) + narrow_mill.gravity_size * elapsed;
    const auto bound = narrow.errors(elapsed, speed);
    const auto part = [](double x, const mpfr50& y, double allowed) {
      return static_cast<double>(abs(mpfr50(x) - y)) / allowed;
    };
    for (int wall = 0; wall < mill.vessel.wall_count(); ++wall) {
      worst_gap = std::max(worst_gap, part(found.gap[wall], truth.gap[wall], bound.gap[wall]));
      worst_rate = std::max(worst_rate, part(found.rate[wall], truth.rate[wall], bound.rate[wall]));
      worst_curvature = std::max(worst_curvature,
          part(found.curvature[wall], truth.curvature[wall], bound.curvature[wall]));
    }
  }
  std::cout << "largest errors over their bounds: gap " << worst_gap << ", rate " << worst_rate
            << ", curvature " << worst_curvature << "\n";
  EXPECT_LT(worst_gap, 1);
  EXPECT_LT(worst_rate, 1);
  EXPECT_LT(worst_curvature, 1);
  EXPECT_GT(worst_gap, least);
}

TEST_P(AnyMill, RoundingErrorsStayBelowTheirBounds) {
  expect_rounding_below_bounds(mill, 0.001, 5000);
}
TEST_P(AnyMill, LongRoundingErrorsStayBelowTheirBounds) {
  expect_rounding_below_bounds(mill, 0.003, 50000);
}

/// Turns as a program can give them; those of a case are reduced when it is read.
void expect_rounding_of_many_turns_below_bounds(const model::Mill<double>& mill, int count) {
  const auto* chain = mill.motion.get_if<model::ChainMotion<double>>();
  if (!chain) GTEST_SKIP() << "no chain";
  Draw draw(23);
  auto joints = chain->joints();
  for (auto& joint : joints.list) {
    if (joint.rotates) joint.angle += draw.uniform(-50000, 50000);
    for (auto& swing : joint.swings) swing.phase += draw.uniform(-50000, 50000);
  }
  auto turned = mill;
  turned.motion = model::ChainMotion<double>(joints);
  // A number of double is exact in both, and whole quarters of a turn are dropped exactly: the
  // bound is far.
  expect_rounding_below_bounds(turned, 0, count);
}
TEST_P(AnyMill, RoundingErrorsOfManyConstantTurnsStayBelowTheirBounds) {
  expect_rounding_of_many_turns_below_bounds(mill, 5000);
}
TEST_P(AnyMill, LongRoundingErrorsOfManyConstantTurnsStayBelowTheirBounds) {
  expect_rounding_of_many_turns_below_bounds(mill, 50000);
}

void expect_derivatives_below_bounds(const model::Mill<double>& mill, int count) {
  const auto wide_mill = testing::moving(model::mill_cast<mpfr50>(mill));
  const BoundsTable table(testing::moving(mill));
  Draw draw(22);
  double worst = 0;
  for (int k = 0; k < count; ++k) {
    const RandomFlight r(draw, mill);
    const double length = table.longest_window() * draw.uniform(0.01, 1);
    const testing::GeneralFunctions<mpfr50> f(
        wide_mill, flight_cast<mpfr50>(r.flight), mpfr50(r.radius), r.flight.start.period);
    const double speed = norm<double>(r.flight.velocity) + norm<double>(mill.gravity) * length;
    const auto bound = table.at(speed, length);
    const mpfr50 h("1e-8"), h2 = h * h;
    for (int step = 0; step <= 2; ++step) {
      const mpfr50 t = mpfr50(r.flight.start.offset) + mpfr50(length) * step / 2;
      std::vector<GapSample<model::AnyVessel<mpfr50>>> g;
      for (int n = -2; n <= 2; ++n) g.push_back(f(t + n * h));
      for (int wall = 0; wall < mill.vessel.wall_count(); ++wall) {
        const auto at = [&](int n) { return g[static_cast<std::size_t>(n + 2)].gap[wall]; };
        const mpfr50 derivatives[] = {(at(1) - 2 * at(0) + at(-1)) / h2,
            (at(2) - 2 * at(1) + 2 * at(-1) - at(-2)) / (2 * h2 * h),
            (at(2) - 4 * at(1) + 6 * at(0) - 4 * at(-1) + at(-2)) / (h2 * h2)};
        for (std::size_t n = 0; n < 3; ++n) {
          const double most = bound[static_cast<std::size_t>(mill.vessel.kind_of(wall))][n];
          // Central differences of fourth order are off by a few millionths.
          const double found = static_cast<double>(abs(derivatives[n]));
          EXPECT_LE(found, most * (1 + 1e-5) + 1e-9)
              << "derivative " << n + 2 << " of wall " << wall;
          if (most > 0) worst = std::max(worst, found / most);
        }
      }
    }
  }
  std::cout << "largest derivative over its bound: " << worst << "\n";
  EXPECT_GT(worst, 0.1);  // chains bound the size of vectors, not coordinates
}
TEST_P(AnyMill, DerivativesOfTheGapsStayBelowTheirBounds) {
  expect_derivatives_below_bounds(mill, 500);
}
TEST_P(AnyMill, LongDerivativesOfTheGapsStayBelowTheirBounds) {
  expect_derivatives_below_bounds(mill, 5000);
}

TEST_P(AnyMill, PosesNearbyAgreeWithPosesFromSines) {
  const auto motion = mill.motion.cast<float128>();
  Draw draw(23);
  const float128 w = 2 * numerics::pi<float128>() / motion.period();
  for (int k = 0; k < 2000; ++k) {
    const Instant<float128> known{0, draw.uniform() * motion.period()};
    const Instant<float128> later{
        0, known.offset + draw.symmetric() * std::ldexp(1.0, -20 - k % 40) / w};
    const Vec3<float128> p{
        draw.symmetric() * 0.03, draw.symmetric() * 0.03, draw.symmetric() * 0.03};
    const auto near = motion.pose_nearby(later, motion.pose(known), known),
               direct = motion.pose(later);
    const float128 size = motion.reach(float128(0.06)), unit = 32 * epsilon<float128>();
    const Vec3<float128> place = motion.to_inertial(direct, p);
    const auto off = [](const Vec3<float128>& a, const Vec3<float128>& b) {
      return norm<float128>(Vec3<float128>(a - b));
    };
    ASSERT_LE(off(motion.to_inertial(near, p), place), size * unit);
    ASSERT_LE(off(motion.position_nearby(later, motion.pose(known), known, place), p), size * unit);
    ASSERT_LE(off(motion.wall_velocity(near, p), motion.wall_velocity(direct, p)), size * w * unit);
    ASSERT_LE(off(motion.wall_acceleration(near, p), motion.wall_acceleration(direct, p)),
        size * w * w * unit);
  }
}

TEST_P(AnyMill, VelocitiesAndAccelerationsAreDerivatives) {
  const auto motion = mill.motion.cast<mpfr50>();
  Draw draw(24);
  const auto vector = [&](double size) {
    return Vec3<mpfr50>(size * draw.symmetric(), size * draw.symmetric(), size * draw.symmetric());
  };
  const auto gravity = vector_cast<mpfr50>(mill.gravity);
  const mpfr50 h("1e-9");
  for (int k = 0; k < 200; ++k) {
    const mpfr50 t = draw.uniform() * motion.period();
    const Vec3<mpfr50> p = vector(0.03), r = vector(0.15), v = vector(5);
    const auto pose = [&](const mpfr50& s) { return motion.pose({0, s}); };
    const auto wall = [&](const mpfr50& s) { return motion.to_inertial(pose(s), p); };
    const auto wall_velocity = [&](const mpfr50& s) {
      return motion.wall_velocity(pose(s), wall(s));
    };
    const auto free = [&](const mpfr50& s) {
      const mpfr50 dt = s - t;
      return motion.to_vessel_frame(pose(s), Vec3<mpfr50>(r + v * dt + gravity * (dt * dt / 2)),
          Vec3<mpfr50>(v + gravity * dt));
    };
    const auto off = [&](const Vec3<mpfr50>& found, const Vec3<mpfr50>& later,
                         const Vec3<mpfr50>& before) {
      return static_cast<double>(
          norm<mpfr50>(Vec3<mpfr50>(found - (later - before) * (1 / (2 * h)))));
    };
    EXPECT_LT(off(wall_velocity(t), wall(t + h), wall(t - h)), 1e-11);
    EXPECT_LT(
        off(motion.wall_acceleration(pose(t), wall(t)), wall_velocity(t + h), wall_velocity(t - h)),
        1e-9);
    const auto seen = free(t);
    EXPECT_LT(off(seen.velocity, free(t + h).position, free(t - h).position), 1e-10);
    EXPECT_LT(off(motion.vessel_frame_acceleration(pose(t), seen, v, gravity), free(t + h).velocity,
                  free(t - h).velocity),
        1e-8);
    EXPECT_LT(static_cast<double>(
                  norm<mpfr50>(Vec3<mpfr50>(motion.position_in_vessel(pose(t), wall(t)) - p))),
        1e-48);
    // No point of the vessel is faster than the bound.
    EXPECT_LE(norm<mpfr50>(wall_velocity(t)), motion.wall_speed(norm<mpfr50>(p)));
  }
}

/// The two instances of the search in double.
TEST(AnyMill, TheSearchOfTheSpexAndTheGeneralOneGiveTheSameBits) {
  const auto mill = testing::mill_of(testing::all_mills[0]);
  const AnyWallSearch<double>::Spex fused(
      testing::spex(mill), testing::cylinder(mill), mill.gravity);
  const auto general = testing::general_search(mill);
  const StateMaker make(mill, fused.longest_window());
  Draw draw(20261104);
  long contacts = 0;
  for (long k = 0; k < wanted_states() / 5; ++k) {
    const auto query = make(draw, all_kinds[k % std::size(all_kinds)], draw.chance(0.25));
    const auto a = fused.search(query), b = general.search(query);
    ASSERT_EQ(a.verdict, b.verdict);
    ASSERT_EQ(a.wall, b.wall);
    ASSERT_EQ(a.time, b.time);
    ASSERT_EQ(a.searched, b.searched);
    ASSERT_EQ(a.time_error, b.time_error);
    contacts += a.verdict == Verdict::contact;
  }
  EXPECT_GT(contacts, wanted_states() / 20);
}

}  // namespace
}  // namespace edmill::dynamics
