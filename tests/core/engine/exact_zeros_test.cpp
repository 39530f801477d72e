// Balls and walls that touch exactly, many with exactly no relative velocity along their normals,
// at the start and after impacts without restitution: sizes and velocities are small multiples of
// powers of two, normals have the directions of axes and of right-angled triangles with whole
// sides. No scalar decides such contacts, exact arithmetic does.
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "base/errors.hpp"
#include "casefile/random.hpp"
#include "core.hpp"

namespace edmill::engine {
namespace {

using Sharp = mpfr_of<200>;

int clusters_of_each_scalar() {
  const char* number = std::getenv("EDMILL_EXACT_ZEROS");
  return number ? std::atoi(number) : 800;
}

constexpr double unit = 1.0 / 1024, room = 64 * unit;  // [m], half an edge of the box

/// In whole numbers of units [m] and of units in a second.
struct WholeBall {
  std::array<int, 3> place, velocity;
  int radius;
};

struct WholeCluster {
  std::vector<WholeBall> balls;
  int gravity = 0;  ///< along -y, of units/s^2
  double restitution = 0;
};

class WholeClusters {
 public:
  explicit WholeClusters(std::uint64_t seed) : random_(seed) {}

  WholeCluster draw() {
    WholeCluster c;
    c.restitution = below(3) == 0 ? 0 : below(5) / 4.0;
    c.gravity = below(3) == 0 ? 0 : 8192;
    const std::size_t count = 2 + static_cast<std::size_t>(below(5));
    for (int tries = 0; c.balls.size() < count && tries < 200; ++tries) {
      WholeBall ball{};
      ball.radius = 5;
      if (c.balls.empty() || below(4) == 0) {
        for (int& x : ball.place)
          x = below(3) == 0 ? 59 * (2 * below(2) - 1) : below(101) - 50;  // 59 touches a wall
      } else {
        ball.place =
            beside(c.balls[static_cast<std::size_t>(below(static_cast<int>(c.balls.size())))]);
      }
      if (fits(ball, c.balls)) c.balls.push_back(ball);
    }
    const int kind = below(3);
    for (auto& ball : c.balls)
      for (int& v : ball.velocity)
        v = kind == 0 ? 512 * (below(3) - 1) : kind == 1 ? 0 : 100 * (below(5) - 2);
    return c;
  }
 private:
  int below(int n) { return static_cast<int>(random_.uniform<double>() * n); }
  /// At a distance of ten units.
  std::array<int, 3> beside(const WholeBall& ball) {
    static constexpr int steps[4][3] = {{10, 0, 0}, {6, 8, 0}, {8, 6, 0}, {0, 10, 0}};
    const auto& step = steps[below(4)];
    const int turn = below(3);
    auto place = ball.place;
    for (int k = 0; k < 3; ++k)
      place[static_cast<std::size_t>((k + turn) % 3)] += (2 * below(2) - 1) * step[k];
    return place;
  }
  static bool fits(const WholeBall& ball, const std::vector<WholeBall>& others) {
    for (const int x : ball.place)
      if (x > 59 || x < -59) return false;
    for (const auto& other : others) {
      int square = 0;
      for (std::size_t k = 0; k < 3; ++k)
        square += (ball.place[k] - other.place[k]) * (ball.place[k] - other.place[k]);
      if (square < 100) return false;
    }
    return true;
  }
  casefile::Random random_;
};

/// The time of each contact of the first flights that comes at all [s], by the bodies: ball and
/// partner, walls from -1 downwards.
std::map<std::pair<int, int>, Sharp> contacts_of(const WholeCluster& c) {
  std::map<std::pair<int, int>, Sharp> times;
  const auto add = [&](int ball, int partner, const Sharp& gap, const Sharp& rate,
                       const Sharp& bend) {
    // gap + rate t + bend t^2
    if (gap <= 0 && (rate < 0 || (rate == 0 && bend < 0))) {
      times[{ball, partner}] = 0;
      return;
    }
    if (rate >= 0 && bend >= 0) return;
    const Sharp square = rate * rate - 4 * gap * bend;
    if (square < 0 || (square == 0 && gap > 0)) return;
    const Sharp root = sqrt(square);
    times[{ball, partner}] =
        rate < 0 ? Sharp(2 * gap / (root - rate)) : Sharp((rate + root) / (-2 * bend));
  };
  for (int i = 0; i < static_cast<int>(c.balls.size()); ++i) {
    const auto& ball = c.balls[static_cast<std::size_t>(i)];
    for (std::size_t k = 0; k < 3; ++k)
      for (const int side : {-1, 1})
        add(i, -1 - static_cast<int>(2 * k) - (side > 0), 64 - ball.radius - side * ball.place[k],
            -side * ball.velocity[k], k == 1 ? Sharp(side * c.gravity) / 2 : Sharp(0));
    for (int j = 0; j < i; ++j) {
      const auto& other = c.balls[static_cast<std::size_t>(j)];
      long long r2 = 0, rv = 0, v2 = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const long long r = ball.place[k] - other.place[k],
                        v = ball.velocity[k] - other.velocity[k];
        r2 += r * r, rv += r * v, v2 += v * v;
      }
      if (rv < 0)
        add(i, j, Sharp(static_cast<double>(r2 - 100)), Sharp(static_cast<double>(2 * rv)),
            Sharp(static_cast<double>(v2)));
    }
  }
  return times;
}

template <class Real> struct FewImpacts : Observer<Real> {
  std::optional<Impact<Real>> first;
  int impacts = 0;
  void on_impact(const Impact<Real>& impact, Simulation<Real>& s) override {
    if (!first) first = impact;
    if (++impacts == 40) s.request_stop(EndReason::stopped);
  }
};

template <class Real> class ExactZeros : public ::testing::Test {};
using ZeroScalars = ::testing::Types<double, float128, mpfr>;
TYPED_TEST_SUITE(ExactZeros, ZeroScalars);

TYPED_TEST(ExactZeros, AreDecidedAsWholeNumbersSay) {
  using Real = TypeParam;
  const char* number = std::getenv("EDMILL_EXACT_ZEROS_SEED");
  const std::uint64_t seed = number ? std::strtoull(number, nullptr, 10) : 52;
  WholeClusters clusters(seed);
  int wrong = 0, undecided = 0, at_once = 0, none = 0;
  const int count = clusters_of_each_scalar();
  for (int k = 0; k < count; ++k) {
    const auto cluster = clusters.draw();
    model::Case<Real> the_case;
    the_case.mill.motion = model::ChainMotion<Real>(model::Joints<Real>{{}, Real(1) / 16});
    the_case.mill.vessel = model::BoxVessel<Real>{{Real(room), Real(room), Real(room)}};
    the_case.mill.gravity = {Real(0), Real(-cluster.gravity * unit), Real(0)};
    the_case.mill.ball_ball.law = the_case.mill.ball_wall.law =
        model::WaltonBraun<Real>{.normal = Real(cluster.restitution)};
    std::vector<model::BallState<Real>> states;
    for (const auto& ball : cluster.balls) {
      the_case.balls.push_back({Real(ball.radius * unit), Real(1), Real(2) / 5});
      model::BallState<Real> state{{}, {}, {Real(0), Real(0), Real(0)}};
      for (int axis = 0; axis < 3; ++axis) {
        state.position[axis] = Real(ball.place[static_cast<std::size_t>(axis)] * unit);
        state.velocity[axis] = Real(ball.velocity[static_cast<std::size_t>(axis)] * unit);
      }
      states.push_back(state);
    }
    FewImpacts<Real> watch;
    try {
      Simulation<Real> simulation(the_case, states, {});
      simulation.attach(watch);
      simulation.run_until(simulation.clock().at(Real(1)));
    } catch (const UndecidedError& error) {
      if (++undecided < 4) ADD_FAILURE() << "cluster " << k << ": " << error.what();
      continue;
    }
    const auto times = contacts_of(cluster);
    std::optional<Sharp> first;
    for (const auto& [bodies, time] : times)
      if (!first || time < *first) first = time;
    if (!first || *first > 0.9) {
      none += !first;
      if (!first && watch.first && ++wrong < 10)
        ADD_FAILURE() << "cluster " << k << ": an impact where none comes";
      continue;
    }
    at_once += *first == 0;
    bool right = false;
    if (watch.first) {
      const auto& i = *watch.first;
      const std::pair bodies = i.with_wall
          ? std::pair{i.ball, -1 - i.partner}
          : std::pair{std::max(i.ball, i.partner), std::min(i.ball, i.partner)};
      right = times.count(bodies) > 0 && times.at(bodies) - *first <= *first * 1e-13;
    }
    if (!right && ++wrong < 10)
      ADD_FAILURE() << "cluster " << k << ": first " << (watch.first ? watch.first->ball : -1)
                    << " and " << (watch.first ? watch.first->partner : -1)
                    << ", expected a contact at " << first->str(6) << " s";
  }
  std::cout << count << " clusters, seed " << seed << ": " << at_once << " with an impact at once, "
            << none << " without any\n";
  EXPECT_EQ(undecided, 0);
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace edmill::engine
