#include "study/workers.hpp"

#include <tbb/info.h>

#include "base/errors.hpp"

namespace edmill::study {

Workers::Workers(int threads, RunFunction run)
    : threads_(threads > 0 ? threads : tbb::info::default_concurrency()),
      run_(std::move(run)),
      control_(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads_) + 1),
      arena_(threads_, 0) {}

Workers::~Workers() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return running_ == 0; });
}

bool Workers::has_idle() const {
  const std::lock_guard lock(mutex_);
  return running_ < threads_;
}

bool Workers::busy() const {
  const std::lock_guard lock(mutex_);
  return running_ > 0 || !finished_.empty();
}

RunRecord Workers::do_job(const Job& job) const {
  try {
    return run_(job);
  } catch (const InputError& error) {
    return failed_run(job.digest, "bad_case", error.what());
  } catch (const std::exception& error) {
    return failed_run(job.digest, "error", error.what());
  }
}

void Workers::start(const Job& job) {
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

std::vector<RunRecord> Workers::finished(std::chrono::milliseconds wait) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, wait, [&] { return !finished_.empty(); });
  return std::exchange(finished_, {});
}

}  // namespace edmill::study
