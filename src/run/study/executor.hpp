// Execution of runs on all threads of all ranks, longest first, and a forecast of their time.
#pragma once

#include <atomic>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/archive.hpp"
#include "study/run_record.hpp"

namespace edmill::study {

/// The processes under mpirun; a single one without it. Starts and ends MPI; at most one at a time.
class Ranks {
 public:
  Ranks();
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }

  void send(int to, const std::string& text) const;
  /// A message that has arrived, and its source; does not wait for one.
  std::optional<std::pair<int, std::string>> receive() const;
 private:
  int rank_ = 0, size_ = 1;
};

struct Job {
  std::string case_file;
  std::vector<std::string> overrides;
  std::string digest;  ///< of the case that these give
  double cost = 0;     ///< balls times simulated time: about in proportion to processor time
  /// Start and end of the run [s]; the end is infinite if only other rules stop it.
  double initial_time = 0, end_time = std::numeric_limits<double>::infinity();
  /// Processor time after which the run ends without a result [s].
  double max_cpu_time = std::numeric_limits<double>::infinity();

  /// Saves or loads the data that another rank needs.
  void archive(Archive& a) { a(case_file, overrides, digest, max_cpu_time); }
};

/// Does a run; called in several threads at once. An exception becomes the record of a failed run.
using RunFunction = std::function<RunRecord(const Job&)>;
/// Takes the record of a run that has ended.
using RecordFunction = std::function<void(const RunRecord&)>;

/// Threads of this process that do jobs.
class Workers;

/// The side of rank 0: distributes jobs and collects their records, in the thread that calls `run`.
class Executor {
 public:
  /// @param threads  of each rank; 0 for all cores
  Executor(Ranks& ranks, int threads, RunFunction run, std::atomic<bool>& interrupt);
  ~Executor();
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;

  /// Does all jobs; returns early, with the finished ones, when it is interrupted.
  /// @param done  called with every record, in any order
  /// @param tick  called regularly
  void run(std::vector<Job> jobs, const RecordFunction& done, const std::function<void()>& tick);

  bool interrupted() const { return interrupt_; }
  /// Number of threads of all ranks that have reported.
  int threads() const;
 private:
  bool hand_out(Job& job);
  void take_messages(const RecordFunction& done);
  void take(const RunRecord& record, const RecordFunction& done);

  Ranks& ranks_;
  std::atomic<bool>& interrupt_;
  std::unique_ptr<Workers> workers_;
  std::vector<int> free_slots_;  ///< of each other rank
  int threads_elsewhere_ = 0;    ///< of other ranks
  std::size_t running_ = 0;
};

/// How long jobs will take, from short trials of some of them.
class Forecast {
 public:
  /// Runs at most `trials` of the jobs for `trial_time` [s] of processor time each, of all costs.
  /// @param done  called with the records of completed trials, which are results like any others
  void make(const std::vector<Job>& jobs, Executor& executor, const RecordFunction& done);

  /// Processor time of a job [s]; empty if its end is not known beforehand.
  std::optional<double> seconds(const Job& job) const;
  /// Wall time of jobs on so many threads [s].
  std::optional<double> wall_time(const std::vector<Job>& jobs, int threads) const;
 private:
  static constexpr std::size_t trials = 12;
  static constexpr double trial_time = 0.25;

  std::map<double, double> rates_;  ///< processor time over cost, by cost of a tried job
};

/// "about 1:20 min".
std::string in_words(double wall_time);

/// The side of every other rank: does the jobs of rank 0 until it sends stop.
void serve(Ranks& ranks, int threads, const RunFunction& run, std::atomic<bool>& interrupt);

}  // namespace edmill::study
