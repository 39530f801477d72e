// Derivatives of a run by dual numbers against those by differences in many digits, which share no
// code but the laws.
#include <gtest/gtest.h>

#include "any_mills.hpp"
#include "run/sensitivity.hpp"
#include "tangent_run.hpp"

namespace edmill::tangent {
namespace {

struct Start {
  int ball, coordinate;  ///< x, y, z, vx, vy, vz, wx, wy, wz
  const char* name;
};

/// Derivatives of the states after the first impacts, as `run::sensitivity` has them.
std::vector<std::vector<double>> by_dual_numbers(
    const casefile::CaseSpec& spec, std::size_t impacts, const Start& start) {
  const auto built = casefile::build_case<double>(spec);
  engine::Simulation<double> simulation(built.the_case, built.states, built.start);
  const TangentMap map(built.the_case.mill, built.the_case.balls);
  const DriveClock<double>& clock = simulation.clock();
  std::vector<Tangent<double>> tangents(built.states.size());
  std::vector<Instant<double>> since(built.states.size(), built.start);
  auto& own = tangents[static_cast<std::size_t>(start.ball)];
  (start.coordinate < 3          ? own.position
          : start.coordinate < 6 ? own.velocity
                                 : own.spin)[start.coordinate % 3] = 1;

  std::vector<std::vector<double>> rows;
  testing::TangentObserver observer(
      impacts, [&](const auto& at, const auto& bodies, const auto& impact) {
        const auto of = [&](int place) -> Tangent<double>& {
          return tangents[static_cast<std::size_t>(bodies[place].ball)];
        };
        for (int place = 0; place < (impact.with_wall ? 1 : 2); ++place) {
          auto& when = since[static_cast<std::size_t>(bodies[place].ball)];
          of(place).fly(clock.elapsed(when, at.time));
          when = at.time;
        }
        if (impact.with_wall)
          map.with_wall(at, impact.partner, bodies[0], {&of(0), 1});
        else
          map.of_pair(at, bodies[0], bodies[1], {&of(0), 1}, {&of(1), 1});
        auto& row = rows.emplace_back();
        const bool turned = !impact.with_wall && impact.partner < impact.ball;
        for (int place = turned ? 1 : 0, left = impact.with_wall ? 1 : 2; left > 0;
             place = 1 - place, --left)
          for (const auto* v : {&of(place).position, &of(place).velocity, &of(place).spin})
            row.insert(row.end(), {(*v)[0], (*v)[1], (*v)[2]});
      });
  simulation.attach(observer);
  simulation.run_until(Instant<double>::never());
  return rows;
}

class TangentMaps : public ::testing::TestWithParam<testing::MillText> {};

TEST_P(TangentMaps, AgreeWithDifferencesInManyDigits) {
  constexpr std::size_t impacts = 50;
  const auto spec = testing::spec_of(GetParam(), "end_time = \"20 s\"\nseed = 3",
      "[[balls]]\ncount = 6\ndiameter = \"9 mm\"\nrandom_speed = \"0.3 m/s\"\n");
  for (const Start& start :
      {Start{2, 0, "initial.2.x"}, Start{4, 4, "initial.4.vy"}, Start{1, 8, "initial.1.wz"}}) {
    run::SensitivityOptions options;
    options.by = {start.name};
    options.events = impacts;
    const auto expected = run::sensitivity(spec, options);
    const auto found = by_dual_numbers(spec, impacts, start);
    ASSERT_EQ(found.size(), impacts);
    for (std::size_t k = 0; k < impacts; ++k) {
      std::array<double, 3> largest{}, off{};  // of positions, velocities and spins
      for (std::size_t n = 0; n < found[k].size(); ++n) {
        const auto& t = expected.derivatives[k][0].states_after[n / 9];
        const std::size_t kind = n % 9 / 3;
        const auto& v = kind == 0 ? t.position : kind == 1 ? t.velocity : t.spin;
        const auto exact = static_cast<double>(v[static_cast<int>(n % 3)]);
        largest[kind] = std::max(largest[kind], std::abs(exact));
        off[kind] = std::max(off[kind], std::abs(found[k][n] - exact));
      }
      // The state of the run in double has lost some digits after so many impacts.
      for (std::size_t kind = 0; kind < 3; ++kind)
        EXPECT_LE(off[kind], 1e-7 * largest[kind] + 1e-12)
            << start.name << ", impact " << k << ", kind " << kind;
    }
  }
}

std::vector<testing::MillText> mills() {
  std::vector<testing::MillText> all;
  for (const auto& mill : testing::all_mills)
    if (mill.own == testing::OwnVessel::none) all.push_back(mill);  // whose jar no case file gives
  return all;
}
INSTANTIATE_TEST_SUITE_P(Tangent, TangentMaps, ::testing::ValuesIn(mills()),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace edmill::tangent
