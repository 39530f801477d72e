// Forecasts of made-up runs whose processor times are known.
#include <gtest/gtest.h>

#include <cmath>
#include <mutex>
#include <random>

#include "io/summary.hpp"
#include "study/executor.hpp"

namespace edmill::study {
namespace {

/// A run of n balls over t seconds takes `pace` n^1.2 t seconds of processor time.
struct Made {
  double pace = 0.01;
  std::mutex mutex;
  double taken = 0;  ///< by all runs

  static double balls(const Job& job) { return job.cost / (job.end_time - job.initial_time); }
  double seconds(const Job& job) const {
    return pace * std::pow(balls(job), 1.2) * (job.end_time - job.initial_time);
  }
  RunRecord run(const Job& job) {
    const double all = seconds(job), own = std::min(all, job.max_cpu_time);
    io::Summary<double> s;
    s.provenance.case_digest = job.digest;
    s.end_reason = own < all ? model::EndReason::max_cpu_time : model::EndReason::end_time;
    s.cpu_seconds = own;
    s.end_time = job.initial_time + (job.end_time - job.initial_time) * own / all;
    const std::lock_guard lock(mutex);
    taken += own;
    return record_of(io::facts_of(s));
  }
};

Job job_of(int number, double balls, double duration) {
  Job job;
  job.digest = std::to_string(number);
  job.initial_time = 2;
  job.end_time = 2 + duration;
  job.cost = balls * duration;
  return job;
}

TEST(Forecast, IsNearTheTruthForJobsOfAllSizes) {
  std::mt19937_64 random(20261126);
  std::uniform_real_distribution<double> power(0, 1);
  for (int trial = 0; trial < 100; ++trial) {
    Made made;
    std::atomic<bool> interrupt{false};
    Ranks ranks;
    Executor executor(
        ranks, 2, [&](const Job& job) { return made.run(job); }, interrupt);
    std::vector<Job> jobs;
    const auto count = 1 + static_cast<int>(60 * power(random));
    for (int k = 0; k < count; ++k)
      jobs.push_back(job_of(k, std::pow(1000, power(random)), 10 * std::pow(10, power(random))));
    Forecast forecast;
    std::size_t ended = 0;
    forecast.make(jobs, executor, [&](const RunRecord& r) { ended += r.done(); });
    EXPECT_LE(made.taken, 12 * 0.25 + 1e-9);  // the trials are short
    double all = 0;
    for (const auto& job : jobs) {
      const auto own = forecast.seconds(job);
      ASSERT_TRUE(own);
      all += made.seconds(job);
    }
    const auto found = forecast.wall_time(jobs, 1);
    ASSERT_TRUE(found);
    EXPECT_NEAR(std::log(*found / all), 0, std::log(1.5))
        << "trial " << trial << ", " << count << " runs";
    EXPECT_GE(*forecast.wall_time(jobs, 64), *found / 64);
  }
}

TEST(Forecast, IsNoneWhereOnlyAStopRuleEndsARun) {
  Made made;
  std::atomic<bool> interrupt{false};
  Ranks ranks;
  Executor executor(
      ranks, 1, [&](const Job& job) { return made.run(job); }, interrupt);
  auto open = job_of(1, 1000, 10);
  const auto closed = job_of(2, 1000, 10);
  open.end_time = std::numeric_limits<double>::infinity();
  Forecast forecast;
  forecast.make({closed}, executor, [](const RunRecord&) {});
  EXPECT_TRUE(forecast.seconds(closed));
  EXPECT_FALSE(forecast.seconds(open));
  EXPECT_FALSE(forecast.wall_time({closed, open}, 2));
}

TEST(Forecast, OfALimitedRunIsItsLimit) {
  Made made;
  std::atomic<bool> interrupt{false};
  Ranks ranks;
  Executor executor(
      ranks, 1, [&](const Job& job) { return made.run(job); }, interrupt);
  auto job = job_of(1, 1000, 10);
  ASSERT_GT(made.seconds(job), 100);
  job.max_cpu_time = 7;
  Forecast forecast;
  forecast.make({job}, executor, [](const RunRecord&) {});
  EXPECT_NEAR(*forecast.seconds(job), 7, 1e-9);
}

}  // namespace
}  // namespace edmill::study
