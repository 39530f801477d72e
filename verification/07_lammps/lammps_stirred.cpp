// Claim 07 for a stirred mill: a bar that turns in a box at rest, as a region of LAMMPS. A box,
// since balls that circle along a cylinder evade the bar for long, and the dose rate fluctuates.
#include <cmath>

#include "core.hpp"
#include "lammps_contacts.hpp"
#include "lammps_limit.hpp"
#include "simulated.hpp"

namespace edmill::verification {
namespace {

constexpr double stirrer_rpm = 3000, batch = 0.2;  // [s]

casefile::CaseSpec stirred_case(double end) {
  return casefile::parse_case(
      "[run]\ngravity = [\"-9.8 m/s2\", 0, 0]\nend_time = \"" + Claim::text(end, 15) + R"( s"
[mill]
type = "chain"
joint = [{ rotate = "y", angle = "90 deg" }]
[vessel]
type = "box"
size = ["60 mm", "50 mm", "60 mm"]
[[body]]
size = ["42 mm", "60 mm", "8 mm"]
on = "ground"
joint = [{ rotate = "y", speed = "3000 rpm" }]
[contact]
restitution = 0.6
friction = 0.4
[[balls]]
count = 12
diameter = "7 mm"
density = "8 g/cm3"
)",
      "stirred");
}

LammpsSetting setting_when_stirred(double contact_duration) {
  auto s = setting_of(0.007, contact_duration);
  s.vessel_radius = s.vessel_half_height = 0.03;  // only the box around it all
  s.time_step *= 2;  // a twenty-fifth of a contact: the law is measured with the same steps
  s.damping = damping_for(0.6, s);
  return s;
}

/// The dose rate of each batch, and the power of the bar in all of them. [W]
struct Rates {
  std::vector<double> doses;
  double power = 0;
};

Rates lammps_stirred(double contact_duration, int batches) {
  auto setting = setting_when_stirred(contact_duration);
  const double speed = stirrer_rpm * pi / 30;
  setting.frame = [](double) {
    VesselFrame frame;
    frame.pull = {-9.8, 0, 0};
    return frame;
  };
  setting.vial = {"region vial block -0.03 0.03 -0.025 0.025 -0.03 0.03 side in units box"};
  setting.bodies = {{"block -0.021 0.021 -0.03 0.03 -0.004 0.004", speed}};
  const auto steps = static_cast<std::int64_t>(std::ceil(batch / setting.time_step));
  setting.time_step = batch / static_cast<double>(steps);
  std::vector<LammpsBall> balls;
  for (const auto& state : casefile::build_case<double>(stirred_case(1)).states)
    balls.push_back({{state.position[0], state.position[1], state.position[2]}, {}, {}});
  LammpsMill run(setting, balls);
  Rates rates;
  double before = 0, work = 0;
  for (int i = 0; i <= batches; ++i) {
    run.run(steps);
    const double dose = run.milling_dose();
    if (i > 0) rates.doses.push_back((dose - before) / batch);
    before = dose;
    if (i == 0) work = run.work_of_body(0);
  }
  rates.power = (run.work_of_body(0) - work) / (batch * batches);
  return rates;
}

/// With the contacts of LAMMPS.
Rates edmill_stirred(int batches) {
  const auto spec = stirred_case(batch * (batches + 1));
  auto initial = casefile::build_case<double>(spec);
  auto& mill = initial.the_case.mill;
  const auto flat = setting_when_stirred(brief);
  mill.ball_ball.law = law_of_contacts(flat, true),
  mill.ball_wall.law = law_of_contacts(flat, false);
  struct Works : engine::Observer<double> {
    double work = 0;
    std::vector<double> batches;
    void on_impact(const engine::Impact<double>& impact, engine::Simulation<double>& s) override {
      const auto k = static_cast<std::size_t>(s.seconds() / batch);
      if (k >= batches.size()) batches.resize(k + 1);
      batches[k] += impact.outcome.milling_dose;
      if (k > 0 && impact.with_wall && impact.partner == 6) work += impact.outcome.wall_work;
    }
  } works;
  simulated(spec, initial, &works);
  Rates rates;
  for (int i = 1; i <= batches; ++i)
    rates.doses.push_back(works.batches.at(static_cast<std::size_t>(i)) / batch);
  rates.power = works.work / (batch * batches);
  return rates;
}

void agree_when_stirred(int lammps_batches, int edmill_batches, double bound) {
  constexpr double longest =
      200e-6;  // contacts of 25 us take hours: the dose rate fluctuates more than a shaker's
  const auto edmill = edmill_stirred(edmill_batches);
  claim.say("stirred box: edmill's wall work of the bar " + Claim::text(edmill.power, 4) + " W");
  agree_in_the_limit(
      claim, "stirred box", edmill.doses,
      [&](double duration) {
        const auto rates = lammps_stirred(duration, lammps_batches);
        const double dose = *numerics::estimate(rates.doses).mean;
        claim.say("stirred box: power of LAMMPS's torque on the bar " +
            Claim::text(rates.power, 4) + " W, over edmill's wall work " +
            Claim::text(rates.power / edmill.power, 4));
        claim.at_most("stirred box: that power over the dose rate, off one",
            std::abs(rates.power / dose - 1), bound);
        return rates.doses;
      },
      bound, longest);
}

TEST_F(LammpsPeer, LongStirredBox) { agree_when_stirred(3000, 20000, 0.01); }

/// A rough check of the coupling: contacts of 50 us lower the dose rate by a few percent.
TEST_F(LammpsPeer, AStirredBoxInShort) {
  const auto lammps = lammps_stirred(50e-6, 20), edmill = edmill_stirred(400);
  const double dose = *numerics::estimate(lammps.doses).mean,
               other = *numerics::estimate(edmill.doses).mean;
  claim.at_most("stirred box: edmill's wall work over its dose rate, off one",
      std::abs(edmill.power / other - 1), 0.01);
  claim.at_most(
      "stirred box, contacts of 50 us: LAMMPS's power of the bar over its dose rate, off one",
      std::abs(lammps.power / dose - 1), 0.03);
  claim.at_most("stirred box, contacts of 50 us: LAMMPS over edmill, off one",
      std::abs(dose / other - 1), 0.15);
}

}  // namespace
}  // namespace edmill::verification
