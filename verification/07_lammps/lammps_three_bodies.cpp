// A ball that lies against a wall is hit by another: LAMMPS has both contacts at one time, edmill
// one after the other. Hertz's contacts have no time of their own, so that no stiffness makes the
// two agree.
#include <Eigen/Dense>
#include <cmath>

#include "casefile/random.hpp"
#include "claim.hpp"
#include "core.hpp"
#include "lammps_contacts.hpp"
#include "lammps_limit.hpp"
#include "simulated.hpp"

namespace edmill::verification {
namespace {

constexpr double diameter = 0.0127, radius = diameter / 2, half_height = 0.0285, wide = 0.1;
constexpr double duration = 100 * brief;

/// The second ball comes at 1 m/s. Places and velocities in the vessel's frame.
struct Hit {
  Eigen::Vector3d towards;   ///< from the centre of the second ball to that of the first
  Eigen::Vector3d velocity;  ///< of the second ball
  double gap;                ///< between the first ball and the cap [m]

  std::vector<LammpsBall> balls() const {
    const Eigen::Vector3d first(0, half_height - radius - gap, 0),
        second = first - towards * (diameter + 1e-9);
    const auto triple = [](const Eigen::Vector3d& v) { return Triple{v[0], v[1], v[2]}; };
    return {{triple(first), {}, {}}, {triple(second), triple(velocity), {}}};
  }
};

Eigen::Vector3d direction(casefile::Random& random) {
  Eigen::Vector3d d;
  do
    d = Eigen::Vector3d(
        random.symmetric<double>(), random.symmetric<double>(), random.symmetric<double>());
  while (d.squaredNorm() > 1 || d.squaredNorm() < 0.01);
  return d.normalized();
}

Hit draw(casefile::Random& random, double gap) {
  Hit hit{direction(random), direction(random), gap};
  if (hit.towards[1] < 0) hit.towards *= -1;
  if (hit.velocity.dot(hit.towards) < 0) hit.velocity *= -1;
  return hit;
}

LammpsSetting setting(double restitution, double friction) {
  LammpsSetting s = setting_of(diameter, brief, friction);
  s.vessel_radius = wide;
  s.damping = damping_for(restitution, s);
  return s;
}

/// Shares of the energy that are left.
double left_by_lammps(const LammpsSetting& s, const Hit& hit) {
  LammpsMill mill(s, hit.balls());
  const double before = mill.kinetic_energy();
  mill.run(static_cast<std::int64_t>(duration / s.time_step));
  return mill.kinetic_energy() / before;
}

class HardBalls {
 public:
  explicit HardBalls(const LammpsSetting& s)
      : spec_(casefile::read_case(EDMILL_SOURCE_DIR "/docs/examples/ward.toml",
            {"balls.0.count=2", "balls.0.diameter=12.7 mm", "vessel.diameter=200 mm",
                "mill.speed=1e-6 rpm", "run.gravity=0 m/s2", "run.start_time=0 s",
                "run.end_time=" + Claim::text(duration) + " s",
                "contact.least_separation=1e-6 m/s"})),
        of_pairs_(law_of_contacts(s, true)), of_walls_(law_of_contacts(s, false)) {}

  double left(const Hit& hit) const {
    auto initial = casefile::build_case<double>(spec_);
    auto& mill = initial.the_case.mill;
    mill.ball_ball.law = of_pairs_, mill.ball_wall.law = of_walls_;
    using Motion = model::SpexMotion<double>;
    const Motion motion{0.1, pi / 12, pi / 12, 60e6};
    const auto pose = motion.pose({0, 0.0});
    const Vec3<double> none{0, 0, 0};
    const auto turned = [&](const auto& v) {
      return Vec3<double>(
          Motion::axis_x(pose) * v[0] + Motion::axis_y(pose) * v[1] + Motion::axis_z(pose) * v[2]);
    };
    const Vec3<double> centre = -turned(motion.to_vessel_frame(pose, none, none).position);
    const auto balls = hit.balls();
    for (std::size_t k = 0; k < balls.size(); ++k) {
      auto& state = initial.states[k];
      state.position = centre + turned(balls[k].position),
      state.velocity = turned(balls[k].velocity);
      state.spin = none;
    }
    struct Dose : engine::Observer<double> {
      double sum = 0;
      void on_impact(const engine::Impact<double>& impact, engine::Simulation<double>&) override {
        sum += impact.outcome.milling_dose;
      }
    } dose;
    simulated(spec_, initial, &dose);
    const double mass = 8000 * 4 / 3 * pi * std::pow(radius, 3);
    return 1 - dose.sum / (mass / 2);
  }
 private:
  casefile::CaseSpec spec_;
  model::LawOfProgram<double> of_pairs_, of_walls_;
};

/// Mean shares of the energy that are left, and the largest difference of one hit.
struct Comparison {
  double lammps = 0, edmill = 0, most = 0;
};

Comparison compare(double restitution, double friction, double gap) {
  constexpr int count = 400;
  const LammpsSetting s = setting(restitution, friction);
  const HardBalls hard(s);
  casefile::Random random(1);
  Comparison c;
  for (int k = 0; k < count; ++k) {
    const Hit hit = draw(random, gap);
    const double theirs = left_by_lammps(s, hit), ours = hard.left(hit);
    c.lammps += theirs / count, c.edmill += ours / count;
    raise(c.most, std::abs(theirs - ours));
  }
  claim.say("restitution " + Claim::text(restitution) + ", friction " + Claim::text(friction) +
      ", gap of " + Claim::text(gap * 1e6) + " um: of the energy is left in LAMMPS " +
      Claim::text(c.lammps, 4) + ", in edmill " + Claim::text(c.edmill, 4) +
      "; one hit differs by at most " + Claim::text(c.most, 2));
  return c;
}

TEST_F(LammpsPeer, LongABallThatLiesAgainstAWallIsHit) {
  // 5 um: the contacts, of 1 us, come one after the other. 10 mm: there is no wall.
  double apart = 0, least = 1;
  for (const double restitution : {0.5, 0.8})
    for (const double friction : {0.0, 0.4}) {
      for (const double gap : {0.01, 5e-6}) {
        const auto c = compare(restitution, friction, gap);
        raise(apart, std::abs(c.lammps - c.edmill));
      }
      const auto lies = compare(restitution, friction, 0);
      least = std::min(least, lies.lammps - lies.edmill);
    }
  claim.at_most(
      "mean share of the energy left after hits, contacts one after the other, most apart", apart,
      0.002);
  claim.at_least(
      "after hits of a ball that lies against the wall, the mean of LAMMPS less that of edmill",
      least, 0.01);
}

}  // namespace
}  // namespace edmill::verification
