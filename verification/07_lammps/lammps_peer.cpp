// Claim 07: LAMMPS, an independent soft-sphere code, gives the milling dose rates of the Ward
// cases.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "claim.hpp"
#include "core.hpp"
#include "lammps_contacts.hpp"
#include "lammps_limit.hpp"

namespace edmill::verification {
namespace {

constexpr int batch_periods = 9;  ///< half a second

/// The case's balls at rest against the inertial frame, placed as edmill places them.
std::vector<LammpsBall> balls_of(const casefile::CaseSpec& spec) {
  const auto built = casefile::build_case<double>(spec);
  const auto& motion = built.the_case.mill.motion;
  const auto pose = motion.pose({0, 0.0});
  const Triple spin = VesselFrame(spex, 0).spin;
  std::vector<LammpsBall> balls;
  for (const auto& state : built.states) {
    const auto seen = motion.to_vessel_frame(pose, state.position, state.velocity);
    const auto &x = seen.position, &v = seen.velocity;
    balls.push_back({{x[0], x[1], x[2]}, {v[0], v[1], v[2]}, {-spin[0], -spin[1], -spin[2]}});
  }
  return balls;
}

struct WardCase {
  int count;
  double diameter;  ///< [mm]
  double restitution;
  double friction = 0.4;
  /// What holds the surfaces in LAMMPS: Mindlin's springs, or a damper alone, with which contacts
  /// that stick have e_t = 0.
  enum class Along { springs, damper } along = Along::springs;

  LammpsSetting setting(double contact_duration) const {
    LammpsSetting s = setting_of(diameter * 1e-3, contact_duration, friction);
    if (along == Along::damper) s.without_springs = true, s.tangential_damping = 8;
    s.damping = damping_for(restitution, s);
    return s;
  }
  casefile::CaseSpec spec(const std::vector<std::string>& more) const {
    std::vector<std::string> changes{"balls.0.count=" + std::to_string(count),
        "balls.0.diameter=" + Claim::text(diameter) + " mm",
        "contact.restitution=" + Claim::text(restitution),
        "contact.friction=" + Claim::text(friction)};
    changes.insert(changes.end(), more.begin(), more.end());
    return casefile::read_case(EDMILL_SOURCE_DIR "/docs/examples/ward.toml", changes);
  }
  std::string name() const { return std::to_string(count) + " x " + Claim::text(diameter) + " mm"; }
};

/// Dose rates of batches of half a second each [W], the first left out.
std::vector<double> lammps_rates(
    const WardCase& ward, double contact_duration, int batches, bool calibrated = true) {
  LammpsSetting s = ward.setting(contact_duration);
  if (!calibrated) s.damping = ward.restitution;
  s.motion = spex;
  const auto steps = static_cast<std::int64_t>(std::ceil(spex.period / s.time_step));
  s.time_step = spex.period / static_cast<double>(steps);
  LammpsMill mill(s, balls_of(ward.spec({})));
  std::vector<double> rates;
  double before = 0;
  for (int i = 0; i <= batches; ++i) {
    mill.run(batch_periods * steps);
    const double dose = mill.milling_dose();
    if (i > 0) rates.push_back((dose - before) / (batch_periods * spex.period));
    before = dose;
  }
  return rates;
}

enum class Slip { as_lammps, walton_braun };

/// With the case's least separation speed, 1 cm/s.
/// @param slip     what contacts leave of a slip
/// @param periods  of the drive in a batch
std::vector<double> edmill_rates(
    const WardCase& ward, int batches, Slip slip = Slip::as_lammps, int periods = batch_periods) {
  const double batch = periods * spex.period;
  const auto spec = ward.spec(
      {"run.start_time=0 s", "run.end_time=" + Claim::text(batch * (batches + 1), 15) + " s"});
  auto initial = casefile::build_case<double>(spec);
  if (slip == Slip::as_lammps) {
    const LammpsSetting s = ward.setting(brief);
    auto& mill = initial.the_case.mill;
    mill.ball_ball.law = law_of_contacts(s, true), mill.ball_wall.law = law_of_contacts(s, false);
  }
  return rates_of_run(spec, initial, batch, batches);
}

void agree(const WardCase& ward, int lammps_batches, int edmill_batches, double bound = 0.03,
    double contact_duration = 50e-6) {
  const auto lammps = lammps_rates(ward, contact_duration, lammps_batches);
  const auto edmill = edmill_rates(ward, edmill_batches);
  const auto [r, half] = ratio(lammps, edmill);
  claim.say(ward.name() + ", inverse dose rate: LAMMPS " + inverse(lammps) + ", edmill " +
      inverse(edmill));
  claim.at_most(ward.name() + ", LAMMPS over edmill " + Claim::text(r, 4) + " +- " +
          Claim::text(half, 2) + ", off one",
      std::abs(r - 1), bound);
  claim.at_most(ward.name() + ", half of the interval", half, bound / 2);
}

/// Fictitious forces and torques: a free ball in LAMMPS flies on its parabola and keeps its
/// inertial spin.
TEST_F(LammpsPeer, AFreeBallFliesOnItsParabola) {
  LammpsSetting s = setting_of(0.00476, 50e-6);
  s.motion = spex;
  s.vessel_radius = s.vessel_half_height = 0.2;
  const int steps = 50000;
  s.time_step = spex.period / steps;
  const model::SpexMotion<double> motion{spex.arm, spex.theta_max, spex.gamma_max, spex.period};
  Vec3<double> r{0.01, 0.09, 0.02}, v{1, -0.5, 0.7}, spin{30, -50, 80};
  const auto pose = motion.pose({0, 0.0});
  const auto seen = motion.to_vessel_frame(pose, r, v);
  const auto in_vessel = [](const auto& p, const Vec3<double>& w) {
    const Vec3<double> d = w - model::SpexMotion<double>::angular_velocity(p);
    return Triple{d.dot(model::SpexMotion<double>::axis_x(p)),
        d.dot(model::SpexMotion<double>::axis_y(p)), d.dot(model::SpexMotion<double>::axis_z(p))};
  };
  const auto &x = seen.position, &u = seen.velocity;
  LammpsMill mill(s, {{{x[0], x[1], x[2]}, {u[0], u[1], u[2]}, in_vessel(pose, spin)}});
  double off = 0, spin_off = 0;
  for (int k = 1; k <= 10; ++k) {
    mill.run(steps / 10);
    const double t = mill.time();
    const auto now = motion.pose({0, t});
    const Vec3<double> fallen{0, -spex.gravity * t, 0};
    const Vec3<double> there = r + v * t + fallen * (t / 2), speed = v + fallen;
    const auto truth = motion.to_vessel_frame(now, there, speed);
    const Triple turning = in_vessel(now, spin);
    const LammpsBall ball = mill.balls()[0];
    for (int i = 0; i < 3; ++i) {
      raise(off, std::abs(ball.position[i] - truth.position[i]));
      raise(spin_off, std::abs(ball.spin[i] - turning[i]));
    }
  }
  claim.at_most(
      "free flight over a drive period, largest distance from the parabola", off, 1e-6, " m");
  claim.at_most("and of its spin from the constant one of 99 rad/s", spin_off, 1e-3, " rad/s");
}

/// Elastic smooth balls lose nothing: what the fictitious forces do is all kinetic energy.
TEST_F(LammpsPeer, ElasticBallsLoseNothing) {
  LammpsSetting s = setting_of(0.00952, 50e-6, 0);
  s.motion = spex;
  s.damping = 1;
  const WardCase ward{7, 9.52, 0.52};
  LammpsMill mill(s, balls_of(ward.spec({})));
  double least = 1;
  for (int i = 0; i < 20; ++i) {
    mill.run(static_cast<std::int64_t>(0.01 / s.time_step));
    // Contacts that last store energy, so the least tells.
    if (i >= 10) least = std::min(least, mill.milling_dose() / mill.kinetic_energy());
  }
  claim.at_most(
      "7 elastic smooth balls in 0.2 s: least of ten values of the energy lost over the kinetic",
      std::abs(least), 2e-3);
}

TEST_F(LammpsPeer, TsujiDampingNeedsCalibration) {
  LammpsSetting s = setting_of(0.00952, 50e-6);
  s.damping = 0.52;
  const double raw = rebound(s, false, 1);
  claim.at_least("restitution of a ball when `damping tsuji` is asked for 0.52", raw, 0.6);
  double worst = 0;
  for (const auto& ward :
      {WardCase{7, 9.52, 0.52}, {28, 4.76, 0.53}, {95, 3.16, 0.54}, {227, 2.36, 0.56}}) {
    LammpsSetting t = setting_of(ward.diameter * 1e-3, 50e-6);
    t.damping = damping_for(ward.restitution, t);
    for (const bool pair : {false, true})
      for (const double speed : {0.3, 1.0, 3.0})
        raise(worst, std::abs(rebound(t, pair, speed) - ward.restitution));
  }
  claim.at_most("after calibration, four cases, wall and pair, 0.3 to 3 m/s: worst restitution off",
      worst, 3e-3);
}

/// Gross sliding of a ball on a cap: the tangential impulse over the normal one.
TEST_F(LammpsPeer, SlidingFrictionIsCoulombs) {
  const auto share = [](double tangential_damping, double slip) {
    LammpsSetting s = setting_of(0.00952, 50e-6);
    s.damping = damping_for(0.52, s);
    s.tangential_damping = tangential_damping;
    s.time_step /= 8;
    const double start = 1e-6;
    const Triple before{slip, 1, 0};
    LammpsMill mill(s, {{{0, s.vessel_half_height - s.ball_diameter / 2 - start, 0}, before, {}}});
    mill.run(static_cast<std::int64_t>(200e-6 / s.time_step));
    const Triple after = mill.balls()[0].velocity;
    return (before[0] - after[0]) / (before[1] - after[1]);
  };
  double worst = 0;
  for (const double slip : {3.0, 4.0, 8.0}) raise(worst, std::abs(share(0, slip) / 0.4 - 1));
  claim.at_most(
      "tangential over normal impulse at slips of 3, 4, 8 m/s, worst relative distance from mu 0.4",
      worst, 0.03);
  claim.at_least("the same at 8 m/s with LAMMPS's default tangential damping",
      std::abs(share(1, 8) / 0.4 - 1), 0.1);
}

/// Where the two differ: between sticking and sliding a Mindlin contact slips in part and loses
/// energy, while Walton and Braun's law turns from -1 to sliding at once.
TEST_F(LammpsPeer, TangentialLawsDifferBetweenStickingAndSliding) {
  LammpsSetting s = setting_of(0.00952, brief);
  s.damping = damping_for(0.52, s);
  const model::ContactLaw<double> law{model::WaltonBraun<double>{0.52, 0.4, -1}, 0};
  double sticking = 0, sliding = 0, between = 1, pairs = 0;
  for (const double slip : {0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 8.0}) {
    const double theirs = impact(s, false, 1, slip).tangential,
                 of_pair = impact(s, true, 1, slip).tangential;
    const double ours = law.restitution_of_slip(1.0 + law.separation_speed(1.0, {1, 1}), slip, 3.5);
    claim.say("e_t at a slip of " + Claim::text(slip) + " per approach: LAMMPS " +
        Claim::text(theirs) + " of walls and " + Claim::text(of_pair) + " of pairs, edmill " +
        Claim::text(ours));
    raise(pairs, std::abs(of_pair - theirs));
    if (slip <= 0.75) raise(sticking, std::abs(theirs - ours));
    if (slip >= 2.5) raise(sliding, std::abs(theirs - ours));
    if (slip >= 1 && slip <= 1.5) between = std::min(between, theirs - ours);
  }
  claim.at_most("e_t of sticking contacts, largest difference", sticking, 0.06);
  claim.at_most("e_t of sliding contacts, largest difference", sliding, 0.03);
  claim.at_least("e_t between them, least difference", between, 0.05);
  claim.at_least("e_t of pairs and of walls in LAMMPS, largest difference", pairs, 0.5);
}

/// Short, so with a wider bound; the long one follows.
TEST_F(LammpsPeer, SevenBalls) { agree({7, 9.52, 0.52}, 8, 30, 0.05); }

TEST(LammpsLine, FindsALineAndItsInterval) {
  const std::vector<double> x{1, 2, 4}, y{5, 7, 11};
  const auto [exact_value, unequal] = at_zero(x, y, {0.1, 0.2, 0.1});
  EXPECT_NEAR(exact_value, 3, 1e-13);
  // Equal errors: variance 1/3 + (7/3)^2 / (14/3) = 3/2 at zero.
  EXPECT_NEAR(at_zero(x, y, {0.1, 0.1, 0.1}).second, 0.1 * std::sqrt(1.5), 1e-15);
  EXPECT_GT(unequal, 0.1 * std::sqrt(1.5));
}

void agree_in_the_limit(const WardCase& ward, int lammps_batches, int edmill_batches) {
  agree_in_the_limit(claim, ward.name(), edmill_rates(ward, edmill_batches),
      [&](double duration) { return lammps_rates(ward, duration, lammps_batches); });
}

TEST_F(LammpsPeer, Long7Balls) { agree_in_the_limit({7, 9.52, 0.52}, 60, 300); }
/// Wedges of large balls, where edmill's friction rests in stalls and LAMMPS has no such rule.
TEST_F(LammpsPeer, Long10LargeBalls) { agree_in_the_limit({10, 12.7, 0.5}, 120, 400); }
/// Bouncier balls have few contacts that last, and the two agree.
TEST_F(LammpsPeer, Long10LargeBouncyBalls) { agree_in_the_limit({10, 12.7, 0.8}, 240, 800); }
/// What holds surfaces together makes no difference: a damper in the place of springs.
TEST_F(LammpsPeer, Long10LargeBallsWithDampers) {
  agree({10, 12.7, 0.5, 0.4, WardCase::Along::damper}, 60, 300, 0.05, 25e-6);
}
TEST_F(LammpsPeer, Long10LargeSmoothBalls) { agree({10, 12.7, 0.5, 0}, 60, 300, 0.05, 25e-6); }
TEST_F(LammpsPeer, Long80Balls) {
  agree({80, 6.35, 0.5, 0.4, WardCase::Along::damper}, 12, 40, 0.01, 50e-6);
}
/// One ball alone may settle on one of several periodic motions, of other dose rates; four do not.
TEST_F(LammpsPeer, LongOneLargeBall) {
  agree({1, 12.7, 0.8}, 80, 2000, 0.12, 25e-6);
  agree({1, 12.7, 0.8, 0.4, WardCase::Along::damper}, 40, 1000, 0.05, 25e-6);
  agree({1, 12.7, 0.8, 0}, 40, 1000, 0.05, 25e-6);
  agree({4, 12.7, 0.8}, 40, 600, 0.03, 25e-6);
}
TEST_F(LammpsPeer, Long10BallsOf9Mm) { agree({10, 9.52, 0.5}, 60, 300, 0.01, 25e-6); }
/// The less they fill of the vial, the nearer are the two.
TEST_F(LammpsPeer, Long10BallsOf12Mm) { agree({10, 12, 0.5}, 60, 300, 0.02, 25e-6); }
TEST_F(LammpsPeer, Long10BallsOf11Mm) { agree({10, 11, 0.5}, 60, 300, 0.02, 25e-6); }
/// Whether three balls in a row hold each other between opposite sides of the cylinder.
bool has_bridge(const std::vector<LammpsBall>& balls, double radius, double cylinder) {
  constexpr double touching = 5e-5;
  const auto apart = [](const LammpsBall& a, const LammpsBall& b) {
    return Eigen::Vector3d(Eigen::Map<const Eigen::Vector3d>(b.position.data()) -
        Eigen::Map<const Eigen::Vector3d>(a.position.data()));
  };
  const auto at_cylinder = [&](const LammpsBall& b) {
    return cylinder - radius - std::hypot(b.position[0], b.position[2]) < touching;
  };
  for (const auto& middle : balls)
    for (const auto& one : balls)
      for (const auto& two : balls) {
        if (&one == &middle || &two == &middle || &one == &two || !at_cylinder(one) ||
            !at_cylinder(two))
          continue;
        const auto first = apart(one, middle), second = apart(middle, two);
        if (std::abs(first.norm() - 2 * radius) < touching &&
            std::abs(second.norm() - 2 * radius) < touching &&
            first.dot(second) > 0.9 * first.norm() * second.norm())
          return true;
      }
  return false;
}

/// Three of them are longer than the vial is wide, but bridges are not why LAMMPS has less: drive
/// periods that end with one have no less dose than others, and all quantiles of the periods are
/// shifted alike.
TEST_F(LammpsPeer, Long10LargeBallsAreNotHeldByBridges) {
  constexpr int periods = 530, first = 10;
  const WardCase ward{10, 12.7, 0.5, 0.4, WardCase::Along::damper};
  LammpsSetting s = ward.setting(25e-6);
  s.motion = spex;
  const auto steps = static_cast<std::int64_t>(std::ceil(spex.period / s.time_step));
  s.time_step = spex.period / static_cast<double>(steps);
  LammpsMill mill(s, balls_of(ward.spec({})));
  std::vector<double> all, with_bridge, without;
  double before = 0;
  for (int i = 0; i < first + periods; ++i) {
    mill.run(steps);
    const double rate = (mill.milling_dose() - before) / spex.period;
    before = mill.milling_dose();
    if (i < first) continue;
    all.push_back(rate);
    const bool bridge = has_bridge(mill.balls(), s.ball_diameter / 2, s.vessel_radius);
    (bridge ? with_bridge : without).push_back(rate);
  }
  const double bridged = *numerics::estimate(with_bridge).mean / *numerics::estimate(without).mean;
  claim.say(std::to_string(with_bridge.size()) + " of " + std::to_string(periods) +
      " periods of LAMMPS end with a bridge");
  claim.at_least("their dose rate over that of the others", bridged, 0.95);
  auto edmill = edmill_rates(ward, 300, Slip::as_lammps, 1);
  const auto quantile = [](std::vector<double>& rates, double share) {
    std::sort(rates.begin(), rates.end());
    return rates[static_cast<std::size_t>(share * static_cast<double>(rates.size() - 1))];
  };
  for (const double share : {0.1, 0.5, 0.9}) {
    const double r = quantile(all, share) / quantile(edmill, share);
    claim.at_most("quantile " + Claim::text(share) + " of the periods, LAMMPS over edmill " +
            Claim::text(r, 3) + ", off 0.965",
        std::abs(r - 0.965), 0.02);
  }
}
TEST_F(LammpsPeer, Long28Balls) { agree_in_the_limit({28, 4.76, 0.53}, 24, 100); }
TEST_F(LammpsPeer, Long95Balls) { agree_in_the_limit({95, 3.16, 0.54}, 10, 40); }
TEST_F(LammpsPeer, Long227Balls) { agree_in_the_limit({227, 2.36, 0.56}, 6, 20); }

/// What the difference of the tangential laws makes of the dose rate: as much as LAMMPS's rate is
/// above that by Walton and Braun, 1.1 +- 0.4 %.
TEST_F(LammpsPeer, LongLawsOfSlipChangeTheDoseRate) {
  const WardCase ward{7, 9.52, 0.52};
  const auto [r, half] =
      ratio(edmill_rates(ward, 2000), edmill_rates(ward, 2000, Slip::walton_braun));
  claim.say(ward.name() + ", dose rate with e_t of LAMMPS over that by Walton and Braun " +
      Claim::text(r, 4) + " +- " + Claim::text(half, 2));
  claim.at_least("what it has more", r - 1, 0.007);
  claim.at_most("and no more than", r - 1, 0.015);
}

/// The comparison can fail: with LAMMPS's damping taken at its word, so that balls rebound with
/// 0.64, it does.
TEST_F(LammpsPeer, LongUncalibratedDampingIsSeen) {
  const WardCase ward{28, 4.76, 0.53};
  const auto [r, half] = ratio(lammps_rates(ward, 50e-6, 8, false), edmill_rates(ward, 60));
  claim.at_least(ward.name() + ", damping not calibrated: LAMMPS over edmill " + Claim::text(r, 4) +
          " +- " + Claim::text(half, 2) + ", off one",
      std::abs(r - 1), 0.03);
}

}  // namespace
}  // namespace edmill::verification
