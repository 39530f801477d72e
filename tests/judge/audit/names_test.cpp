// Each mistake is planted by itself, and every name that the audit and the search for causes can
// give is held against it: the right one, or none.
#include <gtest/gtest.h>

#include "faulty_log.hpp"
#include "identify/identify.hpp"

namespace edmill::audit {
namespace {

using testing::Faults;

/// A mistake of the mill that makes the log, or a number of its case.
struct Planted {
  std::string name;
  std::set<std::string>
      right;  ///< names, one of which is given; none may be given where this is empty
  Faults faults{};
  std::string setting{};  ///< of the case of the log
  int impacts = 300;
  double tolerance = 1e-9;
};

class Names : public testing::FaultyLog, public ::testing::WithParamInterface<Planted> {
 protected:
  static casefile::CaseSpec spec_with(const std::vector<std::string>& settings) {
    const std::string balls =
        testing::batch(2, "9.52 mm") + testing::batch(3, "4.76 mm", "reduced_inertia = 0.6\n");
    return casefile::parse_case(
        testing::spex_text("end_time = \"10 s\"\nseed = 7", "restitution = 0.53", balls),
        "names.toml", settings);
  }
  /// All names that are given to a log.
  static std::set<std::string> names(const Audit& audit, const identify::Identification& found) {
    std::set<std::string> all;
    for (const auto& d : audit.diagnoses) all.insert(d.name);
    for (const auto& cause : found.causes)
      for (const auto& f : cause.found) all.insert(f.what.is_fitted() ? f.what.key : f.what.name());
    if (found.stepping.soft) all.insert("soft contacts");
    if (found.stepping.step) all.insert("multiples of a step");
    if (found.stepping.step_by_depth) all.insert("step by depth");
    if (found.stepping.first_order_step) all.insert("first order");
    return all;
  }
};

TEST_P(Names, AreRightOrNotGiven) {
  const auto& p = GetParam();
  const auto theirs =
      spec_with(p.setting.empty() ? std::vector<std::string>{} : std::vector{p.setting});
  built = casefile::build_case<double>(theirs);
  simulate(p.faults, p.impacts);
  const auto ours = spec_with({});
  built = casefile::build_case<double>(ours);
  Options options;
  options.log = scratch / "log.csv";
  options.tolerance = p.tolerance;
  const auto result = edmill::audit::audit(built.the_case, built.states, options);
  const auto found = identify::identify(ours, options);
  const auto given = names(result, found);
  const std::string text = edmill::audit::table(result) + identify::table(found);
  for (const auto& name : given)
    EXPECT_TRUE(p.right.contains(name)) << "\"" << name << "\"\n" << text;
  // A coarse tolerance may hide what was planted.
  const bool seen = result.verdict == Verdict::differ;
  EXPECT_TRUE(p.right.empty() || !given.empty() || (!seen && p.tolerance > 1e-6)) << text;
}

const std::string order =
    "mill, order of rotations: R_x(gamma) R_z(theta), as (2.14) is printed, in place of "
    "R_z(theta) R_x(gamma)";
std::vector<Planted> planted() {
  std::vector<Planted> all = {
      {"nothing", {}},
      {"printed_rotations", {order}, {.printed_rotations = true}},
      {"wall_at_rest", {"velocity of the wall (2.27): a wall at rest"}, {.wall_at_rest = true}},
      {"wall_a_hundredth_too_fast", {"velocity of the wall"}, {.wall_velocity_factor = 1.01}},
      {"wall_half_as_fast", {"velocity of the wall"}, {.wall_velocity_factor = 0.5}},
      {"restitution", {"contact.restitution"}, {.restitution = 0.6}},
      {"no_restitution", {"contact.restitution"}, {.restitution = 0}},
      {"least_separation", {"contact.least_separation"}, {.least_separation = 0.03}},
      {"no_least_separation", {"contact.least_separation"}, {.least_separation = 0}},
      {"friction_of_restitution",
          {"limit of the friction (2.24'): mu (1 + e_n) |g_n| in place of the impulse at v_s"},
          {.restitution_friction = true}},
      {"tangential_sign", {"change of the velocity by the friction"}, {.tangential_sign = true}, "",
          80},
      {"printed_compliance",
          {"impacts of balls that are not alike (2.24'): 1 + 1/J, as (2.24) is printed, in the "
           "limit of "
           "sliding"},
          {.printed_compliance = true}},
      {"equal_masses",
          {"impacts of balls that are not alike (2.24'): each takes half of the relative change, "
           "as for equal "
           "masses"},
          {.equal_masses = true}},
      {"exchanged_masses",
          {"impacts of balls that are not alike (2.24'): the masses are exchanged"},
          {.exchanged_masses = true}, "", 200},
      {"spin_lost", {"spin in flights"}, {.spin_lost = true}},
      {"no_gravity", {"run.gravity", "gravity in flights"}, {.no_gravity = true}},
      {"every_fifth_impact_late", {}, {.late_every = 5}},
      {"every_impact_late_by_the_same", {}, {.late_every = 1}},
      {"time_step", {"step by depth", "multiples of a step"}, {.step = 2e-6}},
      {"missed_pairs", {}, {.missed_pairs_every = 6}},
      {"lower_cap_unseen", {"unseen_wall"}, {.lower_cap_unseen = true}},
      {"dose_factor", {"dose, column milling_dose"}, {.dose_factor = 1.001}},
      {"net_dose", {"supplied energy in the dose"}, {.net_dose = true}},
      {"restitution_and_friction", {"contact.restitution", "contact.friction"},
          {.restitution = 0.6}, "contact.friction=0.5"},
      {"friction", {"contact.friction"}, {}, "contact.friction=0.45"},
      {"friction_of_walls", {"contact.ball_wall.friction"}, {}, "contact.ball_wall.friction=0.6"},
      {"restitution_of_balls", {"contact.ball_ball.restitution"}, {},
          "contact.ball_ball.restitution=0.8"},
      {"height", {"vessel.height"}, {}, "vessel.height=\"57.2 mm\""},
      {"diameter", {"vessel.diameter"}, {}, "vessel.diameter=\"38.1 mm\""},
      {"arm", {"mill.arm"}, {}, "mill.arm=\"101 mm\""},
      {"gamma", {"mill.gamma_max"}, {}, "mill.gamma_max=\"15.2 deg\""},
      {"speed", {"mill.speed"}, {}, "mill.speed=\"1060 rpm\""},
      {"density", {"balls.0.density", "balls.1.density"}, {}, "balls.0.density=\"9 g/cm3\""},
      {"size", {"balls.1.diameter"}, {}, "balls.1.diameter=\"4.7 mm\""},
      {"inertia", {"balls.1.reduced_inertia"}, {}, "balls.1.reduced_inertia=0.5"},
      {"gravity", {"run.gravity"}, {}, "run.gravity=\"9.7 m/s2\""},
  };
  return all;
}

/// Every third of them: the others are in the long tests.
std::vector<Planted> some() {
  std::vector<Planted> few;
  const auto all = planted();
  for (std::size_t k = 0; k < all.size(); k += 3) few.push_back(all[k]);
  return few;
}

/// All of them again, where the tolerance is as coarse as for codes with soft contacts.
std::vector<Planted> coarse() {
  auto all = planted();
  for (auto& p : all) p.tolerance = 1e-3;
  return all;
}

const auto name = [](const auto& info) { return info.param.name; };
INSTANTIATE_TEST_SUITE_P(Audit, Names, ::testing::ValuesIn(some()), name);
INSTANTIATE_TEST_SUITE_P(LongAll, Names, ::testing::ValuesIn(planted()), name);
INSTANTIATE_TEST_SUITE_P(LongCoarse, Names, ::testing::ValuesIn(coarse()), name);

}  // namespace
}  // namespace edmill::audit
