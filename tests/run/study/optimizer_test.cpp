// The search on a made-up mill whose best point is known.
#include "study/optimizer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "io/summary.hpp"
#include "program.hpp"

namespace edmill {
namespace {

namespace fs = std::filesystem;

class Optimizer : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    fs::copy_file(fs::path(EDMILL_SOURCE_DIR) / "docs/examples/demo.toml", scratch / "demo.toml");
  }

  casefile::OptimizeSpec spec(const std::string& text) const {
    write("o.toml", "[optimize]\ncase = \"demo.toml\"\n" + text);
    return casefile::read_optimize(scratch / "o.toml");
  }

  /// Specific dose rate 100 - (d - peak)^2 + noise, d in mm; noise of a seed and a diameter is
  /// always the same.
  static study::RunRecord made_up(const study::Job& job, double peak, double noise) {
    double d = 0;
    for (const auto& o : job.overrides)
      if (o.starts_with("balls.0.diameter=")) d = std::stod(o.substr(17));
    const double chance =
        static_cast<double>(std::hash<std::string>{}(job.digest) % 1000) / 1000 - 0.5;
    io::Summary<double> s;
    s.provenance.case_digest = job.digest;
    s.end_time = 1;
    s.powder_mass = s.ball_mass = 1;
    s.milling_dose = 100 - (d - peak) * (d - peak) + noise * chance;
    return study::record_of(io::facts_of(s));
  }

  struct Found {
    study::Optimum optimum;
    std::vector<study::Point> points;
    std::string table;
  };
  Found search(const casefile::OptimizeSpec& spec, double peak, double noise, int threads) const {
    std::atomic<bool> interrupt{false};
    study::Ranks ranks;
    study::Executor executor(
        ranks, threads, [=](const study::Job& job) { return made_up(job, peak, noise); },
        interrupt);
    const fs::path out = scratch / "out";
    fs::remove_all(out);
    study::Study study(spec, out, "optimize", executor, false);
    const auto optimum = study::optimize(spec, study);
    return {optimum, study.points(), contents(out / "optimize.csv")};
  }

  const std::string diameter =
      "[[optimize.variable]]\nkey = \"balls.0.diameter\"\nlow = \"2 mm\"\nhigh = \"8 mm\"\n";
};

double diameter_of(const study::Point& point) { return std::stod(point.settings[0].second); }

TEST_F(Optimizer, FindsThePeakBetweenThePointsOfTheFirstGrid) {
  const auto s = spec("runs_max = 200\npoints = 4\nrefinements = 3\n" + diameter);
  const auto found = search(s, 4.7, 0.001, 2);
  ASSERT_TRUE(found.optimum.best);
  EXPECT_NEAR(diameter_of(found.points[*found.optimum.best]), 4.75, 1e-9);
  EXPECT_TRUE(found.optimum.contenders.empty());
}

TEST_F(Optimizer, EndsOfRangesAreExact) {
  for (const auto& [low, high] :
      {std::pair{"0.06", "0.9"}, {"0.1", "0.7"}, {"0.123456789", "0.987654321"}})
    for (const auto* points : {"2", "3", "8"}) {
      const auto s =
          spec(std::string("runs_max = 100\nreplicas_first = 2\nrefinements = 0\npoints = ") +
              points + "\n[[optimize.variable]]\nkey = \"contact.restitution\"\nlow = " + low +
              "\nhigh = " + high);
      const auto found = search(s, 5, 5, 1).points;
      EXPECT_EQ(found.front().settings[0].second, low) << points;
      EXPECT_EQ(found.back().settings[0].second, high) << points;
    }
}

TEST_F(Optimizer, PointsThatNoiseHidesAreContendersAndGetMoreRuns) {
  const auto s =
      spec("runs_max = 200\npoints = 4\nrefinements = 0\nreplicas_max = 12\n" + diameter);
  const auto found = search(s, 5.0, 20, 2);  // 4 mm and 6 mm are equal
  ASSERT_TRUE(found.optimum.best);
  const auto best = *found.optimum.best;
  EXPECT_EQ(found.points[best].runs.size(), 12u);
  const std::size_t twin = best == 1 ? 2 : 1;
  EXPECT_TRUE(best == 1 || best == 2);
  EXPECT_NE(std::find(found.optimum.contenders.begin(), found.optimum.contenders.end(), twin),
      found.optimum.contenders.end());
}

TEST_F(Optimizer, ThreadsDoNotChangeTheSearch) {
  const auto s = spec("runs_max = 150\npoints = 5\n" + diameter);
  const auto one = search(s, 4.3, 3, 1), three = search(s, 4.3, 3, 3);
  EXPECT_EQ(one.optimum.best, three.optimum.best);
  EXPECT_EQ(one.table, three.table);
}

TEST_F(Optimizer, TheBudgetIsNeverExceeded) {
  for (const auto budget : {1, 7, 12, 20, 31}) {
    const auto s = spec("runs_max = " + std::to_string(budget) + "\npoints = 3\n" + diameter);
    std::size_t runs = 0;
    if (budget < 3) {
      EXPECT_THROW(search(s, 5, 5, 1), InputError);
      continue;
    }
    for (const auto& point : search(s, 5, 5, 1).points) runs += point.runs.size();
    EXPECT_LE(runs, static_cast<std::size_t>(budget));
  }
}

TEST_F(Optimizer, TellsALargeChargeFromASmallOneInARealMill) {
  write("o.toml",
      "[optimize]\ncase = \"demo.toml\"\nruns_max = 20\n"
      "[[optimize.variable]]\nkey = \"charge_ratio\"\nvalues = [1, 3]\n"
      "[[optimize.variable]]\nkey = \"run.end_time\"\nvalues = [\"1.5 s\"]\n");
  const auto one = edmill("optimize o.toml --out one --jobs 1"),
             two = edmill("optimize o.toml --out two --jobs 2");
  EXPECT_EQ(one.code, 0) << one.err;
  EXPECT_NE(one.out.find("point 2: charge_ratio = 3"), std::string::npos) << one.out;
  EXPECT_NE(one.out.find("every other point is smaller"), std::string::npos) << one.out;
  EXPECT_NE(one.out.find(" ± "), std::string::npos) << one.out;
  for (const auto* name : {"optimize.csv", "runs.csv", "optimize.h5"})
    EXPECT_TRUE(contents(scratch / "one" / name) == contents(scratch / "two" / name)) << name;
}

}  // namespace
}  // namespace edmill
