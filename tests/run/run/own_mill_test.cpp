// Vessels and motions of a program: those that a case can name, said by polynomials and joints, and
// others.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "edmill/errors.hpp"
#include "edmill/run.hpp"
#include "edmill/scalars.hpp"
#include "program.hpp"

namespace edmill {
namespace {

Case case_of(const std::string& mill, const std::string& outputs = "") {
  return Case::parse("[run]\nend_time = \"0.3 s\"\ngravity = \"9.8 m/s2\"\n[mill]\n" + mill +
      "\n[vessel]\ndiameter = \"38 mm\"\nheight = \"57 mm\"\n[contact]\nrestitution = 0.5\n"
      "friction = 0.4\n[[balls]]\ncount = 8\ndiameter = \"6 mm\"\n" +
      outputs);
}
const char* const spex = "type = \"spex8000\"\nspeed = \"1054 rpm\"";
const char* const planetary =
    "type = \"planetary\"\nradius = \"75 mm\"\nspeed = \"400 rpm\"\nratio = -2.18";

template <class Real> struct Seen : Observer<Real> {
  std::vector<Impact<Real>> impacts;
  std::size_t most;
  explicit Seen(std::size_t count) : most(count) {}
  void on_impact(const Impact<Real>& impact, Run<Real>& run) override {
    impacts.push_back(impact);
    if (impacts.size() >= most) run.stop();
  }
};
template <class Real>
std::vector<Impact<Real>> impacts_of(
    const Case& the_case, const OwnParts<Real>& own, std::size_t most) {
  Run<Real> run(the_case, own);
  Seen<Real> seen(most);
  run.attach(seen);
  run.finish();
  return seen.impacts;
}

template <class Real> Polynomial<Real> square(const Polynomial<Real>& form) { return form * form; }
/// The case's cylinder; walls in its order.
template <class Real> CurvedVessel<Real> cylinder(const Real& radius, const Real& half_height) {
  using P = Polynomial<Real>;
  return {{half_height + P::y() - P::r(), half_height - P::y() - P::r(),
              square<Real>(radius - P::r()) - square<Real>(P::x()) - square<Real>(P::z())},
      {radius, half_height, radius}};
}
/// A jar that narrows upwards by a fifth.
CurvedVessel<double> cone() {
  using P = Polynomial<double>;
  return {{square<double>(0.2 * (0.095 - P::y()) - std::sqrt(1.04) * P::r()) -
                  square<double>(P::x()) - square<double>(P::z()),
              0.025 + P::y() - P::r(), 0.025 - P::y() - P::r()},
      {0.0241, 0.0251, 0.0241}};
}

template <class Real>
void expect_alike(
    const std::vector<Impact<Real>>& one, const std::vector<Impact<Real>>& other, double to) {
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    ASSERT_EQ(one[k].ball, other[k].ball) << k;
    ASSERT_EQ(one[k].partner, other[k].partner) << k;
    ASSERT_NEAR(static_cast<double>(one[k].time), static_cast<double>(other[k].time), to) << k;
  }
}

/// Rounding alone tells a cylinder of polynomials from that of the case: errors grow by 0.01 digits
/// an impact.
TEST(OwnMill, ACylinderOfPolynomialsIsThatOfTheCase) {
  const auto the_case = case_of(spex);
  OwnParts<double> own;
  own.vessel = cylinder<double>(0.019, 0.0285);
  expect_alike(impacts_of<double>(the_case, {}, 150), impacts_of<double>(the_case, own, 150), 1e-9);
  OwnParts<mpfr> wide;
  wide.vessel = cylinder<mpfr>(mpfr("0.019"), mpfr("0.0285"));
  expect_alike(impacts_of<mpfr>(the_case, {}, 40), impacts_of<mpfr>(the_case, wide, 40), 1e-15);
}

/// The table turns once, the jar -3.18 times on it and so -2.18 times on the ground.
TEST(OwnMill, JointsMoveAsTheMillOfTheCase) {
  const auto the_case = case_of(planetary);
  OwnParts<double> own;
  Joint<double> table{true, {0, 1, 0}}, arm{false, {}}, jar{true, {0, 1, 0}};
  table.speed = {1, 1}, jar.speed = {-218, 100};
  arm.shift = {0.075, 0, 0};
  own.joints = {table, arm, jar};
  expect_alike(impacts_of<double>(the_case, {}, 150), impacts_of<double>(the_case, own, 150), 1e-9);
}

/// A paddle on the vessel and a bar on the ground, with a law of their own, in a cylinder of
/// polynomials on joints of the program.
TEST(OwnMill, BodiesAreThoseOfTheCase) {
  const auto the_case =
      case_of("type = \"chain\"\njoint = [{ rotate = \"y\", speed = \"300 rpm\" }]", R"(
[[material]]
name = "rubber"
[[body]]
size = ["6 mm", "30 mm", "2 mm"]
material = "rubber"
joint = [{ rotate = "y", speed = "600 rpm" }, { translate = ["8 mm", 0, 0] }]
[[body]]
size = ["26 mm", "10 mm", "4 mm"]
on = "ground"
joint = [{ translate = [0, "-22 mm", 0] }, { rotate = "y", speed = "600 rpm" }]
)");
  OwnParts<double> own;
  own.vessel = cylinder<double>(0.019, 0.0285);
  Joint<double> table{true, {0, 1, 0}};
  table.speed = {1, 1};
  own.joints = {table};
  const auto expected = impacts_of<double>(the_case, {}, 150);
  expect_alike(expected, impacts_of<double>(the_case, own, 150), 1e-8);
  for (const int body : {3, 4})
    EXPECT_TRUE(std::any_of(expected.begin(), expected.end(), [&](const auto& impact) {
      return impact.with_wall && impact.partner == body;
    })) << body;
}

TEST(OwnMill, ABallInAConeStaysInIt) {
  const auto the_case = case_of(spex);
  OwnParts<double> own;
  own.vessel = cone();
  Joint<double> shake{false, {0.3, 1, -0.2}};
  shake.harmonics = {{0.008, {1, 1}, 0.1}, {0.003, {2, 3}, 0}};
  own.joints = {shake};
  edmill::Run<double> run(the_case, own);
  run.finish();
  const auto s = run.summary();
  EXPECT_GT(s.milling_dose, 0);
  EXPECT_EQ(s.partners.size(), 4u);
  EXPECT_LT(std::abs(s.energy_closure), 1e-12 * s.milling_dose);
  const double period = 60.0 / 1054, pi = std::acos(-1.0), size = std::sqrt(0.09 + 1 + 0.04);
  const double moved = 0.008 * std::sin(2 * pi * (0.3 / period + 0.1)) +
      0.003 * std::sin(2 * pi * (2.0 / 3 * 0.3 / period));
  for (int k = 0; k < run.ball_count(); ++k) {
    const auto p = run.ball(k).position;
    const double x = p[0] - 0.3 / size * moved, y = p[1] - moved / size,
                 z = p[2] + 0.2 / size * moved;
    EXPECT_GE(
        0.2 * (0.095 - y) / std::sqrt(1.04) - std::hypot(x, z) / std::sqrt(1.04), 0.003 - 1e-12)
        << k;
    EXPECT_LE(std::abs(y), 0.022 + 1e-12) << k;
  }
}

std::string refusal_of(const OwnParts<double>& own) {
  try {
    edmill::Run<double> run(case_of(spex), own);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(OwnMill, WhatIsNoVesselOrMotionIsRefused) {
  const auto expect = [](const OwnParts<double>& own, const std::string& words) {
    EXPECT_NE(refusal_of(own).find(words), std::string::npos) << refusal_of(own);
  };
  using P = Polynomial<double>;
  OwnParts<double> own;
  own.vessel = cone(), own.vessel->walls.pop_back();
  expect(own, "open");
  own.vessel = cone(), own.vessel->half_sizes[1] = 0.02;
  expect(own, "open");
  own.vessel = cone(), own.vessel->walls.clear();
  expect(own, "1 to 32");
  own.vessel = cone(), own.vessel->walls.push_back(P::x() - 1 - P::r());
  expect(own, "no room");
  own.vessel = cone(), own.vessel->walls[0] = square(square(square(square(P::x()))));
  expect(own, "degree 16");
  own.vessel = cone(), own.vessel->walls[1] = 0.025 + P::y();
  expect(own, "depend on r");
  own.vessel = cylinder<double>(0.0031, 0.02);
  expect(own, "ball");  // eight balls of 6 mm
  own = {};
  own.joints = {Joint<double>{true, {}}};
  expect(own, "axis");
  own.joints = {Joint<double>{true, {0, 1, 0}, {}, 0, {1, 0}}};
  expect(own, "periods");
}

/// The squares of a cone and a cylinder are positive again for balls that are wider than they are.
TEST(OwnMill, LargeBallsArePlacedWhereTheyFitOrRefused) {
  const auto with_ball = [](double diameter, int seed) {
    return Case::parse(
        "[run]\nend_time = \"0.1 s\"\ngravity = \"9.8 m/s2\"\nseed = " + std::to_string(seed) +
        "\n[mill]\ntype = \"still\"\n[vessel]\ndiameter = \"80 mm\"\nheight = \"80 mm\"\n"
        "[contact]\nrestitution = 0.5\nfriction = 0.4\n[[balls]]\ncount = 1\ndiameter = \"" +
        std::to_string(diameter) + " m\"\n");
  };
  OwnParts<double> own;
  own.vessel = cone();
  own.joints = {
      Joint<double>{false, {0, 1, 0}}};  // at rest, with its axes along those of the ground
  const double radius = 0.019, secant = std::sqrt(1.04);  // the largest ball has 19.7 mm
  for (int seed = 1; seed <= 20; ++seed) {
    edmill::Run<double> run(with_ball(2 * radius, seed), own);
    const auto expect_inside = [&] {
      const auto p = run.ball(0).position;
      EXPECT_GE(0.2 * (0.095 - p[1]) - std::hypot(p[0], p[2]), secant * radius - 1e-12) << seed;
      EXPECT_LE(std::abs(p[1]), 0.025 - radius + 1e-12) << seed;
    };
    expect_inside();
    run.finish();
    expect_inside();
  }
  const auto refuses = [&](double diameter) {
    try {
      edmill::Run<double> run(with_ball(diameter, 1), own);
    } catch (const InputError&) {
      return true;
    }
    return false;
  };
  EXPECT_TRUE(refuses(0.04));
  own.vessel = cylinder<double>(0.01, 0.06);
  own.vessel->half_sizes = {0.03, 0.07, 0.03};
  EXPECT_FALSE(refuses(0.019));
  for (const double diameter : {0.0201, 0.03, 0.04, 0.05})
    EXPECT_TRUE(refuses(diameter)) << diameter;
}

/// What a case says of its own walls has no meaning for others.
TEST(OwnMill, CasesWhoseWallsMoveOrHaveMaterialsAreRefused) {
  const std::string pistons = "[[vessel.piston]]\nwall = \"cap +y\"\ndistance = \"2 mm\"\n";
  const std::string materials =
      "[[material]]\nname = \"steel\"\ndensity = \"7.8 g/cm3\"\n[[material]]\nname = \"rubber\"\n";
  const auto pair = [](const std::string& other) {
    return "[[contact.pair]]\nmaterials = [\"steel\", \"" + other +
        "\"]\nrestitution = 0.2\nfriction = 0.3\n";
  };
  const std::string lid = "[vessel.materials]\n\"cap +y\" = \"rubber\"\n";
  const std::string steel_ball =
      "[[balls]]\ncount = 1\ndiameter = \"7 mm\"\nmaterial = \"steel\"\n";
  OwnParts<double> own;
  own.vessel = cone();
  const auto refusal = [&](const std::string& text) -> std::string {
    try {
      edmill::Run<double> run(case_of(spex, text), own);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refusal(pistons).find("walls move"), std::string::npos) << refusal(pistons);
  const auto of_a_lid = refusal(lid + materials + pair("rubber") + steel_ball);
  EXPECT_NE(of_a_lid.find("materials"), std::string::npos) << of_a_lid;
  // Between balls they go on.
  edmill::Run<double> run(case_of(spex, materials + pair("steel") + steel_ball), own);
  run.finish();
  EXPECT_GT(run.summary().milling_dose, 0);
}

class OwnMillFiles : public ProgramTest {};

/// Outputs ask the vessel that the run has.
TEST_F(OwnMillFiles, OutputsAreOfTheVesselOfTheProgram) {
  const std::string coverage = "[[output]]\ntype = \"coverage\"\nparts = 2\n";
  OwnParts<double> hexagon;
  for (const double side : {1.0, -1.0})
    for (const double turn : {0.0, 1.0, 2.0})
      hexagon.planes.push_back(
          {{side * std::cos(turn * M_PI / 3), 0, side * std::sin(turn * M_PI / 3)}, 0.019});
  hexagon.planes.push_back({{0, 1, 0}, 0.0285}), hexagon.planes.push_back({{0, -1, 0}, 0.0285});
  edmill::Run<double> run(case_of(spex, coverage), hexagon);
  run.write_to((scratch / "hexagon").string());
  run.finish();
  run.commit();
  const auto text = contents(scratch / "hexagon/coverage.csv");
  EXPECT_NE(text.find("\n7,"), std::string::npos) << text;
  double dose = 0;
  for (const double d : run.summary().dose_by_partner) dose += d;
  EXPECT_GT(dose, 0);

  OwnParts<double> curved;
  curved.vessel = cone();
  edmill::Run<double> other(case_of(spex, coverage), curved);
  try {
    other.write_to((scratch / "cone").string());
    ADD_FAILURE() << "a map of walls without coordinates";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("coordinates"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace edmill
