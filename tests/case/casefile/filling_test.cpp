// Every charge that fits is placed, whatever the vessel, the seed and the scalar.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iostream>

#include "casefile/random.hpp"
#include "core.hpp"

namespace edmill::casefile {
namespace {

const char* const vessels[] = {
    "type = \"cylinder\"\ndiameter = \"38 mm\"\nheight = \"57 mm\"",
    "type = \"box\"\nsize = [\"30 mm\", \"57 mm\", \"40 mm\"]",
    "type = \"sphere\"\ndiameter = \"50 mm\"",
    "type = \"capsule\"\ndiameter = \"38 mm\"\nheight = \"70 mm\"",
    "type = \"rounded_cylinder\"\ndiameter = \"40 mm\"\nheight = \"60 mm\"\nedge_radius = \"8 mm\"",
    "type = \"polyhedron\"\nvertex = [{at = [\"30 mm\", \"0 mm\", \"0 mm\"]}, {at = [\"-30 mm\", "
    "\"0 mm\", "
    "\"0 mm\"]}, {at = [\"0 mm\", \"35 mm\", \"0 mm\"]}, {at = [\"0 mm\", \"-35 mm\", \"0 mm\"]}, "
    "{at = [\"0 "
    "mm\", \"0 mm\", \"32 mm\"]}, {at = [\"0 mm\", \"0 mm\", \"-32 mm\"]}]",
};

CaseSpec with_balls(const std::string& vessel, const std::string& balls, std::uint64_t seed) {
  return parse_case("[run]\nend_time = \"1 s\"\nseed = " + std::to_string(seed) +
          "\n[mill]\ntype = \"vibratory\"\namplitude = [0, 0, 0]\nspeed = \"900 rpm\"\n[vessel]\n" +
          vessel + "\n[contact]\nrestitution = 0.5\nfriction = 0.4\n" + balls,
      "filling.toml");
}

/// No two balls overlap, and all are inside.
template <class Real> void expect_free(const InitialCase<Real>& built, const std::string& what) {
  const auto& mill = built.the_case.mill;
  const auto pose = mill.motion.pose(built.start);
  for (std::size_t i = 0; i < built.states.size(); ++i) {
    const auto& one = built.states[i];
    const Real& radius = built.the_case.balls[i].radius;
    const auto local = mill.motion.to_vessel_frame(pose, one.position, one.velocity).position;
    ASSERT_TRUE(mill.vessel.inset(radius).contains(local)) << what << ", ball " << i;
    for (std::size_t j = 0; j < i; ++j)
      ASSERT_GT(norm<Real>(one.position - built.states[j].position),
          radius + built.the_case.balls[j].radius)
          << what << ", balls " << i << " and " << j;
  }
}

/// Loose enough for so many balls: a few large ones leave more of a vessel empty.
double densest(int count) { return std::min(0.5, 0.62 * (1 - 1.1 / std::cbrt(count))); }

void try_placements(int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> spent;
  for (int k = 0; k < count; ++k) {
    const std::string vessel = vessels[k % std::size(vessels)];
    const int balls = static_cast<int>(std::pow(10, 0.7 + 2.3 * random.uniform<double>()));
    const double packing = densest(balls) * (0.2 + 0.8 * random.uniform<double>());
    const double volume = static_cast<double>(build_mill<double>(
        with_balls(vessel, "[[ball]]\ndiameter = \"1 mm\"\nposition = [0, 0, 0]\n", 1))
                                                  .vessel.volume());
    const double diameter = std::cbrt(6 * packing * volume / (numerics::pi<double>() * balls));
    const auto spec = with_balls(vessel,
        "[[balls]]\ncount = " + std::to_string(balls) + "\ndiameter = \"" +
            std::to_string(1000 * diameter) + " mm\"\n",
        static_cast<std::uint64_t>(random.uniform<double>() * 1e6));
    const std::string what = fmt::format(
        "{}: {} balls at a packing of {:.3f}, seed {}", vessel, balls, packing, spec.seed);
    const auto begin = std::chrono::steady_clock::now();
    try {
      const auto built = build_case<double>(spec);
      spent.push_back(
          std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
      ASSERT_EQ(built.states.size(), static_cast<std::size_t>(balls)) << what;
      expect_free(built, what);
    } catch (const std::exception& error) {
      ADD_FAILURE() << what << ": " << error.what();
    }
  }
  std::sort(spent.begin(), spent.end());
  std::cout << "seed " << seed << ": " << spent.size() << " placements, median "
            << spent[spent.size() / 2] << " s, longest " << spent.back() << " s\n";
}

TEST(Filling, PlacesEveryChargeThatFits) { try_placements(24, 20261127); }
TEST(Filling, LongPlacesEveryChargeThatFits) { try_placements(1000, 20261128); }

/// Ten balls of 12.7 mm in a SPEX leave little room.
TEST(Filling, FewLargeBallsFitForEverySeed) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed)
    expect_free(build_case<double>(with_balls(
                    vessels[0], "[[balls]]\ncount = 10\ndiameter = \"12.7 mm\"\n", seed)),
        "seed " + std::to_string(seed));
}

TEST(Filling, MixturesFitAroundBallsThatAreGiven) {
  const std::string balls =
      "[[ball]]\ndiameter = \"12 mm\"\nposition = [\"10 mm\", \"0\", \"0\"]\n"
      "[[balls]]\ncount = 6\ndiameter = \"10 mm\"\ndiameter_spread = \"0.5 mm\"\nrandom_speed = "
      "\"1 m/s\"\n"
      "[[balls]]\ncount = 300\ndiameter = \"4 mm\"\n";
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const auto spec = with_balls("type = \"sphere\"\ndiameter = \"50 mm\"", balls, seed);
    const auto narrow = build_case<double>(spec);
    expect_free(narrow, "seed " + std::to_string(seed));
    // Places are found in double for every scalar; radii with a spread differ by their rounding.
    const auto wide = build_case<float128>(spec);
    for (std::size_t k = 0; k < narrow.states.size(); ++k)
      EXPECT_LT(
          norm<double>(narrow.states[k].position - vector_cast<double>(wide.states[k].position)),
          1e-12);
  }
}

TEST(Filling, WhatCannotFitByVolumeIsRefusedWithTheLargestCount) {
  try {
    build_case<double>(with_balls(vessels[0], "[[balls]]\ncount = 1000\ndiameter = \"5 mm\"\n", 1));
    FAIL();
  } catch (const InputError& error) {
    // 64.65 cm3 and balls of 65.45 mm3: 0.7405 of the vessel are 731 balls.
    EXPECT_STREQ(error.what(),
        "filling.toml:15: [balls.0]: found balls that fill 1.01 of the vessel's volume, expected "
        "at most "
        "0.741 of it, with at most 731 balls in this batch in place of 1000");
  }
}

TEST(Filling, WhatFindsNoRoomIsRefusedWithHowManyDo) {
  try {
    // Three spheres touch in a plane where the vessel's diameter is 2.1547 of theirs.
    build_case<double>(with_balls("type = \"sphere\"\ndiameter = \"50 mm\"",
        "[[balls]]\ncount = 3\ndiameter = \"24 mm\"\n", 1));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("found 3 balls at a packing fraction of 0.332, expected fewer: only the "
                        "first 2 fit"),
        std::string::npos)
        << error.what();
  }
}

TEST(Filling, ABallAsLargeAsItsVesselIsRefused) {
  EXPECT_THROW(build_case<double>(with_balls("type = \"sphere\"\ndiameter = \"46 mm\"",
                   "[[ball]]\ndiameter = \"46 mm\"\nposition = [0, 0, 0]\n", 1)),
      InputError);
}

}  // namespace
}  // namespace edmill::casefile
