// A simulation that was saved and loaded continues with the same bits.
#include <gtest/gtest.h>

#include <set>

#include "event_recorder.hpp"
#include "spex_case.hpp"

namespace edmill::engine {
namespace {

template <class Real> struct Followed {
  explicit Followed(const casefile::CaseSpec& spec)
      : built(casefile::build_case<Real>(spec)),
        simulation(built.the_case, built.states, built.start) {
    simulation.attach(recorder);
  }
  void go_to(int milliseconds) {
    simulation.run_until(simulation.clock().at(Real(milliseconds) / 1000));
  }

  casefile::InitialCase<Real> built;
  Simulation<Real> simulation;
  testing::EventRecorder<Real> recorder;
};

template <class Real> bool same(const Vec3<Real>& a, const Vec3<Real>& b) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

template <class Real> bool same(const Impact<Real>& a, const Impact<Real>& b) {
  return a.index == b.index && a.time == b.time && a.ball == b.ball && a.with_wall == b.with_wall &&
      a.partner == b.partner && a.outcome.least_separation == b.outcome.least_separation &&
      a.overlap == b.overlap && same(a.normal, b.normal) &&
      same(a.velocity_before[0], b.velocity_before[0]) &&
      same(a.spin_before[0], b.spin_before[0]) && a.flight_time[0] == b.flight_time[0] &&
      a.outcome.milling_dose == b.outcome.milling_dose &&
      a.outcome.supplied_energy == b.outcome.supplied_energy &&
      a.outcome.wall_work == b.outcome.wall_work;
}

template <class Real>
void expect_same_impacts(const Followed<Real>& one, const Followed<Real>& other) {
  const auto &a = one.recorder.impacts, &b = other.recorder.impacts;
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) ASSERT_TRUE(same(a[k], b[k])) << "impact " << k;
}

template <class Real>
void expect_same_course(const casefile::CaseSpec& spec, int first, int last, std::size_t at_least) {
  Followed<Real> one(spec);
  one.go_to(first);
  Archive saved;
  saved(one.simulation);
  one.recorder.impacts.clear();

  Followed<Real> other(spec);
  other.go_to(first / 2);  // its previous state must not matter
  other.recorder.impacts.clear();
  Archive loaded(saved.bytes());
  loaded(other.simulation);
  loaded.finish();
  EXPECT_TRUE(one.simulation.now() == other.simulation.now());

  one.go_to(last);
  other.go_to(last);
  EXPECT_GE(one.recorder.impacts.size(), at_least);
  expect_same_impacts(one, other);
  for (int i = 0; i < one.simulation.ball_count(); ++i) {
    const auto x = one.simulation.state_at(i, one.simulation.now()),
               y = other.simulation.state_at(i, other.simulation.now());
    ASSERT_TRUE(
        same(x.position, y.position) && same(x.velocity, y.velocity) && same(x.spin, y.spin))
        << i;
  }
  const auto &c = one.simulation.counts(), &d = other.simulation.counts();
  EXPECT_EQ(c.impacts, d.impacts);
  EXPECT_EQ(c.stale_events, d.stale_events);
  EXPECT_EQ(c.cell_crossings, d.cell_crossings);
  EXPECT_EQ(c.wall_searches, d.wall_searches);
  EXPECT_EQ(c.simultaneous_contacts, d.simultaneous_contacts);
  EXPECT_TRUE(c.deepest_overlap == d.deepest_overlap);
  const auto e = one.simulation.escalations(), f = other.simulation.escalations();
  ASSERT_EQ(e.size(), f.size());
  for (std::size_t k = 0; k < e.size(); ++k)
    EXPECT_TRUE(e[k].scalar == f[k].scalar && e[k].wall == f[k].wall && e[k].pair == f[k].pair &&
        e[k].order == f[k].order);
}

casefile::CaseSpec many_balls(int count) {
  return casefile::parse_case(testing::spex_text("end_time = \"1 s\"", "restitution = 0.6",
                                  testing::batch(count, "2 mm",
                                      "diameter_spread = \"0.5 mm\"\ngap_ball = \"0.1 mm\"\n"
                                      "gap_wall = \"0.1 mm\"\nrandom_speed = \"1 m/s\"\n")),
      "many.toml");
}

/// Rows of a crystal, all alike: many contacts at the same time, whose order is that of the cells
/// and the queue.
casefile::CaseSpec crystal() {
  std::string balls;
  for (int x = -3; x <= 3; ++x)
    for (int y = -3; y <= 3; ++y)
      for (int z = -1; z <= 1; ++z) {
        const auto component = [](int k, int base) { return std::to_string(base + 4 * k) + " mm"; };
        balls += "[[ball]]\ndiameter = \"3 mm\"\nposition = [\"" + component(x, 0) + "\", \"" +
            component(y, 100) + "\", \"" + component(z, 0) + "\"]\nvelocity = [\"" +
            std::to_string(x % 2) + " m/s\", \"0 m/s\", \"0 m/s\"]\n";
      }
  return casefile::parse_case(
      "[run]\nend_time = \"1 s\"\n[mill]\ntype = \"still\"\narm = \"10 cm\"\n[vessel]\ndiameter = "
      "\"60 mm\"\n"
      "height = \"60 mm\"\n[contact]\nrestitution = 1\nfriction = 0\n" +
          balls,
      "crystal.toml");
}

TEST(Checkpoint, GoesOnWithTheSameBitsInDouble) {
  expect_same_course<double>(testing::demo_spec(), 400, 900, 5000);
}
TEST(Checkpoint, GoesOnWithTheSameBitsInFloat128) {
  expect_same_course<float128>(testing::demo_spec(), 60, 120, 500);
}
TEST(Checkpoint, GoesOnWithTheSameBitsInMpfr50) {
  expect_same_course<mpfr>(testing::demo_spec(), 60, 120, 500);
}
TEST(Checkpoint, GoesOnWithTheSameBitsInDoubleWithCells) {
  expect_same_course<double>(many_balls(500), 100, 200, 10000);
}
TEST(Checkpoint, GoesOnWithTheSameBitsInFloat128WithCells) {
  expect_same_course<float128>(many_balls(100), 30, 60, 200);
}
TEST(Checkpoint, GoesOnWithTheSameBitsInMpfr50WithCells) {
  expect_same_course<mpfr>(many_balls(100), 30, 60, 200);
}
TEST(Checkpoint, KeepsTheOrderOfEventsAtTheSameTime) {
  Followed<double> probe(crystal());
  probe.go_to(20);
  std::set<std::pair<std::int64_t, double>> times;
  for (const auto& impact : probe.recorder.impacts)
    times.emplace(impact.time.period, impact.time.offset);
  ASSERT_LT(times.size(), probe.recorder.impacts.size());  // there are such events
  expect_same_course<double>(crystal(), 10, 40, 100);
}

/// Saving renumbers the impacts, among other things.
void expect_saving_changes_nothing(
    const casefile::CaseSpec& spec, int milliseconds, std::size_t at_least) {
  Followed<double> one(spec), other(spec);
  one.go_to(milliseconds);
  for (int now = 1; now <= milliseconds; ++now) {
    other.go_to(now);
    Archive saved;
    saved(other.simulation);
  }
  EXPECT_GE(one.recorder.impacts.size(), at_least);
  expect_same_impacts(one, other);
}
TEST(Checkpoint, SavingChangesNothing) {
  expect_saving_changes_nothing(testing::demo_spec(), 500, 5000);
}
TEST(Checkpoint, SavingChangesNothingWithCells) {
  expect_saving_changes_nothing(many_balls(500), 200, 10000);
}

TEST(Checkpoint, APauseChangesNothing) {
  struct Pauses : Observer<double> {
    void on_impact(const Impact<double>& impact, Simulation<double>& simulation) override {
      if (impact.index % 7 == 0) simulation.request_pause();
    }
  } pauses;
  Followed<double> one(testing::demo_spec()), other(testing::demo_spec());
  one.go_to(300);
  other.simulation.attach(pauses);
  const auto end = other.simulation.clock().at(0.3);
  int paused = 0;
  while (other.simulation.run_until(end) == EndReason::paused) ++paused;
  EXPECT_GT(paused, 100);
  expect_same_impacts(one, other);
}

TEST(Checkpoint, AnInterruptIsSeenBeforeTheNextEvent) {
  struct Interrupts : Observer<double> {
    void on_impact(const Impact<double>& impact, Simulation<double>&) override {
      asked = impact.index == 50;
    }
    std::atomic<bool> asked = false;
  } interrupts;
  Followed<double> whole(testing::demo_spec()), cut(testing::demo_spec());
  whole.go_to(300);
  cut.simulation.attach(interrupts);
  const auto end = cut.simulation.clock().at(0.3);
  EXPECT_EQ(cut.simulation.run_until(end, &interrupts.asked), EndReason::interrupted);
  ASSERT_FALSE(cut.recorder.impacts.empty());
  EXPECT_EQ(cut.recorder.impacts.back().index, 50);
  EXPECT_TRUE(cut.simulation.now() ==
      cut.recorder.impacts.back().time);  // nor a later event of another kind

  interrupts.asked = false;
  EXPECT_EQ(cut.simulation.run_until(end, &interrupts.asked), EndReason::end_time);
  expect_same_impacts(whole, cut);
}

TEST(Checkpoint, AnInterruptDuringTheFirstPredictionsEndsThem) {
  const std::atomic<bool> interrupt = true;
  const auto built = casefile::build_case<double>(testing::demo_spec());
  EXPECT_THROW(
      Simulation<double>(built.the_case, built.states, built.start, &interrupt), InterruptedError);
}

}  // namespace
}  // namespace edmill::engine
