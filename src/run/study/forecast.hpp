// How long the runs of a study will take, from short trials of some of them.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "study/executor.hpp"

namespace edmill::study {

class Forecast {
 public:
  /// Runs at most `trials` of the jobs for `trial_time` [s] of processor time each, of all costs.
  /// @param done  called with the records of trials that got to their end: results as any other
  void make(const std::vector<Job>& jobs, Executor& executor,
            const std::function<void(const RunRecord&)>& done);

  /// Processor time of a job [s]; nothing where its end is not known beforehand.
  std::optional<double> seconds(const Job& job) const;
  /// Wall time of jobs on so many threads [s].
  std::optional<double> wall_time(const std::vector<Job>& jobs, int threads) const;

 private:
  static constexpr std::size_t trials = 12;
  static constexpr double trial_time = 0.25;

  std::map<double, double> rates_;  ///< processor time over cost, by the cost of the job that was tried
};

/// "about 1:20 min".
std::string in_words(double wall_time);

}  // namespace edmill::study
