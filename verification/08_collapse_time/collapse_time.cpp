// Claim 08: what converges as the collapse time goes to zero, and what does not.
#include <cmath>

#include "claim.hpp"
#include "edmill/instances.hpp"
#include "edmill/sweep/statistics.hpp"

namespace edmill::verification {
namespace {

const Claim claim("08 collapse time");

struct Charge {
  int count;
  const char *diameter, *restitution;
};
const Charge three{3, "9.52 mm", "0.50"}, many{28, "4.76 mm", "0.53"}, most{227, "2.36 mm", "0.56"};

/// Of four seeds each: milling dose rate [W], collisions per second, share of the dose within t_c.
struct Figures {
  double mean = 0, half_width = 0, collisions = 0, share = 0;
};

/// Over whole drive periods after the first five.
Figures figures(const Charge& charge, const char* collapse_time, int periods) {
  const double period = 60.0 / 1054;
  Figures f;
  std::vector<double> rates;
  for (int seed = 1; seed <= 4; ++seed) {
    const auto spec = casefile::read_case(
        EDMILL_SOURCE_DIR "/docs/examples/ward.toml",
        {"balls.0.count=" + std::to_string(charge.count), std::string("balls.0.diameter=") + charge.diameter,
         std::string("contact.restitution=") + charge.restitution,
         std::string("contact.collapse_time=") + collapse_time + " s", "run.seed=" + std::to_string(seed),
         "run.start_time=" + Claim::text(5 * period, 12) + " s",
         "run.end_time=" + Claim::text((5 + periods) * period, 12) + " s"});
    const auto s = driver::simulate<double>(spec, setup::build_case<double>(spec), {}).summary;
    EXPECT_TRUE(s.end_reason == "end_time") << s.end_reason;
    rates.push_back(s.milling_dose / s.duration());
    f.collisions += static_cast<double>(s.total_collisions()) / s.duration() / 4;
    f.share += s.collapse_dose / s.milling_dose / 4;
  }
  const auto rate = sweep::estimate(rates);
  f.mean = *rate.mean, f.half_width = *rate.half_width;
  claim.say(std::to_string(charge.count) + " balls, t_c " + collapse_time + " s: dose rate " +
            Claim::text(f.mean, 4) + " +- " + Claim::text(f.half_width, 2) + " W, " +
            Claim::text(f.collisions, 4) + " collisions/s, " + Claim::text(100 * f.share, 3) +
            " % of the dose within t_c");
  return f;
}

/// The dose rate rises by steps that shrink from decade to decade, beyond doubt of the intervals.
void converges(const Charge& charge, int periods) {
  const Figures coarse = figures(charge, "1e-3", periods), middle = figures(charge, "1e-4", periods),
                fine = figures(charge, "1e-5", periods);
  const std::string name = std::to_string(charge.count) + " balls";
  const double first = middle.mean - coarse.mean, second = fine.mean - middle.mean;
  const double doubt = std::hypot(fine.half_width, middle.half_width);
  claim.at_least(name + ", from 1e-4 to 1e-5 s the dose rate rises by", second, doubt, " W");
  claim.at_most(name + ", which is a share of", second / fine.mean, 0.06);
  claim.at_least(name + ", the step from 1e-3 to 1e-4 s over this one", first / second, 2);
  const double limit = fine.mean + second * second / (first - second);
  claim.at_most(
      name + ", limit of the geometric series " + Claim::text(limit, 4) + " W, above 1e-5 s by a share of",
      limit / fine.mean - 1, 0.03);
  claim.at_least(name + ", collisions at 1e-5 over 1e-4 s", fine.collisions / middle.collisions, 2.5);
  claim.at_most(name + ", share of the dose within t_c at 1e-5 over 1e-4 s", fine.share / middle.share, 0.5);
}

TEST(CollapseTime, DoseRateOf28BallsConverges) { converges(many, 35); }
TEST(CollapseTime, LongDoseRateOf227BallsConverges) { converges(most, 35); }

/// Balls of which each mostly lies on the cylinder: the dose rate stays, the collision rate has no limit.
TEST(CollapseTime, ThreeBallsCollideWithoutLimit) {
  const Figures middle = figures(three, "1e-4", 140), fine = figures(three, "1e-5", 35);
  claim.at_most("3 balls, dose rate at 1e-5 over 1e-4 s, off one", std::abs(fine.mean / middle.mean - 1),
                0.05);
  claim.at_least("3 balls, collisions at 1e-5 over 1e-4 s", fine.collisions / middle.collisions, 5);
}

}  // namespace
}  // namespace edmill::verification
