// Materials, pairs of them and the laws that a case can name: what is read, and that a run obeys
// it.
#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "core.hpp"

namespace edmill {
namespace {

using casefile::CaseSpec;
using casefile::parse_case;

const std::string bodies = R"(
[run]
max_collisions = 2000
[vessel]
diameter = "38 mm"
height = "57 mm"
material = "steel"
[vessel.materials]
"cap +y" = "rubber"
[[material]]
name = "steel"
density = "7.8 g/cm3"
[[material]]
name = "alumina"
density = "3.9 g/cm3"
[[material]]
name = "rubber"
[[balls]]
count = 6
diameter = "6 mm"
material = "steel"
[[balls]]
count = 6
diameter = "6 mm"
material = "alumina"
)";
const std::string pairs = R"(
[[contact.pair]]
materials = ["steel", "steel"]
restitution = 0.9
friction = 0.1
[[contact.pair]]
materials = ["alumina", "steel"]
restitution = 0.8
friction = 0.2
least_separation = "2 cm/s"
[[contact.pair]]
materials = ["alumina", "alumina"]
restitution = 0.7
friction = 0.3
[[contact.pair]]
materials = ["rubber", "steel"]
restitution = 0.3
friction = 0.8
[[contact.pair]]
materials = ["rubber", "alumina"]
model = "constant"
restitution = 0.2
restitution_tangential = 0.5
)";

std::string refusal(const std::string& text) {
  try {
    parse_case(text, "case.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Materials, GiveDensitiesAndLawsByPair) {
  const CaseSpec spec = parse_case(bodies + pairs, "case.toml");
  const auto built = casefile::build_case<double>(spec).the_case;
  EXPECT_NEAR(built.balls[0].mass / built.balls[6].mass, 2, 1e-15);
  const auto &steel = built.balls[0], &alumina = built.balls[6];
  const auto e = [](const model::ContactLaw<double>& law) { return law.restitution(1, {1, 1}); };
  EXPECT_EQ(e(built.mill.law_between(steel, steel)), 0.9);
  EXPECT_EQ(e(built.mill.law_between(steel, alumina)), 0.8);
  EXPECT_EQ(e(built.mill.law_between(alumina, steel)), 0.8);
  EXPECT_EQ(e(built.mill.law_between(alumina, alumina)), 0.7);
  EXPECT_EQ(built.mill.law_between(alumina, steel).least_separation, 0.02);
  const auto partners = casefile::partners_of(spec);
  int rubber = 0;
  for (int wall = 0; wall < partners.walls(); ++wall) {
    const bool soft = partners[wall].label == "cap +y";
    rubber += soft;
    EXPECT_EQ(e(built.mill.law_with_wall(steel, wall)), soft ? 0.3 : 0.9);
    EXPECT_EQ(e(built.mill.law_with_wall(alumina, wall)), soft ? 0.2 : 0.8);
  }
  EXPECT_EQ(rubber, 1);
}

TEST(Materials, APairThatIsNotNamedFollowsTheCommonLaw) {
  const auto built = casefile::build_case<double>(parse_case(bodies +
          "[contact]\nrestitution = 0.5\nfriction = 0\n[contact.ball_wall]\nfriction = 0.6\n"
          "[[contact.pair]]\nmaterials = [\"steel\", \"alumina\"]\nrestitution = 0.25\n",
      "case.toml"));
  const auto& mill = built.the_case.mill;
  const auto &steel = built.the_case.balls[0], &alumina = built.the_case.balls[6];
  EXPECT_EQ(mill.law_between(steel, alumina).restitution(1, {1, 1}), 0.25);
  EXPECT_EQ(&mill.law_between(steel, steel), &mill.ball_ball);
  EXPECT_EQ(&mill.law_with_wall(steel, 0), &mill.ball_wall);
  EXPECT_EQ(mill.law_with_wall(alumina, 0).restitution(1, {1, 1}), 0.25);
}

/// Sees that every impact between balls leaves at the restitution of its pair.
template <class Real> struct PairWatch : engine::Observer<Real> {
  std::size_t by_pair[3] = {};
  Real worst{0};
  void on_impact(const engine::Impact<Real>& impact, engine::Simulation<Real>&) override {
    const auto& o = impact.outcome;
    if (impact.with_wall || o.least_separation) return;
    const int alumina = (impact.ball >= 6 ? 1 : 0) + (impact.partner >= 6 ? 1 : 0);
    const Real off = o.separation_speed - (9 - alumina) / Real(10) * o.approach_speed;
    const Real size = off < 0 ? Real(-off) : off;
    if (size > worst) worst = size;
    ++by_pair[alumina];
  }
};

template <class Real> class MaterialsOf : public ::testing::Test {};
using Scalars = ::testing::Types<double, float128, mpfr>;
TYPED_TEST_SUITE(MaterialsOf, Scalars);

TYPED_TEST(MaterialsOf, EveryImpactFollowsTheLawOfItsPair) {
  using Real = TypeParam;
  const auto built = casefile::build_case<Real>(parse_case(bodies + pairs, "case.toml"));
  engine::Simulation<Real> simulation(built.the_case, built.states, built.start);
  PairWatch<Real> watch;
  simulation.attach(watch);
  simulation.run_until(simulation.clock().at(Real(1) / 2));
  EXPECT_LE(watch.worst, 100 * epsilon<Real>());
  for (const std::size_t count : watch.by_pair) EXPECT_GT(count, 20u);
}

TEST(Materials, NeedALawForEveryContactThatCanBe) {
  const auto without = pairs.substr(0, pairs.rfind("[[contact.pair]]"));
  const std::string error = refusal(bodies + without);
  EXPECT_NE(error.find("expected an entry [[contact.pair]] for \"alumina\" and \"rubber\""),
      std::string::npos)
      << error;
}

TEST(Materials, ChangeTheDigestOnlyWhereTheyMatter) {
  const auto digest = [](const std::string& text) { return parse_case(text, "case.toml").digest; };
  std::string smooth = pairs;
  smooth.replace(smooth.find("friction = 0.8"), 14, "friction = 0.7");
  EXPECT_NE(digest(bodies + pairs), digest(bodies + smooth));
  std::string moved = bodies;
  moved.replace(moved.find("cap +y"), 6, "cap -y");
  EXPECT_NE(digest(bodies + pairs), digest(moved + pairs));
}

const std::string plain =
    "[run]\nend_time = \"1 s\"\n[vessel]\ndiameter = \"38 mm\"\nheight = \"57 mm\"\n"
    "[[balls]]\ncount = 11\ndiameter = \"4.76 mm\"\n";

TEST(Laws, TakeTheChargeRatioFromThePowder) {
  const auto spec = parse_case(
      plain + "[powder]\nmass = \"1 g\"\n[contact]\nmodel = \"powder-load\"\nfriction = 0.4\n",
      "case.toml");
  const auto built = casefile::build_case<double>(spec).the_case;
  double mass = 0;
  for (const auto& ball : built.balls) mass += ball.mass;
  const auto& law = std::get<model::PowderLoad<double>>(built.mill.ball_ball.law);
  EXPECT_NEAR(law.charge_ratio, mass / 0.001, 1e-12);
  // The mean over uniform diameters d ± s, by Gauss's rule with two points, which is exact for a
  // cube.
  const auto spread = casefile::build_case<double>(
      parse_case(plain +
              "diameter_spread = \"1 mm\"\n[powder]\nmass = \"1 "
              "g\"\n[contact]\nmodel = \"powder-load\"\nfriction = 0.4\n",
          "case.toml"))
                          .the_case;
  const double off = 1 / std::sqrt(3.0), big = (4.76 + off) / 4.76, small = (4.76 - off) / 4.76;
  EXPECT_NEAR(std::get<model::PowderLoad<double>>(spread.mill.ball_ball.law).charge_ratio,
      mass / 0.001 * (big * big * big + small * small * small) / 2, 1e-12);
  EXPECT_NE(refusal(plain +
                "[powder]\nmass = \"1 mg\"\n[contact]\nmodel = \"powder-load\"\nfriction = 0.4\n")
                .find("from [[balls]] and [powder], expected a number from 2.5 to 10"),
      std::string::npos);
}

TEST(Laws, KeepTheirPointsExact) {
  const auto spec = parse_case(plain +
          "[contact]\nmodel = \"restitution-by-speed\"\nfriction = 0.4\n"
          "restitution_by_speed = [[\"10 cm/s\", 0.9], [\"2 m/s\", 0.7]]\n",
      "case.toml");
  const auto built = casefile::build_case<mpfr>(spec).the_case;
  const auto& law = std::get<model::RestitutionBySpeed<mpfr>>(built.mill.ball_wall.law);
  ASSERT_EQ(law.points.size(), 2u);
  EXPECT_EQ(law.points[0][0], mpfr(1) / 10);
  EXPECT_EQ(law.points[1][1], mpfr(7) / 10);
}

}  // namespace
}  // namespace edmill
