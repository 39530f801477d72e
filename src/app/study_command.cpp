#include "edmill/app/study_command.hpp"

#include <fmt/format.h>

#include "edmill/app/run_case.hpp"
#include "edmill/core/errors.hpp"
#include "edmill/instances.hpp"
#include "edmill/sweep/optimizer.hpp"
#include "edmill/sweep/study.hpp"

namespace edmill::app {

namespace {

template <class Real>
sweep::RunRecord record_in(const casefile::CaseSpec& spec, const std::atomic<bool>* interrupt) {
  driver::Guests<Real> guests;
  guests.interrupt = interrupt;
  return sweep::record_of(driver::simulate<Real>(spec, setup::build_case<Real>(spec), guests).summary);
}

sweep::RunRecord do_job(const sweep::Job& job, const std::atomic<bool>* interrupt) {
  const auto spec = casefile::read_case(job.case_file, job.overrides);
#define EDMILL_RECORD_IN(Real) \
  if (spec.precision == ScalarName<Real>::value) return record_in<Real>(spec, interrupt);
  EDMILL_FOR_EACH_SCALAR(EDMILL_RECORD_IN)
#undef EDMILL_RECORD_IN
  throw ContractError("no scalar named " + spec.precision);
}

std::string folder_of(const StudyOptions& options) {
  if (!options.folder.empty()) return options.folder;
  auto name = std::filesystem::path(options.file).stem();  // ward.sweep.toml: ward
  return "out/" + name.stem().string();
}

/// Gives rank 0 to `command`; the other ranks do its runs.
template <class Command>
int on_all_ranks(const StudyOptions& options, const Command& command) {
  const auto* interrupt = options.interrupt;
  const sweep::RunFunction run = [interrupt](const sweep::Job& job) { return do_job(job, interrupt); };
  sweep::Ranks ranks;
  if (ranks.rank() > 0) {
    sweep::serve(ranks, options.jobs, run, *options.interrupt);
    return ok;
  }
  sweep::Executor executor(ranks, options.jobs, run, *options.interrupt);
  return command(executor);
}

int end_of(const sweep::Study& study, const StudyOptions& options) {
  const auto c = study.counts();
  if (!options.quiet)
    fmt::print("{} runs: {} known from before, {} run now, {} failed{}\nTables are in {}\n", c.total, c.kept,
               c.ran, c.failed, study.interrupted() ? ", interrupted" : "", folder_of(options));
  return c.failed > 0 ? some_runs_failed : ok;
}

}  // namespace

int run_sweep(const StudyOptions& options) {
  return on_all_ranks(options, [&](sweep::Executor& executor) {
    const auto spec = casefile::read_sweep(options.file);
    sweep::Study study(spec, folder_of(options), "sweep", executor, !options.quiet);
    for (auto& point : sweep::points_of(spec)) study.add_runs(study.add_point(point), spec.replicas);
    study.require_a_good_case();
    study.run();
    return end_of(study, options);
  });
}

int run_optimize(const StudyOptions& options) {
  return on_all_ranks(options, [&](sweep::Executor& executor) {
    const auto spec = casefile::read_optimize(options.file);
    sweep::Study study(spec, folder_of(options), "optimize", executor, !options.quiet);
    const auto result = sweep::optimize(spec, study);
    if (!options.quiet) fmt::print("{}", sweep::describe(spec, study, result));
    return end_of(study, options);
  });
}

}  // namespace edmill::app
