#include "study/forecast.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace edmill::study {

namespace {

/// Evenly over the jobs in the order of their costs, the first and the last among them.
std::vector<Job> chosen(std::vector<Job> jobs, std::size_t most) {
  std::stable_sort(jobs.begin(), jobs.end(), [](const Job& a, const Job& b) { return a.cost < b.cost; });
  if (jobs.size() <= most) return jobs;
  std::vector<Job> few;
  for (std::size_t k = 0; k < most; ++k) few.push_back(jobs[k * (jobs.size() - 1) / (most - 1)]);
  return few;
}

}  // namespace

void Forecast::make(const std::vector<Job>& jobs, Executor& executor,
                    const std::function<void(const RunRecord&)>& done) {
  std::map<std::string, Job> tried;
  std::vector<Job> short_jobs;
  for (const auto& job : chosen(jobs, trials)) {
    tried.emplace(job.digest, job);
    short_jobs.push_back(job);
    short_jobs.back().max_cpu_time = std::min(job.max_cpu_time, trial_time);
  }
  const auto take = [&](const RunRecord& record) {
    const auto& job = tried.at(record.digest);
    const double simulated = record.end_time - job.initial_time;
    if (record.lasting()) {
      rates_[job.cost] = record.cpu_seconds / job.cost;
      done(record);
    } else if (simulated > 0 && std::isfinite(job.end_time)) {
      const double all = record.cpu_seconds * (job.end_time - job.initial_time) / simulated;
      rates_[job.cost] = std::min(all, job.max_cpu_time) / job.cost;
    }
  };
  executor.run(std::move(short_jobs), take, [] {});
}

std::optional<double> Forecast::seconds(const Job& job) const {
  if (rates_.empty() || !std::isfinite(job.end_time)) return std::nullopt;
  // The rate changes slowly with the cost: that of the nearest job that was tried.
  auto above = rates_.lower_bound(job.cost);
  if (above == rates_.end() ||
      (above != rates_.begin() && job.cost / std::prev(above)->first < above->first / job.cost))
    --above;
  return above->second * job.cost;
}

std::optional<double> Forecast::wall_time(const std::vector<Job>& jobs, int threads) const {
  double all = 0, longest = 0;
  for (const auto& job : jobs) {
    const auto own = seconds(job);
    if (!own) return std::nullopt;
    all += *own;
    longest = std::max(longest, *own);
  }
  return std::max(all / std::max(threads, 1), longest);
}

std::string in_words(double wall_time) {
  const auto left = static_cast<long>(std::ceil(wall_time));
  if (left >= 3600) return fmt::format("about {} h {:02} min", left / 3600, left / 60 % 60);
  return fmt::format("about {}:{:02} min", left / 60, left % 60);
}

}  // namespace edmill::study
