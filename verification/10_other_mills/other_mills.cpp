// Claim 10: closed forms of mills and vessels other than the SPEX with its cylinder.
#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "claim.hpp"
#include "event_recorder.hpp"
#include "instances/instances.hpp"

namespace edmill::verification {
namespace {

const Claim other_mills("10 other mills");

std::string vector_text(double x, double y, double z, const char* unit) {
  return fmt::format("[\"{:.17g} {}\", \"{:.17g} {}\", \"{:.17g} {}\"]\n", x, unit, y, unit, z, unit);
}

/// The drum of radius 0.2 m with a ball of radius 0.02 m at its bottom, or anywhere.
constexpr double radius = 0.2, ball = 0.02, orbit = radius - ball, g = 9.81;

std::string drum_case(double w, double gravity, double v_s, double friction, double height, double speed,
                      double spin) {
  return fmt::format(
      "[run]\nend_time = \"1000 s\"\ngravity = \"{} m/s2\"\n[mill]\ntype = \"drum\"\nspeed = \"{:.17g} "
      "rad/s\"\n"
      "[vessel]\ndiameter = \"0.4 m\"\nheight = \"0.4 m\"\n[contact]\nrestitution = 0.5\nfriction = {}\n"
      "least_separation = \"{} m/s\"\n[[ball]]\ndiameter = \"0.04 m\"\nposition = {}velocity = {}spin = {}",
      gravity, w, friction, v_s, vector_text(0, height, 0, "m"), vector_text(speed, 0, 0, "m/s"),
      vector_text(0, 0, spin, "rad/s"));
}

/// Ends a run at the first flight that is much longer than a hop.
class Detachment : public engine::Observer<double> {
 public:
  explicit Detachment(double longest) : longest_(longest) {}
  void on_impact(const engine::Impact<double>& impact, engine::Simulation<double>& simulation) override {
    ++impacts;
    if (impacts > 1 && impact.flight_time[0] > longest_)
      return simulation.request_stop(engine::EndReason::stopped);
    place = simulation.state_at(0, impact.time).position;
  }
  long impacts = 0;
  Vec3<double> place;  ///< of the last impact before [m]

 private:
  double longest_;
};

/// A ball that rolls up a drum. Rolling on a wall of constant speed, its energy per mass is 7/10 (orbit
/// psi')^2 + g orbit (1 - cos psi), so with A = orbit psi'^2 at the bottom the wall's force vanishes where
/// cos psi = (10 - 7 A/g) / 17.
double detachment(double v_s) {
  constexpr double w = 9.4247779607693793, a_over_g = 2.4;
  const double speed = std::sqrt(a_over_g * g * orbit), spin = (w * radius - speed) / ball;
  const auto spec = casefile::parse_case(
      drum_case(w, g, v_s, 1000, -orbit + v_s * v_s / (4 * g), speed, spin), "drum.toml");
  const auto built = casefile::build_case<double>(spec);
  engine::Simulation<double> simulation(built.the_case, built.states, built.start);
  Detachment watch(0.02);
  simulation.attach(watch);
  simulation.run_until(simulation.clock().at(2.0));
  return std::acos(-watch.place[1] / std::hypot(watch.place[0], watch.place[1]));
}

TEST(OtherMills, ABallRollsUpADrumAndDetachesAtTheAngleOfTheClosedForm) {
  const double expected = std::acos((10 - 7 * 2.4) / 17);
  double before = 0, error = 0;
  for (const double v_s : {1e-3, 1e-4, 1e-5, 1e-6}) {
    before = error;
    error = std::abs(detachment(v_s) - expected);
    other_mills.say("detachment at " + Claim::text(180 / M_PI * expected, 6) + " deg, v_s " +
                    Claim::text(v_s) + " m/s: off by " + Claim::text(180 / M_PI * error) + " deg");
  }
  // The last hop begins half of its own length before the place where it would have no end.
  other_mills.at_least("detachment, order in v_s", std::log10(before / error), 0.4);
  other_mills.at_most("detachment, error at 1e-6 m/s", 180 / M_PI * error, 0.1, " deg");
}

/// Without gravity a ball that turns with the drum stays where it is in the vessel.
TEST(OtherMills, SolidBodyRotationStays) {
  constexpr double w = 20, v_s = 1e-4;
  const auto spec = casefile::parse_case(drum_case(w, 0, v_s, 0.4, -orbit, w * orbit, w), "drum.toml");
  const auto built = casefile::build_case<double>(spec);
  engine::Simulation<double> simulation(built.the_case, built.states, built.start);
  const auto& motion = built.the_case.mill.motion;
  double away = 0, turning = 0;
  for (int k = 0; k <= 100; ++k) {
    const auto when = simulation.clock().at(0.02 * k);
    simulation.run_until(when);
    const auto state = simulation.state_at(0, when);
    const auto place = motion.position_in_vessel(motion.pose(when), state.position);
    const auto first = motion.position_in_vessel(motion.pose(built.start), built.states[0].position);
    raise(away, norm<double>(Vec3<double>(place - first)));
    raise(turning, norm<double>(Vec3<double>(state.spin - Vec3<double>(0, 0, w))) / w);
  }
  // A hop of v_s lasts 2 v_s / (w^2 orbit) and is v_s^2 / (2 w^2 orbit) high.
  const double height = v_s * v_s / (2 * w * w * orbit);
  other_mills.say("solid-body rotation: hops are " + Claim::text(height) + " m high");
  other_mills.at_most("solid-body rotation, way in the vessel over 6 turns", away, 1e-5, " m");
  other_mills.at_most("solid-body rotation, spin off by", turning, 1e-6);
}

/// A capsule as high as wide is a sphere.
TEST(OtherMills, ASphereAndACapsuleOfItsRadiusGiveTheSameRun) {
  const auto events = [](const std::string& vessel) {
    const auto spec = casefile::parse_case(
        "[run]\nmax_collisions = 60\ngravity = \"9.81 m/s2\"\n[mill]\ntype = \"spex8000\"\n[vessel]\n" +
            vessel +
            "[contact]\nrestitution = 0.9\nfriction = 0.3\n[[balls]]\ncount = 3\ndiameter = \"6 mm\"\n",
        "sphere.toml");
    const auto built = casefile::build_case<float128>(spec);
    engine::Simulation<float128> simulation(built.the_case, built.states, built.start);
    testing::EventRecorder<float128> recorder;
    simulation.attach(recorder);
    while (recorder.impacts.size() < 60)
      simulation.run_until(simulation.clock().at(simulation.seconds() + 0.01));
    std::vector<float128> times;
    for (const auto& event : recorder.impacts) times.push_back(simulation.clock().seconds(event.time));
    return times;
  };
  const auto sphere = events("type = \"sphere\"\ndiameter = \"40 mm\"\n"),
             capsule = events("type = \"capsule\"\ndiameter = \"40 mm\"\nheight = \"40 mm\"\n");
  float128 first = 0, all = 0;
  for (std::size_t k = 0; k < 60; ++k) {
    const float128 off = abs(sphere[k] - capsule[k]);
    if (k < 10) raise(first, off);
    raise(all, off);
  }
  other_mills.at_most("sphere and capsule, first 10 impacts", first, 1e-28, " s");
  other_mills.at_most("sphere and capsule, 60 impacts", all, 1e-10, " s");
}

}  // namespace
}  // namespace edmill::verification
