// Claim 07 for other mills: a planetary jar, a vibrated box, a sphere and a capsule in the SPEX.
#include <cmath>
#include <sstream>

#include "core.hpp"
#include "lammps_contacts.hpp"
#include "lammps_limit.hpp"
#include "simulated.hpp"

namespace edmill::verification {
namespace {

constexpr double gravity = 9.8;

struct OtherMill {
  std::string name, mill, vessel;  ///< sections of the case
  int count;
  double diameter, restitution;  ///< [m]
  double batch;                  ///< [s], whole periods
  std::function<VesselFrame(double time)> frame;
  /// The region of LAMMPS, its sizes times a factor.
  std::function<std::vector<std::string>(double)> vial;
  bool linear = false;  ///< springs

  casefile::CaseSpec spec(double end) const {
    return casefile::parse_case("[run]\ngravity = \"9.8 m/s2\"\nend_time = \"" +
            Claim::text(end, 15) + " s\"\n[mill]\n" + mill + "[vessel]\n" + vessel +
            "[contact]\nfriction = 0.4\nrestitution = " + Claim::text(restitution) +
            "\n[[balls]]\ncount = " + std::to_string(count) + "\ndiameter = \"" +
            Claim::text(1000 * diameter) + " mm\"\n",
        name);
  }
  LammpsSetting setting(double contact_duration, bool calibrated = true) const {
    auto s = setting_of(diameter, contact_duration);
    if (linear) make_linear(s, contact_duration);
    if (calibrated) s.damping = damping_for(restitution, s);
    s.frame = frame;
    s.vial = vial(1);
    s.vessel_radius = s.vessel_half_height = 0.06;  // only the box around it all
    return s;
  }
};

std::string line(const std::vector<std::string>& words, const std::vector<double>& numbers) {
  std::ostringstream text;
  text.precision(17);
  text << words[0];
  for (const double x : numbers) text << " " << x;
  text << words[1];
  return text.str();
}

/// The disc turns with W about Y, the jar at the radius r with k W against it: the jar keeps its
/// speed, and its centre is pulled to the axis of the disc, whose direction turns against the jar.
OtherMill planetary() {
  constexpr double speed = 10 * pi, radius = 0.075, ratio = -2;
  return {"planetary jar",
      "type = \"planetary\"\nradius = \"75 mm\"\nspeed = \"300 rpm\"\nratio = -2\n",
      "diameter = \"45 mm\"\nheight = \"40 mm\"\n", 20, 0.008, 0.6, 0.6,
      [=](double time) {
        const double phi = ratio * speed * time, outward = speed * speed * radius;
        VesselFrame frame;
        frame.spin = {0, (1 + ratio) * speed, 0};
        frame.pull = {outward * std::cos(phi), -gravity, outward * std::sin(phi)};
        return frame;
      },
      [](double by) {
        return std::vector{line({"region vial cylinder y 0 0", " side in units box"},
            {0.0225 * by, -0.02 * by, 0.02 * by})};
      }};
}

/// Along a line, A sin(wt): the axes of the box are those of the room.
OtherMill vibrated_box(int balls, int rpm) {
  const double speed = rpm * pi / 30;
  return {"box at " + std::to_string(rpm) + " rpm, " + std::to_string(balls) + " balls",
      "type = \"vibratory\"\namplitude = [\"3 mm\", \"11 mm\", \"-2 mm\"]\nspeed = \"" +
          std::to_string(rpm) + " rpm\"\n",
      "type = \"box\"\nsize = [\"33 mm\", \"57 mm\", \"36 mm\"]\n", balls, 0.008, 0.6, 0.6,
      [=](double time) {
        const double a = speed * speed * std::sin(speed * time);
        VesselFrame frame;
        frame.pull = {0.003 * a, 0.011 * a - gravity, -0.002 * a};
        return frame;
      },
      [](double by) {
        return std::vector{line({"region vial block", " side in units box"},
            {-0.0165 * by, 0.0165 * by, -0.0285 * by, 0.0285 * by, -0.018 * by, 0.018 * by})};
      }};
}

OtherMill in_the_spex(std::string name, std::string vessel, double restitution, bool linear,
    std::function<std::vector<std::string>(double)> vial) {
  return {std::move(name), "type = \"spex8000\"\nspeed = \"1054 rpm\"\n", std::move(vessel), 7,
      0.00952, restitution, 9 * spex.period, [](double time) { return VesselFrame(spex, time); },
      std::move(vial), linear};
}

OtherMill spex_sphere() {
  return in_the_spex("sphere in the SPEX", "type = \"sphere\"\ndiameter = \"48 mm\"\n", 0.52, false,
      [](double by) {
        return std::vector{line({"region vial sphere 0 0 0", " side in units box"}, {0.024 * by})};
      });
}

/// LAMMPS has no capsule but the union of a cylinder and two spheres. Hertz's stiffness, which goes
/// with the curvature of the wall, jumps where they meet, and balls gain and lose energy there;
/// linear springs do not.
OtherMill spex_capsule(double restitution) {
  return in_the_spex("capsule in the SPEX, restitution " + Claim::text(restitution),
      "type = \"capsule\"\ndiameter = \"38 mm\"\nheight = \"57 mm\"\n", restitution, true,
      [](double by) {
        const double radius = 0.019 * by, half = 0.0095 * by;
        return std::vector{
            line({"region side cylinder y 0 0", " side in units box"}, {radius, -half, half}),
            line({"region left sphere 0", " side in units box"}, {-half, 0, radius}),
            line({"region right sphere 0", " side in units box"}, {half, 0, radius}),
            std::string("region vial union 3 side left right side in units box")};
      });
}

/// A state of edmill in the vessel's frame.
LammpsBall seen(const model::AnyMotion<double>& motion, const Instant<double>& when,
    const model::BallState<double>& state) {
  const auto pose = motion.pose(when);
  const auto in_vessel = motion.to_vessel_frame(pose, state.position, state.velocity);
  const Vec3<double> w = state.spin - motion.angular_velocity(pose);
  const auto &x = in_vessel.position, &v = in_vessel.velocity;
  return {{x[0], x[1], x[2]}, {v[0], v[1], v[2]},
      {edmill::dot<double>(w, motion.axis_x(pose)), edmill::dot<double>(w, motion.axis_y(pose)),
          edmill::dot<double>(w, motion.axis_z(pose))}};
}

std::vector<double> lammps_rates(const OtherMill& mill, double contact_duration, int batches) {
  auto setting = mill.setting(contact_duration);
  const auto steps = static_cast<std::int64_t>(std::ceil(mill.batch / setting.time_step));
  setting.time_step = mill.batch / static_cast<double>(steps);
  const auto built = casefile::build_case<double>(mill.spec(1));
  std::vector<LammpsBall> balls;
  for (const auto& state : built.states)
    balls.push_back(seen(built.the_case.mill.motion, built.start, state));
  LammpsMill run(setting, balls);
  std::vector<double> rates;
  double before = 0;
  for (int i = 0; i <= batches; ++i) {
    run.run(steps);
    const double dose = run.milling_dose();
    if (i > 0) rates.push_back((dose - before) / mill.batch);
    before = dose;
  }
  return rates;
}

/// The case with the contacts of LAMMPS.
casefile::InitialCase<double> with_contacts_of_lammps(
    const OtherMill& mill, const casefile::CaseSpec& spec) {
  auto initial = casefile::build_case<double>(spec);
  auto& built = initial.the_case.mill;
  LammpsSetting flat = mill.setting(brief);  // the law is measured on a cap
  flat.frame = nullptr, flat.vial.clear();
  built.ball_ball.law = law_of_contacts(flat, true),
  built.ball_wall.law = law_of_contacts(flat, false);
  return initial;
}

std::vector<double> edmill_rates(const OtherMill& mill, int batches) {
  const auto spec = mill.spec(mill.batch * (batches + 1));
  auto initial = with_contacts_of_lammps(mill, spec);
  return rates_of_run(spec, initial, mill.batch, batches);
}

/// Part of the dose from pairs of which a wall held one ball: it had an impact with a wall less
/// than 1.5 ms ago, slower than 3 cm/s. A code with contacts that last has both contacts at the
/// same time.
double share_of_held_pairs(const OtherMill& mill, double end) {
  struct Held : engine::Observer<double> {
    struct Last {
      double time = -1, speed = 1;
    };
    std::vector<Last> last;
    double dose = 0, held = 0;
    void on_impact(const engine::Impact<double>& impact, engine::Simulation<double>& s) override {
      const double now = s.seconds();
      dose += impact.outcome.milling_dose;
      const auto is_held = [&](int ball) {
        const Last& l = last.at(static_cast<std::size_t>(ball));
        return now - l.time < 1.5e-3 && l.speed < 0.03;
      };
      if (!impact.with_wall && (is_held(impact.ball) || is_held(impact.partner)))
        held += impact.outcome.milling_dose;
      if (impact.with_wall)
        last.at(static_cast<std::size_t>(impact.ball)) = {now, impact.outcome.approach_speed};
    }
  } observer;
  observer.last.resize(static_cast<std::size_t>(mill.count));
  const auto spec = mill.spec(end);
  auto initial = with_contacts_of_lammps(mill, spec);
  simulated(spec, initial, &observer);
  return observer.held / observer.dose;
}

/// A free ball in LAMMPS flies on its parabola and keeps its inertial spin, in a region fifteen
/// times as wide.
void check_coupling(const OtherMill& mill) {
  auto setting = mill.setting(50e-6, false);
  setting.vial = mill.vial(15);
  setting.vessel_radius = setting.vessel_half_height = 0.45;
  setting.time_step = 2e-6;
  const auto motion = casefile::build_mill<double>(mill.spec(1)).motion;
  const DriveClock<double> clock(motion.period());
  const Instant<double> start{0, 0.0};
  const model::BallState<double> state{
      motion.to_inertial(motion.pose(start), Vec3<double>(0.001, 0.002, -0.003)), {1, 2, 0.7},
      {30, -50, 80}};
  LammpsMill run(setting, {seen(motion, start, state)});
  double off = 0, spin_off = 0;
  for (int k = 1; k <= 10; ++k) {
    run.run(2500);
    const double t = run.time();
    auto now = state;
    const Vec3<double> fallen(0, -gravity * t, 0);
    now.position += state.velocity * t + fallen * (t / 2);
    now.velocity += fallen;
    const auto truth = seen(motion, clock.at(t), now);
    const auto ball = run.balls()[0];
    for (std::size_t i = 0; i < 3; ++i) {
      raise(off, std::abs(ball.position[i] - truth.position[i]));
      raise(spin_off, std::abs(ball.spin[i] - truth.spin[i]));
    }
  }
  claim.at_most(
      mill.name + ", free flight over 50 ms, distance from the parabola", off, 1e-6, " m");
  claim.at_most(mill.name + ", and of its spin from the constant one", spin_off, 1e-3, " rad/s");
}

TEST_F(LammpsPeer, AFreeBallFliesOnItsParabolaInOtherMills) {
  for (const auto& mill : {planetary(), vibrated_box(5, 900), spex_sphere(), spex_capsule(0.8)})
    check_coupling(mill);
}

/// Where instantaneous impacts, one after the other, and contacts at the same time may differ.
TEST_F(LammpsPeer, TheCapsuleHoldsBallsAgainstItsWall) {
  claim.at_least(
      "capsule, restitution 0.52, part of the dose from pairs with a ball held by the wall",
      share_of_held_pairs(spex_capsule(0.52), 6), 0.1);
  claim.at_most("with restitution 0.8", share_of_held_pairs(spex_capsule(0.8), 6), 0.02);
}

void agree(const OtherMill& mill, int lammps_batches, int edmill_batches, double bound = 0.01,
    double longest = 100e-6) {
  agree_in_the_limit(
      claim, mill.name, edmill_rates(mill, edmill_batches),
      [&](double duration) { return lammps_rates(mill, duration, lammps_batches); }, bound,
      longest);
}

TEST_F(LammpsPeer, LongPlanetaryJar) { agree(planetary(), 190, 1500); }
TEST_F(LammpsPeer, LongVibratedBox) { agree(vibrated_box(5, 3600), 1200, 6000); }
TEST_F(LammpsPeer, LongSphereInTheSpex) { agree(spex_sphere(), 420, 1000); }
TEST_F(LammpsPeer, LongCapsuleInTheSpex) { agree(spex_capsule(0.8), 700, 3000, 0.01, 200e-6); }
TEST_F(LammpsPeer, LongCapsuleWherePairsAreHitAgainstTheWall) {
  agree(spex_capsule(0.52), 600, 1000, 0.02);
}

}  // namespace
}  // namespace edmill::verification
