// Single impacts by hand: the errors of the printed equations, and the least separation speed at
// its limits.
#include <gtest/gtest.h>

#include <cmath>

#include "dynamics/impulse.hpp"

namespace edmill::dynamics {
namespace {

TEST(ImpulseErrata, PrintedSignOfTheTangentialTermBreaksTheRestitutionLaw) {
  // (2.34) as printed has -(e_t - 1)/(1 + 1/J) g_t: the slip would grow instead of following e_t.
  const model::BallProperties<double> ball{0.005, 0.004, 0.4};
  const Vec3<double> normal(0, 1, 0), wall(0, 0, 0);
  const model::ContactLaw<double> law{model::WaltonBraun<double>{.normal = 0.5, .friction = 0.4}};
  Vec3<double> v(3, -1, 0), w(0, 0, 0);
  const auto o = collide_with_wall<double>(normal, ball, wall, v, w, law);
  const double gt = 3, e_t = o.restitution_tangential;
  ASSERT_LT(e_t, 1);
  const double printed_v = 3 - (e_t - 1) / (1 + 1 / 0.4) * gt;
  EXPECT_LT(v[0], 3);       // friction slows the sliding contact
  EXPECT_GT(printed_v, 3);  // the printed sign speeds it up
  // With the spin of (2.35) the contact's slip is e_t g_t only for the corrected sign.
  const auto slip = [&](double vx) {
    return vx - (w[1] * 0.005 * normal[2] - w[2] * 0.005 * normal[1]);
  };
  EXPECT_NEAR(slip(v[0]), e_t * gt, 1e-14);
  EXPECT_GT(std::abs(slip(printed_v) - e_t * gt), 0.1);
}

TEST(ImpulseErrata, PrintedCompliancePutsTheSlidingImpulseOffForBallsOfUnequalInertia) {
  // (2.24) is printed with 1 + 1/J, right for balls of one reduced inertia; in general 1 + M/(m_i
  // J_i) + M/(m_j J_j).
  const model::BallProperties<double> i{0.004, 2e-3, 0.4}, j{0.005, 4.2e-3, 0.66};
  Vec3<double> vi(0, -1, 4), wi(0, 0, 0), vj(0, 0, 0), wj(0, 0, 0);
  const model::ContactLaw<double> law{model::WaltonBraun<double>{.normal = 0.5, .friction = 0.1}};
  const auto o = collide_balls<double>(Vec3<double>(0, 1, 0), i, j, vi, wi, vj, wj, law);
  EXPECT_NEAR(o.tangential_impulse / o.normal_impulse, 0.1, 1e-15);
  const double m = i.mass * j.mass / (i.mass + j.mass);
  const double right = 1 + m / (i.mass * 0.4) + m / (j.mass * 0.66), printed = 1 + 1 / 0.4;
  EXPECT_GT(std::abs(printed / right - 1), 0.05);
}

/// A ball on a still floor with a given approach speed, negative when it separates, and a slip.
struct FloorHit {
  static constexpr double mass = 2, slip = 3;
  ImpactOutcome<double> outcome;
  Vec3<double> v, w{0, 0, 0};

  FloorHit(double approach, double least_separation) : v(slip, -approach, 0) {
    const model::ContactLaw<double> law{
        model::WaltonBraun<double>{.normal = 0.5, .friction = 0.25}, least_separation};
    outcome = collide_with_wall<double>({0, 1, 0}, {1, mass, 0.4}, {0, 0, 0}, v, w, law);
  }
};

TEST(LeastSeparation, SlowApproachesAndPartingByRoundingLeaveAtTheLeastSpeed) {
  const double least = 0x1p-20;
  for (const double approach : {0x1p-20, 0x1p-21, 0x1p-60, 0.0, -0x1p-60, -0x1p-21}) {
    const FloorHit hit(approach, least);
    EXPECT_EQ(hit.v[1], least) << approach;
    EXPECT_EQ(hit.outcome.separation_speed, least) << approach;
    EXPECT_TRUE(hit.outcome.least_separation) << approach;
    // Friction by the actual normal impulse, m (g_n' - g_n).
    EXPECT_EQ(hit.outcome.normal_impulse, FloorHit::mass * (approach + least)) << approach;
    // 1 - e_t is 4e-7 here and known to an epsilon.
    EXPECT_NEAR(hit.outcome.tangential_impulse / hit.outcome.normal_impulse, 0.25, 1e-8)
        << approach;
    EXPECT_EQ(hit.outcome.normal_dose, 0) << approach;
    EXPECT_EQ(hit.outcome.supplied_energy,
        FloorHit::mass / 2 * (least * least - approach * approach))  // exact: powers of two
        << approach;
  }
}

TEST(LeastSeparation, BodiesThatPartFasterGoOnAsTheyAre) {
  for (const double least : {0.0, 0x1p-20}) {
    const double parting = 0x1p-19;
    const FloorHit hit(-parting, least);
    EXPECT_EQ(hit.v[1], parting);
    EXPECT_EQ(hit.v[0], FloorHit::slip);
    EXPECT_EQ(norm<double>(hit.w), 0);
    EXPECT_EQ(hit.outcome.normal_impulse, 0);
    EXPECT_EQ(hit.outcome.tangential_impulse, 0);
    EXPECT_EQ(hit.outcome.milling_dose, 0);
    EXPECT_EQ(hit.outcome.supplied_energy, 0);
  }
}

TEST(LeastSeparation, WhereTheReboundIsAsFastTheRuleDoesNothing) {
  const FloorHit free(0x1p-19, 0), limit(0x1p-19, 0x1p-20), faster(0x1p-18, 0x1p-20);
  EXPECT_FALSE(limit.outcome.least_separation);  // 0.5 x 2^-19 is the least speed itself
  EXPECT_FALSE(faster.outcome.least_separation);
  EXPECT_EQ(limit.v, free.v);
  EXPECT_EQ(limit.w, free.w);
  EXPECT_EQ(limit.outcome.milling_dose, free.outcome.milling_dose);
}

TEST(LeastSeparation, ATouchedImpactThatStillLosesHasADose) {
  // From 1 m/s to 0.75 instead of 0.5: M/2 (1 - 0.75^2) is dissipated, nothing supplied.
  const FloorHit hit(1, 0.75);
  EXPECT_TRUE(hit.outcome.least_separation);
  EXPECT_EQ(hit.outcome.normal_dose, FloorHit::mass / 2 * (1 - 0.5625));
  EXPECT_EQ(hit.outcome.supplied_energy, 0);
  EXPECT_EQ(hit.outcome.restitution_normal(), 0.75);
  EXPECT_EQ(hit.outcome.normal_impulse, FloorHit::mass * 1.75);
}

}  // namespace
}  // namespace edmill::dynamics
