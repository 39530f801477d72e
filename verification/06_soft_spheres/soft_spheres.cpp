// Claim 06: the event-driven trajectory is the limit of soft spheres as their stiffness grows.
#include <cmath>

#include "claim.hpp"
#include "event_recorder.hpp"
#include "soft_mill.hpp"

namespace edmill::verification {
namespace {

const Claim claim("06 soft spheres");

struct Scene {
  std::string name;
  double restitution, friction;
  int balls;
  int impacts;  ///< up to the last comparison
};

/// Where the balls are between the impacts, after each of them that is clear of the next one.
struct Checkpoint {
  double time;
  int impacts;
  std::vector<SoftBall> balls;
};

constexpr double ball_radius = 0.00476;
const std::vector<SoftBall> start{{{-0.026, 0.097, 0.002}, {1.1, -0.6, 0.4}, {40, -20, 60}},
    {{-0.012, 0.102, -0.003}, {-0.7, 0.5, 0.9}, {-30, 70, 10}},
    {{-0.040, 0.093, 0.004}, {0.5, 0.8, -0.8}, {0, 50, -40}}};

std::string list(const Triple& v) {
  return "[" + Claim::text(v[0], 17) + ", " + Claim::text(v[1], 17) + ", " + Claim::text(v[2], 17) +
      "]";
}

Triple triple(const Vec3<double>& v) { return {v[0], v[1], v[2]}; }

/// edmill, with no least separation speed and no tangential rebound.
std::vector<Checkpoint> event_driven(const Scene& scene) {
  std::string text =
      "[run]\nend_time = \"1 s\"\ngravity = \"9.8 m/s2\"\n[mill]\nspeed = \"1054 rpm\"\n"
      "[vessel]\ntype = \"cylinder\"\ndiameter = \"38 mm\"\nheight = \"57 mm\"\n"
      "[contact]\nleast_separation = \"0 m/s\"\nmin_tangential = 0\nrestitution = " +
      Claim::text(scene.restitution) + "\nfriction = " + Claim::text(scene.friction) + "\n";
  for (int i = 0; i < scene.balls; ++i)
    text += "[[ball]]\ndiameter = \"9.52 mm\"\nposition = " + list(start[i].position) +
        "\nvelocity = " + list(start[i].velocity) + "\nspin = " + list(start[i].spin) + "\n";
  const auto built = casefile::build_case<double>(casefile::parse_case(text, scene.name));
  testing::EventRecorder<double> events;
  engine::Simulation<double> simulation(built.the_case, built.states, built.start);
  simulation.attach(events);
  double end = 0;
  while (static_cast<int>(events.impacts.size()) <= scene.impacts)
    simulation.run_until(simulation.clock().at(end += 0.001));
  int caps = 0, cylinder = 0, pairs = 0, stopped = 0;
  for (int k = 0; k < scene.impacts; ++k) {
    const auto& impact = events.impacts[k];
    ++(!impact.with_wall ? pairs : impact.partner == 2 ? cylinder : caps);
    stopped += scene.friction > 0 && impact.outcome.restitution_tangential == 0;
  }
  claim.say(scene.name + ", impacts: " + std::to_string(caps) + " caps, " +
      std::to_string(cylinder) + " cylinder, " + std::to_string(pairs) +
      " between balls; slip stopped in " + std::to_string(stopped));
  std::vector<Checkpoint> checkpoints;
  engine::Simulation<double> again(built.the_case, built.states, built.start);
  for (int k = 0; k < scene.impacts; ++k) {
    const auto time = [&](int i) { return again.clock().seconds(events.impacts[i].time); };
    if (time(k + 1) - time(k) < 4e-4) continue;
    const auto between = again.clock().at((time(k) + time(k + 1)) / 2);
    again.run_until(between);
    Checkpoint point{again.clock().seconds(between), k + 1, {}};
    for (int i = 0; i < scene.balls; ++i) {
      const auto state = again.state_at(i, between);
      point.balls.push_back({triple(state.position), triple(state.velocity), triple(state.spin)});
    }
    checkpoints.push_back(point);
  }
  return checkpoints;
}

SoftSetting setting_of(const Scene& scene, double contact_time) {
  return {0.1, std::acos(-1.0) / 12, 60.0 / 1054, 9.8, 0.019, 0.0285, ball_radius,
      scene.restitution, scene.friction, contact_time};
}

/// Largest difference of position over 10 mm, velocity and surface speed over 1 m/s.
double distance(const std::vector<SoftBall>& a, const std::vector<SoftBall>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      raise(largest, std::abs(a[i].position[k] - b[i].position[k]) / 0.01);
      raise(largest, std::abs(a[i].velocity[k] - b[i].velocity[k]));
      raise(largest, std::abs(a[i].spin[k] - b[i].spin[k]) * ball_radius);
    }
  return largest;
}

std::vector<double> errors(const std::vector<Checkpoint>& checkpoints, const SoftSetting& setting) {
  SoftMill mill(
      setting, {start.begin(), start.begin() + static_cast<long>(checkpoints[0].balls.size())});
  std::vector<double> all;
  for (const Checkpoint& point : checkpoints) {
    mill.advance(point.time);
    all.push_back(distance(mill.balls(), point.balls));
  }
  return all;
}

void converge(const Scene& scene) {
  const auto checkpoints = event_driven(scene);
  std::vector<double> times, last;
  double lowest = 10, highest = -10, finest = 0;
  for (double contact_time = 16e-6; contact_time > 5e-8; contact_time /= 4) {
    const auto now = errors(checkpoints, setting_of(scene, contact_time));
    std::string line =
        scene.name + ", contacts of " + Claim::text(contact_time * 1e6) + " us, difference";
    for (std::size_t k = 0; k < now.size(); ++k) {
      if (k % (now.size() / 4) == 0 || k + 1 == now.size())
        line += " after " + std::to_string(checkpoints[k].impacts) + ": " + Claim::text(now[k], 2);
      if (last.empty() || contact_time > 3e-7) continue;
      const double order = std::log(last[k] / now[k]) / std::log(4.0);
      lowest = std::min(lowest, order), highest = std::max(highest, order);
    }
    claim.say(line);
    last = now;
    finest = now.back();
  }
  claim.at_least(scene.name + ", lowest order in the contact time", lowest, 0.9);
  claim.at_most(scene.name + ", highest", highest, 1.1);
  claim.at_most(
      scene.name + ", " + std::to_string(scene.impacts) + " impacts, stiffest: difference", finest,
      1e-2);
}

TEST(SoftSpheres, OneSmoothBall) { converge({"1 smooth ball", 0.8, 0, 1, 10}); }
TEST(SoftSpheres, OneFrictionalBall) { converge({"1 ball, mu 0.1", 0.8, 0.1, 1, 10}); }
TEST(SoftSpheres, ThreeSmoothBalls) { converge({"3 smooth balls", 0.8, 0, 3, 20}); }
TEST(SoftSpheres, ThreeFrictionalBalls) { converge({"3 balls, mu 0.1", 0.8, 0.1, 3, 20}); }

}  // namespace
}  // namespace edmill::verification
