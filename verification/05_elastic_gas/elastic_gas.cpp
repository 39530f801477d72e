// Claim 05: elastic balls in a still vessel are the hard-sphere fluid: collision rate, pressure,
// energy, equipartition.
#include <cmath>
#include <vector>

#include "claim.hpp"
#include "core.hpp"
#include "mill_parts.hpp"

namespace edmill::verification {
namespace {

const Claim claim("05 elastic gas");
constexpr double pi = 3.14159265358979323846;
constexpr double sigma = 0.01;  // diameter [m]
constexpr int seed = 7;

/// Balls in a vessel as high as it is wide, at rest; its volume is that of the balls over the
/// packing fraction.
struct Gas {
  double radius, half_height, mass, arm;
  casefile::InitialCase<double> built;
  engine::Simulation<double> simulation;

  Gas(int count, double packing, const std::string& contact)
      : radius(sigma * std::cbrt(count / (12 * packing))), half_height(radius),
        built(casefile::build_case<double>(casefile::parse_case(
            "[run]\nend_time = \"1000 s\"\nseed = " + std::to_string(seed) +
                "\n[mill]\ntype = \"still\"\n[vessel]\ndiameter = \"" +
                Claim::text(2 * radius, 17) + " m\"\nheight = \"" + Claim::text(2 * radius, 17) +
                " m\"\n[contact]\nleast_separation = \"0 m/s\"\n" + contact +
                "\n[[balls]]\ncount = " + std::to_string(count) +
                "\ndiameter = \"10 mm\"\nrandom_speed = \"1 m/s\"\ngap_ball = \"0.01 mm\"\n" +
                "gap_wall = \"0.01 mm\"\nmax_relocations = 10000000\n",
            "gas.toml"))),
        simulation(built.the_case, built.states, built.start) {
    mass = simulation.properties(0).mass;
    arm = testing::spex(simulation.mill()).arm();
  }

  /// Goes on for so many impacts.
  void run(std::uint64_t impacts) {
    struct Stop : engine::Observer<double> {
      std::uint64_t left;
      void on_impact(const engine::Impact<double>&, engine::Simulation<double>& s) override {
        if (left > 0 && --left == 0) s.request_stop(engine::EndReason::stopped);
      }
    };
    static Stop stop;  // attached for the whole life of every gas
    stop.left = impacts;
    if (!attached_) simulation.attach(stop);
    attached_ = true;
    simulation.run_until(simulation.clock().at(1e6));
  }
  double kinetic() const { return simulation.energy_at(simulation.now()).kinetic; }
  double spinning() const {
    double energy = 0;
    const double inertia = simulation.properties(0).reduced_inertia * mass * sigma * sigma / 4;
    for (int i = 0; i < simulation.ball_count(); ++i)
      energy += inertia / 2 * squared_norm<double>(simulation.spin(i));
    return energy;
  }
 private:
  bool attached_ = false;
};

const std::string smooth = "restitution = 1\nfriction = 0";
const std::string rough =
    "model = \"constant\"\nrestitution_normal = 1\nrestitution_tangential = -1";

/// Mean of blocks, and half the 99 % confidence interval by Student's t with 19 degrees of freedom.
struct Estimate {
  double mean = 0, half = 0;
  explicit Estimate(const std::vector<double>& blocks) {
    const double n = static_cast<double>(blocks.size());
    for (const double b : blocks) mean += b / n;
    for (const double b : blocks) half += (b - mean) * (b - mean);
    EXPECT_EQ(blocks.size(), 20u);
    half = 2.861 * std::sqrt(half / (n - 1) / n);
  }
  std::string text() const { return Claim::text(mean, 5) + " +- " + Claim::text(half, 2); }
};

/// What happens further from all walls than `margin`, where the fluid has no layers any more.
class Bulk : public engine::Observer<double> {
 public:
  static constexpr double margin = 4 * sigma;
  explicit Bulk(const Gas& gas)
      : gas_(gas), wide_(gas.radius - margin), high_(gas.half_height - margin) {}

  void on_impact(const engine::Impact<double>& impact, engine::Simulation<double>& s) override {
    const auto& flight = s.flight(impact.ball);
    if (impact.with_wall) {
      // Momentum given to the middle of a cap; its wall is flat, so that p = n kT Z there.
      if (impact.partner < 2 && across(flight.position) < wide_)
        momentum +=
            gas_.mass * norm<double>(Vec3<double>(flight.velocity - impact.velocity_before[0]));
    } else {
      collisions += inside((flight.position + s.flight(impact.partner).position) / 2);
    }
  }
  double volume() const { return 2 * pi * wide_ * wide_ * high_; }
  double cap_area() const { return 2 * pi * wide_ * wide_; }
  int count() const {
    int n = 0;
    for (int i = 0; i < gas_.simulation.ball_count(); ++i)
      n += inside(gas_.simulation.state_at(i, gas_.simulation.now()).position);
    return n;
  }

  long collisions = 0;
  double momentum = 0;
 private:
  // The vessel stands with its axis along X and its centre at the arm's length along Y.
  double across(const Vec3<double>& r) const { return std::hypot(r[1] - gas_.arm, r[2]); }
  bool inside(const Vec3<double>& r) const { return std::abs(r[0]) < high_ && across(r) < wide_; }
  const Gas& gas_;
  double wide_, high_;
};

void expect_hard_sphere_fluid(double packing) {
  constexpr int balls = 3000, blocks = 20, samples = 10;
  Gas gas(balls, packing, smooth);
  gas.run(20 * balls);  // forgets its start: 40 collisions of each ball
  Bulk bulk(gas);
  gas.simulation.attach(bulk);
  const double energy = gas.kinetic();
  const double kT = 2 * energy / 3 / balls;
  std::vector<double> rates, pressures, packings;
  for (int b = 0; b < blocks; ++b) {
    bulk.collisions = 0;
    bulk.momentum = 0;
    const double begin = gas.simulation.seconds();
    double n = 0;
    for (int k = 0; k < samples; ++k) {
      gas.run(4000);
      n += bulk.count() / bulk.volume() / samples;
    }
    const double time = gas.simulation.seconds() - begin;
    const double phi = n * pi * sigma * sigma * sigma / 6;
    // Carnahan and Starling: contact value and compressibility; Enskog's collisions per volume and
    // time.
    const double contact = (1 - phi / 2) / std::pow(1 - phi, 3);
    const double z = (1 + phi + phi * phi - phi * phi * phi) / std::pow(1 - phi, 3);
    const double enskog = 2 * n * n * sigma * sigma * contact * std::sqrt(pi * kT / gas.mass);
    rates.push_back(static_cast<double>(bulk.collisions) / bulk.volume() / time / enskog);
    pressures.push_back(bulk.momentum / bulk.cap_area() / time / (n * kT * z));
    packings.push_back(phi);
  }
  const Estimate rate(rates), pressure(pressures), phi(packings);
  const std::string at = "packing " + Claim::text(packing) + " (bulk " + phi.text() + "), ";
  claim.say(at + "collision rate / Enskog " + rate.text() + ", pressure / Carnahan-Starling " +
      pressure.text());
  claim.at_most(at + "collision rate off by", std::abs(rate.mean - 1), 0.015);
  claim.at_most(at + "half its 99 % interval", rate.half, 0.015);
  claim.at_most(at + "pressure off by", std::abs(pressure.mean - 1), 0.03);
  claim.at_most(at + "half its 99 % interval", pressure.half, 0.04);
}

TEST(ElasticGas, CollisionRateAndPressureAreThoseOfHardSpheres) {
  claim.say("3000 balls, seed " + std::to_string(seed));
  for (const double packing : {0.1, 0.2, 0.3}) expect_hard_sphere_fluid(packing);
}

void expect_energy_kept(std::uint64_t impacts, double bound) {
  for (const auto& [name, contact] : {std::pair{"smooth", smooth}, {"rough", rough}}) {
    Gas gas(500, 0.2, contact);
    const double before = gas.kinetic();
    gas.run(impacts);
    EXPECT_EQ(gas.simulation.counts().impacts, impacts);
    claim.at_most(std::string(name) + " balls, relative change of energy in " +
            Claim::text(static_cast<double>(impacts)) + " collisions",
        std::abs(gas.kinetic() / before - 1), bound);
  }
}

TEST(ElasticGas, EnergyIsKeptToRounding) { expect_energy_kept(1000000, 1e-12); }
TEST(ElasticGas, LongRunKeepsItsEnergyToRounding) { expect_energy_kept(10000000, 1e-11); }

TEST(ElasticGas, SpinTakesHalfOfTheEnergyOfRoughBalls) {
  Gas gas(200, 0.2, rough);
  EXPECT_EQ(gas.spinning(), 0);
  gas.run(40000);
  std::vector<double> blocks;
  for (int b = 0; b < 20; ++b) {
    double share = 0;
    for (int k = 0; k < 100; ++k) {
      gas.run(300);
      share += gas.spinning() / gas.kinetic() / 100;
    }
    blocks.push_back(share);
  }
  const Estimate share(blocks);
  claim.say("share of spin in the energy of rough balls " + share.text());
  claim.at_most(
      "its distance from 1/2 in 99 % intervals", std::abs(share.mean - 0.5) / share.half, 1);
  claim.at_most("half that interval", share.half, 0.002);
}

}  // namespace
}  // namespace edmill::verification
