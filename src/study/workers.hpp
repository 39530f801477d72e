// Threads of this process that do jobs.
#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <vector>

#include "study/executor.hpp"

namespace edmill::study {

class Workers {
 public:
  /// @param threads  0 for all cores
  Workers(int threads, RunFunction run);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  int threads() const { return threads_; }
  bool has_idle() const;
  bool busy() const;
  void start(const Job& job);
  /// Records since the last call; waits briefly for one when jobs are running.
  std::vector<RunRecord> finished(std::chrono::milliseconds wait);

 private:
  RunRecord do_job(const Job& job) const;

  int threads_;
  RunFunction run_;
  tbb::global_control control_;  ///< without it TBB limits itself to the number of cores
  tbb::task_arena arena_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  int running_ = 0;
  std::vector<RunRecord> finished_;
};

}  // namespace edmill::study
