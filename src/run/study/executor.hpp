// Runs on all threads of all ranks, longest first.
#pragma once

#include <atomic>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "study/ranks.hpp"
#include "study/run_record.hpp"

namespace edmill::study {

struct Job {
  std::string case_file;
  std::vector<std::string> overrides;
  std::string digest;  ///< of the case that these give
  double cost = 0;     ///< balls times simulated time: about in proportion to processor time
  /// Of the run [s]; no end where only other rules stop it.
  double initial_time = 0, end_time = std::numeric_limits<double>::infinity();
  /// Processor time after which the run ends without a result [s].
  double max_cpu_time = std::numeric_limits<double>::infinity();
};

/// Does a run; called in several threads at once. An exception becomes the record of a failed run.
using RunFunction = std::function<RunRecord(const Job&)>;

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
  void run(std::vector<Job> jobs, const std::function<void(const RunRecord&)>& done,
           const std::function<void()>& tick);

  bool interrupted() const { return interrupt_; }
  /// Of all ranks that have reported.
  int threads() const;

 private:
  bool hand_out(const Job& job);
  void take_messages(const std::function<void(const RunRecord&)>& done);
  void take(const RunRecord& record, const std::function<void(const RunRecord&)>& done);

  Ranks& ranks_;
  std::atomic<bool>& interrupt_;
  std::unique_ptr<Workers> workers_;
  std::vector<int> free_slots_;  ///< of each other rank
  int threads_elsewhere_ = 0;    ///< of other ranks
  std::size_t running_ = 0;
};

/// The side of every other rank: does the jobs of rank 0 until it sends stop.
void serve(Ranks& ranks, int threads, const RunFunction& run, std::atomic<bool>& interrupt);

}  // namespace edmill::study
