// Zeno points: a run without a least separation speed ends with the ball, its partner and the
// accumulation time; with one it continues.
#include <gtest/gtest.h>

#include "spex_case.hpp"

namespace edmill::engine {
namespace {

/// A ball dropped from h onto a still wall: impacts accumulate at sqrt(2h/g) (1+e)/(1-e).
casefile::CaseSpec drop(
    const std::string& gravity, const std::string& position, const std::string& least_separation) {
  return casefile::parse_case("[run]\nend_time = \"20 s\"\ngravity = " + gravity +
          "\n[mill]\ntype = \"still\"\n[vessel]\ndiameter = \"8 m\"\nheight = \"8 m\"\n"
          "[contact]\nrestitution = 0.6\nfriction = 0\nleast_separation = \"" +
          least_separation + "\"\n[[ball]]\ndiameter = \"1 m\"\nposition = " + position + "\n",
      "drop.toml");
}

template <class Real>
void expect_collapse(const casefile::CaseSpec& spec, int wall, const Real& tolerance) {
  using std::abs;
  using std::sqrt;
  const auto built = casefile::build_case<Real>(spec);
  Simulation<Real> simulation(built.the_case, built.states, built.start);
  ASSERT_EQ(simulation.run_until(simulation.clock().at(Real(20))), EndReason::inelastic_collapse);
  const auto& collapse = *simulation.collapse();
  EXPECT_EQ(collapse.ball, 0);
  EXPECT_TRUE(collapse.with_wall);
  EXPECT_EQ(collapse.partner, wall);
  const Real exact = 4 * sqrt(Real(6));  // h = 3, g = 1, e = 0.6: 9.79795897113...
  EXPECT_LT(abs(collapse.accumulation_time - exact), tolerance)
      << to_text<Real>(collapse.accumulation_time) << " instead of " << to_text<Real>(exact);
}

TEST(InelasticCollapse, DropOnACapEndsAtTheClosedFormTime) {
  expect_collapse<double>(
      drop("[\"-1\", \"0\", \"0\"]", "[\"-0.5 m\", \"0.1 m\", \"0\"]", "0 m/s"), 1, 1e-9);
  expect_collapse<double>(
      drop("[\"1\", \"0\", \"0\"]", "[\"0.5 m\", \"0.1 m\", \"0\"]", "0 m/s"), 0, 1e-9);
}

TEST(InelasticCollapse, DropOnTheCylinderEndsAtTheClosedFormTime) {
  expect_collapse<double>(drop("\"1 m/s2\"", "[\"0\", \"-0.5 m\", \"0\"]", "0 m/s"), 2, 1e-9);
}

TEST(InelasticCollapse, Float128ComesCloser) {
  expect_collapse<float128>(
      drop("[\"-1\", \"0\", \"0\"]", "[\"-0.5 m\", \"0.1 m\", \"0\"]", "0 m/s"), 1,
      float128("1e-18"));
}

TEST(InelasticCollapse, SingleBallOfThesisChapterFourCollapses) {
  const auto spec = casefile::parse_case(
      testing::spex_text("end_time = \"1 s\"", "restitution = 0.5\nleast_separation = \"0 m/s\"",
          testing::batch(1, "9.52 mm")),
      "chapter4.toml");
  const auto built = casefile::build_case<double>(spec);
  Simulation<double> simulation(built.the_case, built.states, built.start);
  ASSERT_EQ(simulation.run_until(simulation.clock().at(1.0)), EndReason::inelastic_collapse);
  EXPECT_EQ(simulation.collapse()->partner, 2);
  EXPECT_GE(simulation.collapse()->accumulation_time, simulation.seconds() - 1e-6);
}

TEST(InelasticCollapse, ThreeBallsOnALineCollapse) {
  // Two still balls close together and a third coming in, e well below the three-ball threshold 7 -
  // 4 sqrt(3).
  const auto spec = casefile::parse_case(
      "[run]\nend_time = \"50 s\"\n[mill]\ntype = \"still\"\n[vessel]\ndiameter = \"8 m\"\nheight "
      "= \"20 "
      "m\"\n"
      "[contact]\nrestitution = 0.02\nfriction = 0\nleast_separation = \"0 m/s\"\n"
      "[[ball]]\ndiameter = \"1 m\"\nposition = [\"-3 m\", \"0\", \"0\"]\nvelocity = [\"1\", "
      "\"0\", \"0\"]\n"
      "[[ball]]\ndiameter = \"1 m\"\nposition = [\"0 m\", \"0\", \"0\"]\n"
      "[[ball]]\ndiameter = \"1 m\"\nposition = [\"3 m\", \"0\", \"0\"]\nvelocity = [\"-1\", "
      "\"0\", \"0\"]\n",
      "three.toml");
  const auto built = casefile::build_case<double>(spec);
  Simulation<double> simulation(built.the_case, built.states, built.start);
  ASSERT_EQ(simulation.run_until(simulation.clock().at(50.0)), EndReason::inelastic_collapse);
  EXPECT_FALSE(simulation.collapse()->with_wall);
  EXPECT_LT(simulation.collapse()->accumulation_time, 5);
}

}  // namespace
}  // namespace edmill::engine
