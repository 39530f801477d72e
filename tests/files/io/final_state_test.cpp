// final_state.csv keeps every bit of every scalar.
#include "io/final_state.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "core.hpp"

namespace edmill {
namespace {

template <class Real> class FinalState : public ::testing::Test {};
using Scalars = ::testing::Types<double, float128, mpfr>;
TYPED_TEST_SUITE(FinalState, Scalars);

TYPED_TEST(FinalState, ReadsBackEveryBit) {
  using Real = TypeParam;
  using std::ldexp;
  // Quotients fill every bit; sizes reach from far below to far above those of a mill.
  int n = 1;
  const auto value = [&] {
    const Real quotient = Real(2 * n + 1) / Real(3 * n + 7);
    const Real sized = ldexp(quotient, (n * 37) % 120 - 60);
    return ++n % 2 ? sized : Real(-sized);
  };
  const DriveClock<Real> clock(Real(60) / Real(1054));
  io::SavedState<Real> saved{{123456789, clock.period() / 3}, {}};
  for (int k = 0; k < 500; ++k) {
    model::BallState<Real> state;
    for (auto* v : {&state.position, &state.velocity, &state.spin}) {
      const Real x = value(), y = value(), z = value();
      *v = Vec3<Real>(x, y, z);
    }
    saved.states.push_back(state);
  }
  saved.states[0].velocity = Vec3<Real>(Real(0), -Real(0), Real(1));
  const auto place = std::filesystem::temp_directory_path() /
      ("edmill-final-state-" + std::to_string(::getpid()) + ".csv");
  {
    std::ofstream out(place, std::ios::binary);
    io::write_final_state<Real>(out, saved, clock);
  }
  const auto found = io::read_final_state<Real>(place.string());
  std::filesystem::remove(place);
  EXPECT_EQ(found.time.period, saved.time.period);
  EXPECT_EQ(found.time.offset, saved.time.offset);
  ASSERT_EQ(found.states.size(), saved.states.size());
  for (std::size_t k = 0; k < saved.states.size(); ++k)
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_EQ(found.states[k].position[axis], saved.states[k].position[axis]) << k;
      ASSERT_EQ(found.states[k].velocity[axis], saved.states[k].velocity[axis]) << k;
      ASSERT_EQ(found.states[k].spin[axis], saved.states[k].spin[axis]) << k;
    }
  std::ostringstream again, before;
  io::write_final_state<Real>(again, found, clock);
  io::write_final_state<Real>(before, saved, clock);
  EXPECT_EQ(again.str(), before.str());
}

}  // namespace
}  // namespace edmill
