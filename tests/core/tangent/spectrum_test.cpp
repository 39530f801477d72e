// What all exponents of a run obey.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "spex_case.hpp"
#include "tangent_run.hpp"

namespace edmill::tangent {
namespace {

using testing::TangentObserver;

struct Growth {
  std::vector<double> of_directions;
  double determinants = 0;  ///< ln |det| of all impacts, in closed form
  int touched = 0;          ///< impacts at the least separation speed
};

/// All directions of a run over so many impacts.
Growth growth_of(const casefile::CaseSpec& spec, std::size_t impacts, double restitution,
    double min_tangential) {
  const auto built = casefile::build_case<double>(spec);
  engine::Simulation<double> simulation(built.the_case, built.states, built.start);
  Spectrum spectrum(built.the_case.mill, built.the_case.balls, built.start, 9000);
  EXPECT_EQ(spectrum.directions(), 9 * built.states.size());
  Growth growth;
  TangentObserver observer(impacts, [&](const auto& at, const auto& bodies, const auto& impact) {
    if (impact.with_wall)
      spectrum.with_wall(at, impact.partner, bodies[0]);
    else
      spectrum.of_pair(at, bodies[0], bodies[1]);
    const double e_t = impact.outcome.restitution_tangential;
    // A flight keeps volumes. Of an impact the normal gives e_n twice, from the speed and, since
    // motions nearby meet later, from the place; a slip that sticks e_t twice, and one that slides
    // once: its length keeps its differences.
    growth.determinants +=
        2 * std::log(restitution) + (e_t == min_tangential ? 2 : 1) * std::log(std::abs(e_t));
    growth.touched += impact.outcome.least_separation;
    spectrum.orthonormalise(at.time);
  });
  simulation.attach(observer);
  simulation.run_until(Instant<double>::never());
  growth.of_directions = spectrum.growth();
  return growth;
}

TEST(Spectrum, SumsToTheDeterminantsOfTheImpacts) {
  for (const int count : {1, 4})
    for (const double restitution : {0.7, 0.95}) {
      const auto text = testing::spex_text("end_time = \"9 s\"\nseed = 5",
          "restitution = " + std::to_string(restitution) + "\nmin_tangential = -0.6",
          testing::batch(count, "9 mm", "random_speed = \"1 m/s\"\n"));
      const auto growth = growth_of(casefile::parse_case(text, "sum.toml"), 40, restitution, -0.6);
      EXPECT_EQ(growth.touched, 0);
      double sum = 0;
      for (const double g : growth.of_directions) sum += g;
      EXPECT_NEAR(sum, growth.determinants, 1e-9 * std::abs(growth.determinants))
          << count << " balls";
    }
}

/// An impact at the least separation speed takes a direction away. Balls that do not meet each
/// other lose one each; what is left of a lost one is rounding, and no exponent.
TEST(Spectrum, LosesADirectionOfEachBallThatHopsByItself) {
  for (const int balls : {1, 2, 3}) {
    std::string text =
        "[run]\nend_time = \"99 s\"\ngravity = \"9.81 m/s2\"\n[mill]\ntype = "
        "\"still\"\n[vessel]\ntype = "
        "\"box\"\nsize = [\"40 mm\", "
        "\"100 mm\", \"40 mm\"]\n[contact]\nrestitution = 0.5\nfriction = 0.2\nleast_separation = "
        "\"1 "
        "cm/s\"\n";
    for (int k = 0; k < balls; ++k)
      text += "[[ball]]\ndiameter = \"8 mm\"\nposition = [\"" + std::to_string(30 * k - 30) +
          " mm\", \"0 mm\", \"" + std::to_string(3 * k) +
          " mm\"]\nspin = [\"1 rad/s\", \"0 rad/s\", \"2 rad/s\"]\n";
    const auto growth = growth_of(casefile::parse_case(text, "hops.toml"), 300, 0.5, -1);
    EXPECT_GT(growth.touched, 100);
    int lost = 0;
    for (const double g : growth.of_directions) lost += std::isinf(g);
    EXPECT_EQ(lost, balls);
    for (const double g : growth.of_directions) EXPECT_TRUE(std::isinf(g) || g > -300 * 5) << g;
  }
}

/// Impacts of elastic, smooth balls of one mass keep the symplectic form of places and velocities:
/// the growth factors of any stretch of a run, the singular values of its derivative, are pairs of
/// numbers and their inverses.
TEST(Spectrum, PairsInAnElasticSmoothGas) {
  const auto spec = casefile::parse_case(
      "[run]\nend_time = \"99 s\"\n[mill]\ntype = \"still\"\n[vessel]\ntype = \"box\"\nsize = "
      "[\"33 mm\", "
      "\"57 mm\", "
      "\"36 mm\"]\n[contact]\nrestitution = 1\nfriction = 0\nleast_separation = \"0 "
      "m/s\"\n[[balls]]\ncount "
      "= 5\n"
      "diameter = \"12 mm\"\nrandom_speed = \"1 m/s\"\n",
      "gas.toml");
  const auto built = casefile::build_case<double>(spec);
  const std::size_t balls = built.states.size();
  engine::Simulation<double> simulation(built.the_case, built.states, built.start);
  const TangentMap map(built.the_case.mill, built.the_case.balls);
  const auto places = static_cast<Eigen::Index>(3 * balls);
  // Each ball's derivative in all directions; lengths in centimetres and times so that factors are
  // of one size.
  constexpr double length = 0.01, speed = 1;
  std::vector<std::vector<Tangent<double>>> tangents(
      balls, std::vector<Tangent<double>>(6 * balls));
  for (std::size_t k = 0; k < balls; ++k)
    for (int axis = 0; axis < 3; ++axis) {
      tangents[k][3 * k + static_cast<std::size_t>(axis)].position[axis] = length;
      tangents[k][3 * (balls + k) + static_cast<std::size_t>(axis)].velocity[axis] = speed;
    }
  std::vector<Instant<double>> since(balls, built.start);
  const auto fly = [&](int ball, const Instant<double>& to) {
    auto& when = since[static_cast<std::size_t>(ball)];
    for (auto& t : tangents[static_cast<std::size_t>(ball)])
      t.fly(simulation.clock().elapsed(when, to));
    when = to;
  };
  Instant<double> last = built.start;
  TangentObserver observer(30, [&](const auto& at, const auto& bodies, const auto& impact) {
    auto& of_one = tangents[static_cast<std::size_t>(impact.ball)];
    fly(impact.ball, at.time);
    if (impact.with_wall) {
      map.with_wall(at, impact.partner, bodies[0], of_one);
    } else {
      fly(impact.partner, at.time);
      map.of_pair(
          at, bodies[0], bodies[1], of_one, tangents[static_cast<std::size_t>(impact.partner)]);
    }
    last = at.time;
  });
  simulation.attach(observer);
  simulation.run_until(Instant<double>::never());
  Eigen::MatrixXd derivative(2 * places, 2 * places);
  for (std::size_t k = 0; k < balls; ++k) {
    fly(static_cast<int>(k), last);
    for (std::size_t d = 0; d < 6 * balls; ++d)
      for (int axis = 0; axis < 3; ++axis) {
        const auto row = static_cast<Eigen::Index>(3 * k) + axis,
                   column = static_cast<Eigen::Index>(d);
        derivative(row, column) = tangents[k][d].position[axis] / length;
        derivative(places + row, column) = tangents[k][d].velocity[axis] / speed;
      }
  }
  const Eigen::VectorXd factors = derivative.jacobiSvd().singularValues();
  EXPECT_GT(factors[0], 100);
  for (Eigen::Index k = 0; k < places; ++k)
    EXPECT_NEAR(
        std::log(factors[k]), -std::log(factors[2 * places - 1 - k]), 1e-6 * std::log(factors[0]))
        << k;
}

}  // namespace
}  // namespace edmill::tangent
