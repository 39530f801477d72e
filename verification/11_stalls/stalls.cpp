// Claim 11: the dose rate does not depend on the numbers of the rule on stalls.
#include <cmath>

#include "base/statistics.hpp"
#include "claim.hpp"
#include "core.hpp"
#include "simulated.hpp"

namespace edmill::verification {
namespace {

const Claim claim("11 stalls");

struct Charge {
  int count;
  const char *diameter, *restitution;
  double seconds;  ///< of each run's statistics
  int seeds;
};

struct Figures {
  double rate = 0, half_width = 0,
         rested = 0;  ///< the last: share of the dose in impacts without friction
};

/// In a SPEX at 1054 rpm, statistics after half a second.
Figures figures(const Charge& charge, const model::StallRule& rule) {
  std::vector<double> rates;
  Figures f;
  for (int seed = 1; seed <= charge.seeds; ++seed) {
    const auto spec = casefile::read_case(EDMILL_SOURCE_DIR "/docs/examples/ward.toml",
        {"balls.0.count=" + std::to_string(charge.count),
            std::string("balls.0.diameter=") + charge.diameter,
            std::string("contact.restitution=") + charge.restitution,
            "run.seed=" + std::to_string(seed), "run.start_time=0.5 s",
            "run.end_time=" + Claim::text(0.5 + charge.seconds, 12) + " s"});
    auto built = casefile::build_case<double>(spec);
    built.the_case.mill.stall = rule;
    const auto s = simulated(spec, built);
    EXPECT_EQ(model::name(s.end_reason), "end_time") << charge.count << " balls, seed " << seed;
    rates.push_back(s.milling_dose / s.duration());
    f.rested += s.stall_dose / s.milling_dose / charge.seeds;
  }
  const auto rate = numerics::estimate(rates);
  f.rate = *rate.mean, f.half_width = *rate.half_width;
  claim.say(std::to_string(charge.count) + " balls, N " + std::to_string(rule.impacts) + ", a_s " +
      std::to_string(rule.acceleration) + " m/s2: dose rate " + Claim::text(f.rate, 5) + " +- " +
      Claim::text(f.half_width, 2) + " W, " + Claim::text(100 * f.rested, 2) +
      " % of the dose without friction");
  return f;
}

/// Each number ten times as large and as small.
void keeps_its_dose_rate(const Charge& charge, double largest_interval) {
  const model::StallRule rule;
  const Figures own = figures(charge, rule);
  for (const auto& other : {model::StallRule{10 * rule.impacts, rule.acceleration},
           model::StallRule{rule.impacts / 10, rule.acceleration},
           model::StallRule{rule.impacts, 10 * rule.acceleration},
           model::StallRule{rule.impacts, rule.acceleration / 10}}) {
    const Figures f = figures(charge, other);
    const double interval = std::hypot(own.half_width, f.half_width);
    const std::string name = std::to_string(charge.count) + " balls, N " +
        std::to_string(other.impacts) + ", a_s " + std::to_string(other.acceleration) + ": ";
    // 1.5 times the 95 % interval: at four comparisons a case one false alarm in 100 runs of the
    // claim.
    claim.at_most(name + "difference of the dose rate over its interval",
        std::abs(f.rate - own.rate) / interval, 1.5);
    claim.at_most(name + "and that interval as a share", interval / own.rate, largest_interval);
  }
}

TEST(Stalls, FourteenBallsKeepTheirDoseRate) {
  keeps_its_dose_rate({14, "9.52 mm", "0.55", 2, 6}, 0.03);
}

TEST(Stalls, LongFiveChargesKeepTheirDoseRates) {
  keeps_its_dose_rate({6, "9.52 mm", "0.55", 60, 8}, 0.006);
  keeps_its_dose_rate({14, "9.52 mm", "0.55", 60, 8}, 0.006);
  keeps_its_dose_rate({55, "4.76 mm", "0.56", 20, 8}, 0.006);
  keeps_its_dose_rate({95, "3.16 mm", "0.54", 10, 8}, 0.006);
  keeps_its_dose_rate({227, "2.36 mm", "0.56", 4, 8}, 0.006);
}

/// The charge whose wedges stood still for ever.
TEST(Stalls, LongTenLargeBallsKeepTheirDoseRate) {
  keeps_its_dose_rate({10, "12.7 mm", "0.5", 20, 12}, 0.01);
}

}  // namespace
}  // namespace edmill::verification
