#include "study/executor.hpp"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <sstream>

#include "base/errors.hpp"
#include "base/scalar.hpp"

namespace edmill::study {

namespace {

using std::chrono::milliseconds;

// Messages. From rank 0: "stop", or the lines of a job; to rank 0: a number of threads, or a record.
constexpr const char* stop_message = "stop";
constexpr const char* no_limit = "none";

std::string to_message(const Job& job) {
  const std::string limit = std::isfinite(job.max_cpu_time) ? to_text(job.max_cpu_time) : no_limit;
  std::string text = "job\n" + job.digest + "\n" + limit + "\n" + job.case_file;
  for (const auto& o : job.overrides) text += "\n" + o;
  return text;
}

Job to_job(const std::string& message) {
  Job job;
  std::istringstream lines(message);
  std::string line;
  std::getline(lines, line);
  std::getline(lines, job.digest);
  std::getline(lines, line);
  if (line != no_limit) job.max_cpu_time = from_text<double>(line);
  std::getline(lines, job.case_file);
  while (std::getline(lines, line)) job.overrides.push_back(line);
  return job;
}

}  // namespace

class Workers {
 public:
  /// @param threads  0 for all cores
  Workers(int threads, RunFunction run)
      : threads_(threads > 0 ? threads : tbb::info::default_concurrency()),
        run_(std::move(run)),
        control_(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads_) + 1),
        arena_(threads_, 0) {}
  ~Workers() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return running_ == 0; });
  }
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  int threads() const { return threads_; }
  bool has_idle() const {
    const std::lock_guard lock(mutex_);
    return running_ < threads_;
  }
  bool busy() const {
    const std::lock_guard lock(mutex_);
    return running_ > 0 || !finished_.empty();
  }
  void start(const Job& job) {
    {
      const std::lock_guard lock(mutex_);
      ++running_;
    }
    arena_.enqueue([this, job] {
      auto record = do_job(job);
      const std::lock_guard lock(mutex_);
      finished_.push_back(std::move(record));
      --running_;
      changed_.notify_all();
    });
  }
  /// Records since the last call; waits briefly for one when jobs are running.
  std::vector<RunRecord> finished(milliseconds wait) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, wait, [&] { return !finished_.empty(); });
    return std::exchange(finished_, {});
  }

 private:
  RunRecord do_job(const Job& job) const {
    try {
      return run_(job);
    } catch (const InputError& error) {
      return failed_run(job.digest, "bad_case", error.what());
    } catch (const std::exception& error) {
      return failed_run(job.digest, "error", error.what());
    }
  }

  int threads_;
  RunFunction run_;
  tbb::global_control control_;  ///< without it TBB limits itself to the number of cores
  tbb::task_arena arena_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  int running_ = 0;
  std::vector<RunRecord> finished_;
};

Executor::Executor(Ranks& ranks, int threads, RunFunction run, std::atomic<bool>& interrupt)
    : ranks_(ranks),
      interrupt_(interrupt),
      workers_(std::make_unique<Workers>(threads, std::move(run))),
      free_slots_(static_cast<std::size_t>(ranks.size()), 0) {}

Executor::~Executor() {
  if (running_ > 0) interrupt_ = true;
  for (int rank = 1; rank < ranks_.size(); ++rank) ranks_.send(rank, stop_message);
}

int Executor::threads() const { return workers_->threads() + threads_elsewhere_; }

bool Executor::hand_out(const Job& job) {
  if (workers_->has_idle()) {
    workers_->start(job);
  } else {
    const auto slots = std::find_if(free_slots_.begin(), free_slots_.end(), [](int n) { return n > 0; });
    if (slots == free_slots_.end()) return false;
    --*slots;
    ranks_.send(static_cast<int>(slots - free_slots_.begin()), to_message(job));
  }
  ++running_;
  return true;
}

void Executor::take(const RunRecord& record, const std::function<void(const RunRecord&)>& done) {
  --running_;
  // A signal that reached only another rank ends the whole study.
  if (record.status == "interrupted")
    interrupt_ = true;
  else
    done(record);
}

void Executor::take_messages(const std::function<void(const RunRecord&)>& done) {
  while (const auto message = ranks_.receive()) {
    auto& slots = free_slots_[static_cast<std::size_t>(message->first)];
    if (!message->second.starts_with("{")) {
      slots = std::stoi(message->second);
      threads_elsewhere_ += slots;
      continue;
    }
    ++slots;
    const auto record = from_json(message->second);
    if (!record) throw std::runtime_error("a rank runs another version of edmill");
    take(*record, done);
  }
}

void Executor::run(std::vector<Job> jobs, const std::function<void(const RunRecord&)>& done,
                   const std::function<void()>& tick) {
  std::stable_sort(jobs.begin(), jobs.end(), [](const Job& a, const Job& b) { return a.cost > b.cost; });
  std::size_t next = 0;
  while (running_ > 0 || (next < jobs.size() && !interrupt_)) {
    take_messages(done);
    while (next < jobs.size() && !interrupt_ && hand_out(jobs[next])) ++next;
    // Threads of this process wake it; messages of other ranks do not.
    for (const auto& record : workers_->finished(milliseconds(ranks_.size() > 1 ? 2 : 50)))
      take(record, done);
    tick();
    // Other ranks would finish their runs first; the destructor waits for them.
    if (interrupt_ && !workers_->busy()) break;
  }
}

void serve(Ranks& ranks, int threads, const RunFunction& run, std::atomic<bool>& interrupt) {
  Workers workers(threads, run);
  ranks.send(0, std::to_string(workers.threads()));
  for (;;) {
    while (const auto message = ranks.receive()) {
      if (message->second == stop_message) {
        interrupt = true;
        return;
      }
      workers.start(to_job(message->second));
    }
    for (const auto& record : workers.finished(milliseconds(2))) ranks.send(0, to_json(record));
  }
}

}  // namespace edmill::study
