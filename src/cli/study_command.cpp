#include "cli/study_command.hpp"

#include <fmt/format.h>

#include "base/errors.hpp"
#include "casefile/memory_for.hpp"
#include "cli/run_case.hpp"
#include "instances/instances.hpp"
#include "io/terminal.hpp"
#include "run/cpu_limit.hpp"
#include "study/optimizer.hpp"
#include "study/study.hpp"

namespace edmill::cli {

namespace {

template <class Real>
study::RunRecord record_in(const casefile::CaseSpec& spec, double max_cpu_time,
                           const std::atomic<bool>* interrupt) {
  run::CpuLimit<Real> limit(max_cpu_time);
  run::Guests<Real> guests{{&limit}, interrupt};
  return study::record_of(run::simulate<Real>(spec, casefile::build_case<Real>(spec), guests).summary);
}

study::RunRecord do_job(const study::Job& job, const std::atomic<bool>* interrupt) {
  const auto spec = casefile::read_case(job.case_file, job.overrides);
#define EDMILL_RECORD_IN(Real)                   \
  if (spec.precision == ScalarName<Real>::value) \
    return casefile::with_memory_for(spec,       \
                                     [&] { return record_in<Real>(spec, job.max_cpu_time, interrupt); });
  EDMILL_FOR_EACH_SCALAR(EDMILL_RECORD_IN)
#undef EDMILL_RECORD_IN
  throw ContractError("no scalar named " + spec.precision);
}

std::string folder_of(const StudyOptions& options) {
  if (!options.folder.empty()) return options.folder;
  auto name = std::filesystem::path(options.file).stem();  // ward.sweep.toml: ward
  return "out/" + name.stem().string();
}

/// Rank 0 executes `command`; the other ranks do its runs.
template <class Command>
int on_all_ranks(const StudyOptions& options, const Command& command) {
  const auto* interrupt = options.interrupt;
  const study::RunFunction run = [interrupt](const study::Job& job) { return do_job(job, interrupt); };
  study::Ranks ranks;
  if (ranks.rank() > 0) {
    study::serve(ranks, options.jobs, run, *options.interrupt);
    return ok;
  }
  study::Executor executor(ranks, options.jobs, run, *options.interrupt);
  return command(executor);
}

int end_of(const study::Study& study, const StudyOptions& options) {
  const auto c = study.counts();
  if (!options.quiet)
    io::print("{} runs: {} reused, {} run now, {} failed{}\nTables are in {}\n", c.total, c.kept, c.ran,
              c.failed, study.interrupted() ? ", interrupted" : "", folder_of(options));
  return c.failed > 0 ? some_runs_failed : ok;
}

}  // namespace

int run_sweep(const StudyOptions& options) {
  return on_all_ranks(options, [&](study::Executor& executor) {
    const auto spec = casefile::read_sweep(options.file);
    study::Study study(spec, folder_of(options), "sweep", executor, !options.quiet);
    for (auto& point : study::points_of(spec)) study.add_runs(study.add_point(point), spec.replicas);
    study.require_a_good_case();
    study.run();
    return end_of(study, options);
  });
}

int run_optimize(const StudyOptions& options) {
  return on_all_ranks(options, [&](study::Executor& executor) {
    const auto spec = casefile::read_optimize(options.file);
    study::Study study(spec, folder_of(options), "optimize", executor, !options.quiet);
    const auto result = study::optimize(spec, study);
    if (!options.quiet) io::print("{}", study::describe(spec, study, result));
    return end_of(study, options);
  });
}

}  // namespace edmill::cli
