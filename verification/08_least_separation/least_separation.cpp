// Claim 08: as the least separation speed goes to zero, what stays, what vanishes, and what has no
// limit.
#include <cmath>

#include "base/statistics.hpp"
#include "claim.hpp"
#include "core.hpp"
#include "simulated.hpp"

namespace edmill::verification {
namespace {

const Claim claim("08 least separation");

struct Charge {
  int count;
  const char *diameter, *restitution;
  int periods, seeds;  ///< of each run's statistics; runs
};

/// Means over the seeds: dose rate [W] with its interval, collisions per second, and shares of the
/// dose.
struct Figures {
  double rate = 0, half_width = 0, collisions = 0;
  double supplied = 0, normal = 0,
         tangential = 0;  ///< the last two: dose of impacts that the rule decides
};

/// Doses of the impacts that the least separation speed decides [J].
struct TouchedDoses : engine::Observer<double> {
  double normal = 0, tangential = 0;
  void on_impact(const engine::Impact<double>& impact, engine::Simulation<double>&) override {
    const auto& o = impact.outcome;
    if (!o.least_separation) return;
    normal += o.normal_dose, tangential += o.milling_dose - o.normal_dose;
  }
};

/// Over whole drive periods after the first ten.
Figures figures(const Charge& charge, const char* least_separation) {
  const double period = 60.0 / 1054;
  Figures f;
  std::vector<double> rates;
  for (int seed = 1; seed <= charge.seeds; ++seed) {
    const auto spec = casefile::read_case(EDMILL_SOURCE_DIR "/docs/examples/ward.toml",
        {"balls.0.count=" + std::to_string(charge.count),
            std::string("balls.0.diameter=") + charge.diameter,
            std::string("contact.restitution=") + charge.restitution,
            std::string("contact.least_separation=") + least_separation + " m/s",
            "run.seed=" + std::to_string(seed),
            "run.start_time=" + Claim::text(10 * period, 12) + " s",
            "run.end_time=" + Claim::text((10 + charge.periods) * period, 12) + " s"});
    TouchedDoses doses;
    const auto s = simulated(spec, casefile::build_case<double>(spec), &doses);
    EXPECT_TRUE(s.end_reason == model::EndReason::end_time) << model::name(s.end_reason);
    rates.push_back(s.milling_dose / s.duration());
    f.collisions += static_cast<double>(s.total_collisions()) / s.duration() / charge.seeds;
    f.supplied += s.supplied_energy / s.milling_dose / charge.seeds;
    // These two are of the whole run, the first ten periods included.
    const double whole = s.milling_dose * s.end_time / s.duration();
    f.normal += doses.normal / whole / charge.seeds;
    f.tangential += doses.tangential / whole / charge.seeds;
  }
  const auto rate = numerics::estimate(rates);
  f.rate = *rate.mean, f.half_width = *rate.half_width;
  claim.say(std::to_string(charge.count) + " balls, v_s " + least_separation + " m/s: dose rate " +
      Claim::text(f.rate, 5) + " +- " + Claim::text(f.half_width, 2) + " W, " +
      Claim::text(f.collisions, 4) + " collisions/s; shares of the dose: supplied " +
      Claim::text(f.supplied, 2) + ", in decided impacts normal " + Claim::text(f.normal, 2) +
      ", tangential " + Claim::text(f.tangential, 2));
  return f;
}

/// The dose rate hardly moves at 10 cm/s and not at 1 cm/s; what the rule does to the energy
/// vanishes.
void converges(const Charge& charge) {
  const Figures coarse = figures(charge, "0.1"), middle = figures(charge, "0.01"),
                fine = figures(charge, "0.001");
  const std::string name = std::to_string(charge.count) + " balls, ";
  claim.at_most(name + "dose rates at 0.1 and 0.001 m/s, difference as a share",
      std::abs(coarse.rate / fine.rate - 1), 0.005);
  const double interval = std::hypot(middle.half_width, fine.half_width);
  // 1.5 times: 3.5 standard errors.
  claim.at_most(name + "dose rates at 0.01 and 0.001 m/s, difference over its 95 % interval",
      std::abs(middle.rate - fine.rate) / interval, 1.5);
  claim.at_most(name + "and that interval as a share", interval / fine.rate, 0.003);
  claim.at_least(name + "order of the supplied energy, 0.1 to 0.01 m/s",
      std::log10(coarse.supplied / middle.supplied), 1.5);
  claim.at_least(name + "order of the supplied energy, 0.01 to 0.001 m/s",
      std::log10(middle.supplied / fine.supplied), 1);
  claim.at_least(name + "order of the normal dose of decided impacts, 0.1 to 0.01 m/s",
      std::log10(coarse.normal / middle.normal), 1);
  claim.at_least(name + "order of the normal dose of decided impacts, 0.01 to 0.001 m/s",
      std::log10(middle.normal / fine.normal), 1);
  claim.at_least(
      name + "collisions at 0.001 over 0.01 m/s", fine.collisions / middle.collisions, 1.5);
}

TEST(LeastSeparation, DoseRateOf28BallsIsAtItsLimit) { converges({28, "4.76 mm", "0.53", 105, 8}); }
TEST(LeastSeparation, LongDoseRateOf227BallsIsAtItsLimit) {
  converges({227, "2.36 mm", "0.56", 50, 8});
}

}  // namespace
}  // namespace edmill::verification
