// The reference implementations of the benchmarks are themselves correct simulations of hard
// spheres.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "minimal_loop.hpp"
#include "peer_loop.hpp"
#include "periodic_gas.hpp"

namespace edmill::performance {
namespace {

template <class Loop> class ReferenceLoop : public ::testing::Test {};
using Loops = ::testing::Types<MinimalLoop, PeerLoop>;
TYPED_TEST_SUITE(ReferenceLoop, Loops);

template <class Loop> double deepest_overlap(const Loop& loop) {
  const auto positions = loop.positions();
  double nearest = 2;
  for (std::size_t i = 0; i < positions.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      double squared = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double r = positions[i][k] - positions[j][k];
        const double image = r - loop.box() * std::round(r / loop.box());
        squared += image * image;
      }
      nearest = std::min(nearest, std::sqrt(squared));
    }
  return 1 - nearest;
}

TYPED_TEST(ReferenceLoop, KeepsEnergyAndNeverOverlaps) {
  for (const auto& [balls, packing] :
      {std::pair{30, 0.1}, std::pair{500, 0.26}, std::pair{1000, 0.35}}) {
    TypeParam loop(balls, packing, 7);
    const double energy = loop.kinetic_energy();
    EXPECT_NEAR(energy, 1.5 * (balls - 1), 1e-9 * balls);
    for (int k = 0; k < 20; ++k) {
      loop.run(3007);
      EXPECT_LT(deepest_overlap(loop), 1e-12) << balls << " balls at " << packing;
    }
    EXPECT_EQ(loop.collisions(), 20U * 3007U);
    EXPECT_NEAR(loop.kinetic_energy(), energy, 1e-11 * energy);
  }
}

TYPED_TEST(ReferenceLoop, CollidesAtTheRateOfEnskog) {
  constexpr int balls = 2000;
  for (const double packing : {0.05, 0.1, 0.26, 0.35}) {
    TypeParam loop(balls, packing, 11, packing < 0.2);
    loop.run(30 * balls);
    const double begin = loop.time();
    loop.run(200000);
    const double rate = 2 * 200000 / (loop.time() - begin) / balls;
    EXPECT_NEAR(rate / enskog_rate(packing), 1, 0.02) << "packing " << packing;
  }
}

TYPED_TEST(ReferenceLoop, RefusesWhatItCannotHold) {
  EXPECT_THROW(TypeParam(10, 0.3, 1), std::invalid_argument);    // the box is too small for cells
  EXPECT_THROW(TypeParam(1000, 0.6, 1), std::invalid_argument);  // the lattice is
}

}  // namespace
}  // namespace edmill::performance
