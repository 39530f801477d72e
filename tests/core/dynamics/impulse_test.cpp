// Properties of the impact laws: (2.23'), (2.24'), (2.25), (2.28'), (2.30'), (2.31), (2.34'),
// (2.36'), (A.82). Each holds to rounding for random bodies; run in double and, to show that it is
// the formula and not the tolerance, in 50 digits.
#include "dynamics/impulse.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "core.hpp"
#include "random_physics.hpp"

namespace edmill::dynamics {
namespace {

using testing::draw;
using testing::draw_ball;
using testing::draw_direction;
using testing::draw_vector;

template <class Real> Real tolerance() { return 4096 * epsilon<Real>(); }
template <class Real> Real size(const Real& x) { return x < 0 ? Real(-x) : x; }

/// 0, below most approach speeds, or above all of them, which are below 17.4 m/s.
template <class Real> Real draw_least_separation() {
  switch (*rc::gen::inRange(0, 4)) {
    case 0: return Real(0);
    case 1: return draw<Real>(Real(20), Real(40));
    default: return draw<Real>(Real(0), Real(2));
  }
}

template <class Real> model::ContactLaw<Real> draw_law() {
  model::ContactLaw<Real> law;
  const model::CoulombSlip<Real> slip{
      draw<Real>(Real(0), Real(2)), draw<Real>(Real(-1), Real(1) / 2)};
  switch (*rc::gen::inRange(0, 8)) {
    case 0:
      law.law = model::ConstantRestitution<Real>{
          draw<Real>(Real(0), Real(1)), draw<Real>(Real(-1), Real(1))};
      break;
    case 1:
      law.law = model::RestitutionBySpeed<Real>{slip,
          {{Real(1) / 10, draw<Real>(Real(0), Real(1))}, {Real(1), draw<Real>(Real(0), Real(1))},
              {Real(5), draw<Real>(Real(0), Real(1))}}};
      break;
    case 2:
      law.law = model::Viscoelastic<Real>{
          slip, draw<Real>(Real(1000000), Real(1000000000)), draw<Real>(Real(0), Real(1) / 10000)};
      break;
    case 3:
      law.law = model::ElasticPlastic<Real>{slip, draw<Real>(Real(1000000000), Real(100000000000)),
          draw<Real>(Real(1000000), Real(1000000000))};
      break;
    case 4: law.law = model::PowderLoad<Real>{slip, draw<Real>(Real(5) / 2, Real(10))}; break;
    case 5:
      law.law = model::RestitutionBySlip<Real>{draw<Real>(Real(0), Real(1)),
          {{Real(0), draw<Real>(Real(-1), Real(1))}, {Real(1), draw<Real>(Real(-1), Real(1))},
              {Real(3), draw<Real>(Real(-1), Real(1))}}};
      break;
    default:
      law.law = model::WaltonBraun<Real>{
          draw<Real>(Real(0), Real(1)), slip.friction, slip.min_tangential};
  }
  law.least_separation = draw_least_separation<Real>();
  return law;
}

/// Friction and lowest restitution of a law that has them.
template <class Real>
std::optional<model::CoulombSlip<Real>> coulomb_of(const model::ContactLaw<Real>& law) {
  if (std::holds_alternative<model::ConstantRestitution<Real>>(law.law) ||
      std::holds_alternative<model::RestitutionBySlip<Real>>(law.law))
    return std::nullopt;
  model::CoulombSlip<Real> slip;
  law.parameters([&](const model::Parameter& p, const Real& value) {
    if (p.key == std::string("friction")) slip.friction = value;
    if (p.key == std::string("min_tangential")) slip.min_tangential = value;
  });
  return slip;
}

/// Two balls about to collide.
template <class Real> struct Pair {
  Vec3<Real> normal = draw_direction<Real>();
  model::BallProperties<Real> i = draw_ball<Real>(), j = draw_ball<Real>();
  Vec3<Real> vi = draw_vector<Real>(Real(5)), wi = draw_vector<Real>(Real(1000));
  Vec3<Real> vj = draw_vector<Real>(Real(5)), wj = draw_vector<Real>(Real(1000));
  model::ContactLaw<Real> law = draw_law<Real>();
  // After the impact:
  Vec3<Real> vi2 = vi, wi2 = wi, vj2 = vj, wj2 = wj;
  ImpactOutcome<Real> outcome;

  Pair() {
    if (dot<Real>(vi - vj, normal) > 0) normal = -normal;  // approaching
    normal = normal * (1 / norm<Real>(normal));
    outcome = collide_balls<Real>(normal, i, j, vi2, wi2, vj2, wj2, law);
  }
  Real mass() const { return i.mass * j.mass / (i.mass + j.mass); }
  /// As the impact computes them, to the last bit.
  model::ContactBodies<Real> bodies() const {
    return {i.mass * Real(j.mass / (i.mass + j.mass)), i.radius, j.radius};
  }
  Real compliance() const {
    return 1 + mass() / (i.mass * i.reduced_inertia) + mass() / (j.mass * j.reduced_inertia);
  }
  Vec3<Real> contact_velocity(
      const Vec3<Real>& a, const Vec3<Real>& wa, const Vec3<Real>& b, const Vec3<Real>& wb) const {
    const Vec3<Real> rolling = wa * i.radius + wb * j.radius;
    return a - b - cross<Real>(rolling, normal);
  }
  static Real energy(
      const model::BallProperties<Real>& b, const Vec3<Real>& v, const Vec3<Real>& w) {
    return b.mass / 2 * squared_norm<Real>(v) +
        b.reduced_inertia * b.mass * b.radius * b.radius / 2 * squared_norm<Real>(w);
  }
};

/// A ball about to hit a moving wall.
template <class Real> struct WallHit {
  Vec3<Real> normal = draw_direction<Real>();
  model::BallProperties<Real> ball = draw_ball<Real>();
  Vec3<Real> v = draw_vector<Real>(Real(5)), w = draw_vector<Real>(Real(1000));
  Vec3<Real> wall = draw_vector<Real>(Real(5));
  model::ContactLaw<Real> law = draw_law<Real>();
  Vec3<Real> v2 = v, w2 = w;
  ImpactOutcome<Real> outcome;

  WallHit() {
    if (dot<Real>(v - wall, normal) > 0) normal = -normal;
    normal = normal * (1 / norm<Real>(normal));
    outcome = collide_with_wall<Real>(normal, ball, wall, v2, w2, law);
  }
  Real compliance() const { return 1 + 1 / ball.reduced_inertia; }
  Vec3<Real> contact_velocity(const Vec3<Real>& a, const Vec3<Real>& wa) const {
    const Vec3<Real> rolling = wa * ball.radius;
    return a - wall - cross<Real>(rolling, normal);
  }
};

template <class Real> class Impulse : public ::testing::Test {};
using Scalars = ::testing::Types<double, mpfr>;
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
    const auto change = [&](const model::BallProperties<Real>& b, const Real& sign,
                            const Vec3<Real>& dv, const Vec3<Real>& dw) {
      const Vec3<Real> arm = p.normal * (sign * b.radius);  // from the contact point to the centre
      const Vec3<Real> orbital = cross<Real>(arm, Vec3<Real>(dv * b.mass));
      return norm<Real>(
                 Vec3<Real>(orbital + dw * (b.reduced_inertia * b.mass * b.radius * b.radius))) /
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

TYPED_TEST(Impulse, BodiesLeaveAtTheLargerOfRestitutionAndLeastSeparation) {
  using Real = TypeParam;
  int touched = 0, by_restitution = 0;
  EXPECT_TRUE(rc::check([&] {
    const auto follows = [&](const Vec3<Real>& before, const Vec3<Real>& after, const Vec3<Real>& n,
                             const ImpactOutcome<Real>& o, const model::ContactLaw<Real>& law,
                             const model::ContactBodies<Real>& bodies) {
      const Real gn = dot<Real>(before, n), gn2 = dot<Real>(after, n);
      RC_ASSERT(size<Real>(o.approach_speed + gn) <= tolerance<Real>() * 100);
      RC_ASSERT(size<Real>(gn2 - o.separation_speed) <= tolerance<Real>() * 100);
      // As stated in (2.23'), to the last bit.
      const Real rebound = law.restitution(o.approach_speed, bodies) * o.approach_speed;
      RC_ASSERT(
          o.separation_speed == (rebound < law.least_separation ? law.least_separation : rebound));
      RC_ASSERT(o.least_separation == (rebound < law.least_separation));
      ++(o.least_separation ? touched : by_restitution);
    };
    const Pair<Real> p;
    follows(p.contact_velocity(p.vi, p.wi, p.vj, p.wj),
        p.contact_velocity(p.vi2, p.wi2, p.vj2, p.wj2), p.normal, p.outcome, p.law, p.bodies());
    const WallHit<Real> h;
    follows(h.contact_velocity(h.v, h.w), h.contact_velocity(h.v2, h.w2), h.normal, h.outcome,
        h.law, {h.ball.mass, h.ball.radius});
  }));
  EXPECT_GT(touched, 300);
  EXPECT_GT(by_restitution, 300);
}

TYPED_TEST(Impulse, SlipIsLeftByTheLaw) {
  using Real = TypeParam;
  EXPECT_TRUE(rc::check([] {
    const auto follows = [](const Vec3<Real>& before, const Vec3<Real>& after, const Vec3<Real>& n,
                             const Real& compliance, const ImpactOutcome<Real>& o,
                             const model::ContactLaw<Real>& law) {
      const Real gn = dot<Real>(before, n), gn2 = dot<Real>(after, n);
      const Vec3<Real> gt = before - n * gn, gt2 = after - n * gn2;
      RC_ASSERT(
          norm<Real>(Vec3<Real>(gt2 - gt * o.restitution_tangential)) <= tolerance<Real>() * 100);
      const Real slip = norm<Real>(gt);
      RC_PRE(slip > Real(1) / 1000);
      Real e_t;
      if (const auto coulomb = coulomb_of(law)) {  // (2.24')
        e_t = 1 - coulomb->friction * compliance * (gn2 - gn) / slip;
        if (e_t < coulomb->min_tangential) e_t = coulomb->min_tangential;
      } else if (const auto* by_slip = std::get_if<model::RestitutionBySlip<Real>>(&law.law)) {
        const Real change = gn2 - gn, sliding = slip * (1 + by_slip->normal);
        RC_PRE(change > Real(1) / 1000);
        const Real ratio = sliding / change;  // points at 0, 1 and 3
        const auto& p = by_slip->points;
        e_t = ratio < 1 ? Real(p[0][1] + (p[1][1] - p[0][1]) * ratio)
            : ratio < 3 ? Real(p[1][1] + (p[2][1] - p[1][1]) * (ratio - 1) / 2)
                        : Real(1 - (1 - p[2][1]) * 3 / ratio);
      } else {
        e_t = std::get<model::ConstantRestitution<Real>>(law.law).tangential;
      }
      RC_ASSERT(size<Real>(o.restitution_tangential - e_t) <= tolerance<Real>() * 1000 / slip);
    };
    const Pair<Real> p;
    follows(p.contact_velocity(p.vi, p.wi, p.vj, p.wj),
        p.contact_velocity(p.vi2, p.wi2, p.vj2, p.wj2), p.normal, p.compliance(), p.outcome, p.law);
    const WallHit<Real> h;
    follows(h.contact_velocity(h.v, h.w), h.contact_velocity(h.v2, h.w2), h.normal, h.compliance(),
        h.outcome, h.law);
  }));
}

TYPED_TEST(Impulse, WallWorkMinusDosePlusSuppliedEnergyIsTheChangeOfKineticEnergy) {
  using Real = TypeParam;
  int supplied = 0;
  EXPECT_TRUE(rc::check([&] {
    const Pair<Real> p;
    const Real before = Pair<Real>::energy(p.i, p.vi, p.wi) + Pair<Real>::energy(p.j, p.vj, p.wj);
    const Real after =
        Pair<Real>::energy(p.i, p.vi2, p.wi2) + Pair<Real>::energy(p.j, p.vj2, p.wj2);
    RC_ASSERT(size<Real>(after - before + p.outcome.milling_dose - p.outcome.supplied_energy) <=
        tolerance<Real>() * (before + after));
    RC_ASSERT(p.outcome.wall_work == 0);
    const WallHit<Real> h;
    const auto& o = h.outcome;
    const Real start = Pair<Real>::energy(h.ball, h.v, h.w),
               end = Pair<Real>::energy(h.ball, h.v2, h.w2);
    RC_ASSERT(size<Real>(end - start - (o.wall_work - o.milling_dose + o.supplied_energy)) <=
        tolerance<Real>() * (start + end + size<Real>(o.wall_work)));
    supplied += (p.outcome.supplied_energy > 0) + (o.supplied_energy > 0);
  }));
  EXPECT_GT(supplied, 200);
}

TYPED_TEST(Impulse, TheNormalPartIsEitherGivenUpOrSupplied) {
  using Real = TypeParam;
  EXPECT_TRUE(rc::check([] {
    const auto holds = [](const ImpactOutcome<Real>& o, const Real& mass) {
      const Real a = o.approach_speed, s = o.separation_speed;
      const Real lost = mass / 2 * (a * a - s * s);
      RC_ASSERT(size<Real>(o.normal_dose - o.supplied_energy - lost) <=
          tolerance<Real>() * mass * (a * a + s * s));
      RC_ASSERT(o.normal_dose >= 0);
      RC_ASSERT(o.milling_dose >= o.normal_dose);
      RC_ASSERT(o.supplied_energy >= 0);
      RC_ASSERT(o.normal_dose == 0 || o.supplied_energy == 0);
      RC_ASSERT((o.supplied_energy > 0) == (s > a));
      RC_ASSERT(o.least_separation || o.supplied_energy == 0);
    };
    const Pair<Real> p;
    holds(p.outcome, p.mass());
    const WallHit<Real> h;
    holds(h.outcome, h.ball.mass);
  }));
}

TYPED_TEST(
    Impulse, SlidingImpulseIsFrictionTimesNormalImpulseAndStickingStopsAtTheLeastRestitution) {
  using Real = TypeParam;
  int sliding = 0, limited = 0, touched_sliding = 0, touched_limited = 0;
  EXPECT_TRUE(rc::check([&] {
    const auto holds = [&](const ImpactOutcome<Real>& o, const model::ContactLaw<Real>& law,
                           const Real& mass) {
      RC_ASSERT(size<Real>(o.normal_impulse - mass * (o.approach_speed + o.separation_speed)) <=
          tolerance<Real>() * o.normal_impulse);
      const auto coulomb = coulomb_of(law);
      if (!coulomb) return;
      RC_ASSERT(o.restitution_tangential >= coulomb->min_tangential);
      RC_ASSERT(o.restitution_tangential <= 1);
      RC_ASSERT(
          o.tangential_impulse <= coulomb->friction * o.normal_impulse * (1 + tolerance<Real>()));
      if (o.restitution_tangential > coulomb->min_tangential) {
        ++(o.least_separation ? touched_sliding : sliding);
        RC_ASSERT(size<Real>(o.tangential_impulse - coulomb->friction * o.normal_impulse) <=
            tolerance<Real>() * (o.normal_impulse + o.tangential_impulse) * 1000);
      } else {
        ++(o.least_separation ? touched_limited : limited);
      }
    };
    const Pair<Real> p;
    holds(p.outcome, p.law, p.mass());
    const WallHit<Real> h;
    holds(h.outcome, h.law, h.ball.mass);
  }));
  // Both regimes occur, with and without the least separation speed: every branch is tested.
  for (const int met : {sliding, limited, touched_sliding, touched_limited}) EXPECT_GT(met, 50);
}

TYPED_TEST(Impulse, AMovingFrameSeesTheSameImpact) {
  using Real = TypeParam;
  EXPECT_TRUE(rc::check([] {
    const Vec3<Real> boost = draw_vector<Real>(Real(10));
    const Pair<Real> p;
    Vec3<Real> vi = p.vi + boost, wi = p.wi, vj = p.vj + boost, wj = p.wj;
    const auto o = collide_balls<Real>(p.normal, p.i, p.j, vi, wi, vj, wj, p.law);
    RC_ASSERT(norm<Real>(Vec3<Real>(vi - boost - p.vi2)) <= tolerance<Real>() * 1000);
    RC_ASSERT(norm<Real>(Vec3<Real>(wi - p.wi2)) * p.i.radius <= tolerance<Real>() * 1000);
    RC_ASSERT(size<Real>(o.milling_dose - p.outcome.milling_dose) <=
        tolerance<Real>() * p.i.mass * 10000);
    const WallHit<Real> h;
    Vec3<Real> v = h.v + boost, w = h.w;
    const auto hit =
        collide_with_wall<Real>(h.normal, h.ball, Vec3<Real>(h.wall + boost), v, w, h.law);
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
    const auto o = collide_balls<Real>(turned(p.normal), p.i, p.j, vi, wi, vj, wj, p.law);
    RC_ASSERT(norm<Real>(Vec3<Real>(vi - turned(p.vi2))) <= tolerance<Real>() * 1000);
    RC_ASSERT(norm<Real>(Vec3<Real>(wj - turned(p.wj2))) * p.j.radius <= tolerance<Real>() * 1000);
    RC_ASSERT(size<Real>(o.milling_dose - p.outcome.milling_dose) <=
        tolerance<Real>() * p.i.mass * 10000);
  }));
}

}  // namespace
}  // namespace edmill::dynamics
