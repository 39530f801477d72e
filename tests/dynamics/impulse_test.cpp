// Properties of the impact laws: (2.23), (2.24), (2.25), (2.28), (2.30), (2.31), (2.34'), (2.36), (A.82).
// Each holds to rounding for random bodies; run in double and, to show that it is the formula and not the
// tolerance, in 50 digits.
#include "edmill/dynamics/impulse.hpp"

#include <gtest/gtest.h>

#include "edmill/instances.hpp"
#include "random_physics.hpp"

namespace edmill::dynamics {
namespace {

using testing::draw;
using testing::draw_ball;
using testing::draw_direction;
using testing::draw_vector;

template <class Real>
Real tolerance() {
  return 4096 * epsilon<Real>();
}
template <class Real>
Real size(const Real& x) {
  return x < 0 ? Real(-x) : x;
}

template <class Real>
model::ContactLaw<Real> draw_law() {
  model::ContactLaw<Real> law;
  law.model =
      *rc::gen::inRange(0, 4) == 0 ? model::ContactModel::constant : model::ContactModel::walton_braun;
  law.restitution_normal = draw<Real>(Real(0), Real(1));
  law.restitution_tangential = draw<Real>(Real(-1), Real(1));
  law.friction = draw<Real>(Real(0), Real(2));
  law.min_tangential = draw<Real>(Real(-1), Real(1) / 2);
  return law;
}

/// Two balls about to collide.
template <class Real>
struct Pair {
  Vec3<Real> normal = draw_direction<Real>();
  model::BallProperties<Real> i = draw_ball<Real>(), j = draw_ball<Real>();
  Vec3<Real> vi = draw_vector<Real>(Real(5)), wi = draw_vector<Real>(Real(1000));
  Vec3<Real> vj = draw_vector<Real>(Real(5)), wj = draw_vector<Real>(Real(1000));
  model::ContactLaw<Real> law = draw_law<Real>();
  bool collapsing = *rc::gen::arbitrary<bool>();
  // After the impact:
  Vec3<Real> vi2 = vi, wi2 = wi, vj2 = vj, wj2 = wj;
  ImpactOutcome<Real> outcome;

  Pair() {
    if (dot<Real>(vi - vj, normal) > 0) normal = -normal;  // approaching
    normal = normal * (1 / norm<Real>(normal));
    outcome = collide_balls<Real>(normal, i, j, vi2, wi2, vj2, wj2, law, {.collapsing = collapsing});
  }
  Vec3<Real> contact_velocity(const Vec3<Real>& a, const Vec3<Real>& wa, const Vec3<Real>& b,
                              const Vec3<Real>& wb) const {
    const Vec3<Real> rolling = wa * i.radius + wb * j.radius;
    return a - b - cross<Real>(rolling, normal);
  }
  static Real energy(const model::BallProperties<Real>& b, const Vec3<Real>& v, const Vec3<Real>& w) {
    return b.mass / 2 * squared_norm<Real>(v) +
           b.reduced_inertia * b.mass * b.radius * b.radius / 2 * squared_norm<Real>(w);
  }
};

/// A ball about to hit a moving wall.
template <class Real>
struct WallHit {
  Vec3<Real> normal = draw_direction<Real>();
  model::BallProperties<Real> ball = draw_ball<Real>();
  Vec3<Real> v = draw_vector<Real>(Real(5)), w = draw_vector<Real>(Real(1000));
  Vec3<Real> wall = draw_vector<Real>(Real(5));
  model::ContactLaw<Real> law = draw_law<Real>();
  bool collapsing = *rc::gen::arbitrary<bool>();
  Vec3<Real> v2 = v, w2 = w;
  ImpactOutcome<Real> outcome;

  WallHit() {
    if (dot<Real>(v - wall, normal) > 0) normal = -normal;
    normal = normal * (1 / norm<Real>(normal));
    outcome = collide_with_wall<Real>(normal, ball, wall, v2, w2, law, {.collapsing = collapsing});
  }
  Vec3<Real> contact_velocity(const Vec3<Real>& a, const Vec3<Real>& wa) const {
    const Vec3<Real> rolling = wa * ball.radius;
    return a - wall - cross<Real>(rolling, normal);
  }
};

template <class Real>
class Impulse : public ::testing::Test {};
using Scalars = ::testing::Types<double, mpfr50>;
TYPED_TEST_SUITE(Impulse, Scalars);

TYPED_TEST(Impulse, BallsKeepTheirLinearMomentum) {
  using Real = TypeParam;
  EXPECT_TRUE(rc::check([] {
    const Pair<Real> p;
    const Vec3<Real> change = (p.vi2 - p.vi) * p.i.mass + (p.vj2 - p.vj) * p.j.mass;
    RC_ASSERT(norm<Real>(change) <= tolerance<Real>() * (p.i.mass + p.j.mass) * 100);
  }));
}

TYPED_TEST(Impulse, EachBallKeepsItsAngularMomentumAboutTheContactPoint) {
  using Real = TypeParam;
  EXPECT_TRUE(rc::check([] {
    const Pair<Real> p;
    const auto change = [&](const model::BallProperties<Real>& b, const Real& sign, const Vec3<Real>& dv,
                            const Vec3<Real>& dw) {
      const Vec3<Real> arm = p.normal * (sign * b.radius);  // from the contact point to the centre
      const Vec3<Real> orbital = cross<Real>(arm, Vec3<Real>(dv * b.mass));
      return norm<Real>(Vec3<Real>(orbital + dw * (b.reduced_inertia * b.mass * b.radius * b.radius))) /
             (b.mass * b.radius);
    };
    RC_ASSERT(change(p.i, Real(1), p.vi2 - p.vi, p.wi2 - p.wi) <= tolerance<Real>() * 100);
    RC_ASSERT(change(p.j, Real(-1), p.vj2 - p.vj, p.wj2 - p.wj) <= tolerance<Real>() * 100);
    const WallHit<Real> h;
    const Vec3<Real> arm = h.normal * h.ball.radius;
    const Vec3<Real> orbital = cross<Real>(arm, Vec3<Real>((h.v2 - h.v) * h.ball.mass));
    const Vec3<Real> spin =
        (h.w2 - h.w) * (h.ball.reduced_inertia * h.ball.mass * h.ball.radius * h.ball.radius);
    RC_ASSERT(norm<Real>(Vec3<Real>(orbital + spin)) <=
              tolerance<Real>() * 100 * h.ball.mass * h.ball.radius);
  }));
}

TYPED_TEST(Impulse, NormalAndTangentialContactVelocitiesFollowTheRestitutions) {
  using Real = TypeParam;
  EXPECT_TRUE(rc::check([] {
    const auto follows = [](const Vec3<Real>& before, const Vec3<Real>& after, const Vec3<Real>& n,
                            const model::Restitution<Real>& e) {
      const Real gn = dot<Real>(before, n), gn2 = dot<Real>(after, n);
      const Vec3<Real> gt = before - n * gn, gt2 = after - n * gn2;
      RC_ASSERT(size<Real>(gn2 + e.normal * gn) <= tolerance<Real>() * 100);
      RC_ASSERT(norm<Real>(Vec3<Real>(gt2 - gt * e.tangential)) <= tolerance<Real>() * 100);
    };
    const Pair<Real> p;
    follows(p.contact_velocity(p.vi, p.wi, p.vj, p.wj), p.contact_velocity(p.vi2, p.wi2, p.vj2, p.wj2),
            p.normal, p.outcome.restitution);
    RC_ASSERT(p.outcome.restitution.normal == (p.collapsing ? Real(1) : p.law.restitution_normal));
    const WallHit<Real> h;
    follows(h.contact_velocity(h.v, h.w), h.contact_velocity(h.v2, h.w2), h.normal, h.outcome.restitution);
  }));
}

TYPED_TEST(Impulse, WallWorkMinusDoseIsTheChangeOfKineticEnergy) {
  using Real = TypeParam;
  EXPECT_TRUE(rc::check([] {
    const Pair<Real> p;
    const Real before = Pair<Real>::energy(p.i, p.vi, p.wi) + Pair<Real>::energy(p.j, p.vj, p.wj);
    const Real after = Pair<Real>::energy(p.i, p.vi2, p.wi2) + Pair<Real>::energy(p.j, p.vj2, p.wj2);
    RC_ASSERT(size<Real>(after - before + p.outcome.milling_dose) <= tolerance<Real>() * (before + after));
    RC_ASSERT(p.outcome.wall_work == 0);
    const WallHit<Real> h;
    const Real start = Pair<Real>::energy(h.ball, h.v, h.w), end = Pair<Real>::energy(h.ball, h.v2, h.w2);
    RC_ASSERT(size<Real>(end - start - (h.outcome.wall_work - h.outcome.milling_dose)) <=
              tolerance<Real>() * (start + end + size<Real>(h.outcome.wall_work)));
  }));
}

TYPED_TEST(Impulse, SlidingImpulseIsFrictionTimesNormalImpulseAndStickingStopsAtTheLeastRestitution) {
  using Real = TypeParam;
  int sliding = 0, limited = 0;
  EXPECT_TRUE(rc::check([&] {
    const auto holds = [&](const ImpactOutcome<Real>& o, const model::ContactLaw<Real>& law) {
      if (law.model != model::ContactModel::walton_braun) return;
      RC_ASSERT(o.restitution.tangential >= law.min_tangential);
      RC_ASSERT(o.restitution.tangential <= 1);
      RC_ASSERT(o.tangential_impulse <= law.friction * o.normal_impulse * (1 + tolerance<Real>()));
      if (o.restitution.tangential > law.min_tangential) {
        ++sliding;
        RC_ASSERT(size<Real>(o.tangential_impulse - law.friction * o.normal_impulse) <=
                  tolerance<Real>() * (o.normal_impulse + o.tangential_impulse) * 1000);
      } else {
        ++limited;
      }
    };
    const Pair<Real> p;
    holds(p.outcome, p.law);
    const WallHit<Real> h;
    holds(h.outcome, h.law);
  }));
  // Both regimes were met, so that neither branch went untested.
  EXPECT_GT(sliding, 100);
  EXPECT_GT(limited, 100);
}

TYPED_TEST(Impulse, DoseIsNeverNegative) {
  using Real = TypeParam;
  EXPECT_TRUE(rc::check([] {
    RC_ASSERT(Pair<Real>().outcome.milling_dose >= 0);
    RC_ASSERT(WallHit<Real>().outcome.milling_dose >= 0);
  }));
}

TYPED_TEST(Impulse, AMovingFrameSeesTheSameImpact) {
  using Real = TypeParam;
  EXPECT_TRUE(rc::check([] {
    const Vec3<Real> boost = draw_vector<Real>(Real(10));
    const Pair<Real> p;
    Vec3<Real> vi = p.vi + boost, wi = p.wi, vj = p.vj + boost, wj = p.wj;
    const auto o =
        collide_balls<Real>(p.normal, p.i, p.j, vi, wi, vj, wj, p.law, {.collapsing = p.collapsing});
    RC_ASSERT(norm<Real>(Vec3<Real>(vi - boost - p.vi2)) <= tolerance<Real>() * 1000);
    RC_ASSERT(norm<Real>(Vec3<Real>(wi - p.wi2)) * p.i.radius <= tolerance<Real>() * 1000);
    RC_ASSERT(size<Real>(o.milling_dose - p.outcome.milling_dose) <= tolerance<Real>() * p.i.mass * 10000);
    const WallHit<Real> h;
    Vec3<Real> v = h.v + boost, w = h.w;
    const auto hit = collide_with_wall<Real>(h.normal, h.ball, Vec3<Real>(h.wall + boost), v, w, h.law,
                                             {.collapsing = h.collapsing});
    RC_ASSERT(norm<Real>(Vec3<Real>(v - boost - h.v2)) <= tolerance<Real>() * 1000);
    RC_ASSERT(size<Real>(hit.milling_dose - h.outcome.milling_dose) <=
              tolerance<Real>() * h.ball.mass * 10000);
  }));
}

TYPED_TEST(Impulse, ATurnedFrameSeesTheSameImpact) {
  using Real = TypeParam;
  EXPECT_TRUE(rc::check([] {
    // A rotation by Rodrigues' formula with a rational sine and cosine.
    const Vec3<Real> axis = draw_direction<Real>();
    const Real t = draw<Real>(Real(-3), Real(3));
    const Real c = (1 - t * t) / (1 + t * t), s = 2 * t / (1 + t * t);
    const auto turned = [&](const Vec3<Real>& x) {
      return Vec3<Real>(x * c + cross<Real>(axis, x) * s + axis * (dot<Real>(axis, x) * (1 - c)));
    };
    const Pair<Real> p;
    Vec3<Real> vi = turned(p.vi), wi = turned(p.wi), vj = turned(p.vj), wj = turned(p.wj);
    const auto o =
        collide_balls<Real>(turned(p.normal), p.i, p.j, vi, wi, vj, wj, p.law, {.collapsing = p.collapsing});
    RC_ASSERT(norm<Real>(Vec3<Real>(vi - turned(p.vi2))) <= tolerance<Real>() * 1000);
    RC_ASSERT(norm<Real>(Vec3<Real>(wj - turned(p.wj2))) * p.j.radius <= tolerance<Real>() * 1000);
    RC_ASSERT(size<Real>(o.milling_dose - p.outcome.milling_dose) <= tolerance<Real>() * p.i.mass * 10000);
  }));
}

TEST(ImpulseErrata, PrintedSignOfTheTangentialTermBreaksTheRestitutionLaw) {
  // (2.34) as printed has -(e_t - 1)/(1 + 1/J) g_t: the slip would grow instead of following e_t.
  const model::BallProperties<double> ball{0.005, 0.004, 0.4};
  const Vec3<double> normal(0, 1, 0), wall(0, 0, 0);
  model::ContactLaw<double> law;
  law.restitution_normal = 0.5;
  law.friction = 0.4;
  Vec3<double> v(3, -1, 0), w(0, 0, 0);
  const auto o = collide_with_wall<double>(normal, ball, wall, v, w, law);
  const double gt = 3, e_t = o.restitution.tangential;
  ASSERT_LT(e_t, 1);
  const double printed_v = 3 - (e_t - 1) / (1 + 1 / 0.4) * gt;
  EXPECT_LT(v[0], 3);       // friction slows the sliding contact
  EXPECT_GT(printed_v, 3);  // the printed sign speeds it up
  // With the spin of (2.35) the contact's slip is e_t g_t only for the corrected sign.
  const auto slip = [&](double vx) { return vx - (w[1] * 0.005 * normal[2] - w[2] * 0.005 * normal[1]); };
  EXPECT_NEAR(slip(v[0]), e_t * gt, 1e-14);
  EXPECT_GT(std::abs(slip(printed_v) - e_t * gt), 0.1);
}

TEST(ImpulseErrata, PrintedCompliancePutsTheSlidingImpulseOffForBallsOfUnequalInertia) {
  // (2.24) is printed with 1 + 1/J, right for balls of one reduced inertia; in general 1 + M/(m_i J_i) +
  // M/(m_j J_j).
  const model::BallProperties<double> i{0.004, 2e-3, 0.4}, j{0.005, 4.2e-3, 0.66};
  Vec3<double> vi(0, -1, 4), wi(0, 0, 0), vj(0, 0, 0), wj(0, 0, 0);
  model::ContactLaw<double> law;
  law.restitution_normal = 0.5;
  law.friction = 0.1;
  const auto o = collide_balls<double>(Vec3<double>(0, 1, 0), i, j, vi, wi, vj, wj, law);
  EXPECT_NEAR(o.tangential_impulse / o.normal_impulse, 0.1, 1e-15);
  const double m = i.mass * j.mass / (i.mass + j.mass);
  const double right = 1 + m / (i.mass * 0.4) + m / (j.mass * 0.66), printed = 1 + 1 / 0.4;
  EXPECT_GT(std::abs(printed / right - 1), 0.05);
}

}  // namespace
TEST(Impulse, ABallAtRestLeavesAtTheLeastSpeedThoughItsApproachIsRounding) {
  const model::BallProperties<double> ball{1, 1, 0.4};
  model::ContactLaw<double> law;
  law.restitution_normal = 0.5;
  const double least = 0x1p-20;
  for (const double approach : {0x1p-21, 0x1p-60, 0.0, -0x1p-60, -0x1p-19, 0x1p-19}) {
    Vec3<double> v{0, -approach, 0}, w{0, 0, 0};
    collide_with_wall<double>({0, 1, 0}, ball, {0, 0, 0}, v, w, law, {true, true, least});
    EXPECT_EQ(v[1], std::max(std::abs(approach), least)) << approach;
  }
}

}  // namespace edmill::dynamics
