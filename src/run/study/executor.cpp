#include "study/executor.hpp"

#include <fmt/format.h>
#include <tbb/concurrent_queue.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <thread>
#include <utility>

#include "base/errors.hpp"

#ifdef EDMILL_MPI
#include <mpi.h>
#endif

namespace edmill::study {

#ifdef EDMILL_MPI

namespace {

/// Without a launcher MPI_Init would needlessly start daemons, which requires a network.
bool launched() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"})
    if (std::getenv(name)) return true;
  return false;
}

}  // namespace

Ranks::Ranks() {
  if (!launched()) return;
  int level = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &level);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
}

Ranks::~Ranks() {
  if (launched()) MPI_Finalize();
}

void Ranks::send(int to, const std::string& text) const {
  MPI_Send(text.data(), static_cast<int>(text.size()), MPI_CHAR, to, 0, MPI_COMM_WORLD);
}

std::optional<std::pair<int, std::string>> Ranks::receive() const {
  if (size_ == 1) return std::nullopt;
  int there = 0, length = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, 0, MPI_COMM_WORLD, &there, &status);
  if (!there) return std::nullopt;
  MPI_Get_count(&status, MPI_CHAR, &length);
  std::string text(static_cast<std::size_t>(length), '\0');
  MPI_Recv(text.data(), length, MPI_CHAR, status.MPI_SOURCE, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return std::make_pair(status.MPI_SOURCE, std::move(text));
}

#else

Ranks::Ranks() = default;
Ranks::~Ranks() = default;
void Ranks::send(int, const std::string&) const {}
std::optional<std::pair<int, std::string>> Ranks::receive() const { return std::nullopt; }

#endif

namespace {

using std::chrono::milliseconds;

/// At most `most` jobs, evenly spaced in the order of their costs, from the first to the last.
std::vector<Job> chosen(std::vector<Job> jobs, std::size_t most) {
  std::stable_sort(
      jobs.begin(), jobs.end(), [](const Job& a, const Job& b) { return a.cost < b.cost; });
  if (jobs.size() <= most) return jobs;
  std::vector<Job> few;
  for (std::size_t k = 0; k < most; ++k) few.push_back(jobs[k * (jobs.size() - 1) / (most - 1)]);
  return few;
}

}  // namespace

class Workers {
 public:
  /// @param threads  0 for all cores
  Workers(int threads, RunFunction run)
      : threads_(threads > 0 ? threads : tbb::info::default_concurrency()), run_(std::move(run)),
        control_(
            tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads_) + 1),
        arena_(threads_, 0) {}
  ~Workers() {
    wait(milliseconds::max(), [this] { return running_ == 0; });
  }
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  int threads() const { return threads_; }
  bool has_idle() const { return running_ < threads_; }
  bool busy() const { return running_ > 0 || !finished_.empty(); }
  void start(const Job& job) {
    ++running_;
    arena_.enqueue([this, job] {
      finished_.push(do_job(job));
      --running_;
    });
  }
  /// Records since the last call; waits briefly for one when jobs are running.
  std::vector<RunRecord> finished(milliseconds longest) {
    wait(longest, [this] { return !finished_.empty(); });
    std::vector<RunRecord> records;
    for (RunRecord record; finished_.try_pop(record);) records.push_back(std::move(record));
    return records;
  }
 private:
  static void wait(milliseconds longest, const auto& is_over) {
    for (milliseconds waited{0}; !is_over() && waited < longest; ++waited)
      std::this_thread::sleep_for(milliseconds(1));
  }
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
  std::atomic<int> running_ = 0;
  tbb::concurrent_queue<RunRecord> finished_;
};

Executor::Executor(Ranks& ranks, int threads, RunFunction run, std::atomic<bool>& interrupt)
    : ranks_(ranks), interrupt_(interrupt),
      workers_(std::make_unique<Workers>(threads, std::move(run))),
      free_slots_(static_cast<std::size_t>(ranks.size()), 0) {}

Executor::~Executor() {
  if (running_ > 0) interrupt_ = true;
  for (int rank = 1; rank < ranks_.size(); ++rank) ranks_.send(rank, "");
}

int Executor::threads() const { return workers_->threads() + threads_elsewhere_; }

// Messages. From rank 0: a job, or nothing to stop; to rank 0: a number of threads, or a record.
bool Executor::hand_out(Job& job) {
  if (workers_->has_idle()) {
    workers_->start(job);
  } else {
    const auto slots =
        std::find_if(free_slots_.begin(), free_slots_.end(), [](int n) { return n > 0; });
    if (slots == free_slots_.end()) return false;
    --*slots;
    Archive message;
    message(job);
    ranks_.send(static_cast<int>(slots - free_slots_.begin()), message.bytes());
  }
  ++running_;
  return true;
}

void Executor::take(const RunRecord& record, const RecordFunction& done) {
  --running_;
  // A signal that reached only another rank ends the whole study.
  if (record.status == "interrupted")
    interrupt_ = true;
  else
    done(record);
}

void Executor::take_messages(const RecordFunction& done) {
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

void Executor::run(
    std::vector<Job> jobs, const RecordFunction& done, const std::function<void()>& tick) {
  std::stable_sort(
      jobs.begin(), jobs.end(), [](const Job& a, const Job& b) { return a.cost > b.cost; });
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

void Forecast::make(const std::vector<Job>& jobs, Executor& executor, const RecordFunction& done) {
  std::map<std::string, Job> tried;
  std::vector<Job> short_jobs;
  for (const auto& job : chosen(jobs, trials)) {
    tried.emplace(job.digest, job);
    short_jobs.push_back(job);
    short_jobs.back().max_cpu_time = std::min(job.max_cpu_time, trial_time);
  }
  const auto take = [&](const RunRecord& record) {
    const auto& job = tried.at(record.digest);
    const double simulated = record.facts.find("end_time").value_or(0) - job.initial_time;
    if (record.lasting()) {
      rates_[job.cost] = record.cpu_seconds() / job.cost;
      done(record);
    } else if (simulated > 0 && std::isfinite(job.end_time)) {
      const double all = record.cpu_seconds() * (job.end_time - job.initial_time) / simulated;
      rates_[job.cost] = std::min(all, job.max_cpu_time) / job.cost;
    }
  };
  executor.run(std::move(short_jobs), take, [] {});
}

std::optional<double> Forecast::seconds(const Job& job) const {
  if (rates_.empty() || !std::isfinite(job.end_time)) return std::nullopt;
  // The rate changes slowly with the cost, so the rate of the nearest job that was tried is used.
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

void serve(Ranks& ranks, int threads, const RunFunction& run, std::atomic<bool>& interrupt) {
  Workers workers(threads, run);
  ranks.send(0, std::to_string(workers.threads()));
  for (;;) {
    while (const auto message = ranks.receive()) {
      if (message->second.empty()) {
        interrupt = true;
        return;
      }
      Job job;
      Archive(message->second)(job);
      workers.start(job);
    }
    for (const auto& record : workers.finished(milliseconds(2))) ranks.send(0, to_json(record));
  }
}

}  // namespace edmill::study
