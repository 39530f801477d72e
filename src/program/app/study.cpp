#include "app/study.hpp"

#include "base/errors.hpp"
#include "casefile/memory_for.hpp"
#include "report/report_page.hpp"
#include "run/any_run.hpp"
#include "study/optimizer.hpp"

namespace edmill::app {

namespace {

study::RunRecord do_job(const study::Job& job, const std::atomic<bool>* interrupt) {
  const auto spec = casefile::read_case(job.case_file, job.overrides);
  if (spec.digits)
    throw InputError(
        spec.file +
        ": key 'run.digits': found it in a study, expected a precision: digits are found for one run");
  return casefile::with_memory_for(spec, [&] {
    run::RunSetup setup;
    setup.interrupt = interrupt;
    setup.max_cpu_time = job.max_cpu_time;
    const auto run = run::make_run(spec.precision, spec, setup);
    try {
      run->finish();
    } catch (const UndecidedError&) {  // part of the record
    }
    return study::record_of(run->summary());
  });
}

std::string folder_of(const StudyOptions& options) {
  if (!options.folder.empty()) return options.folder;
  auto name = std::filesystem::path(options.file).stem();  // ward.sweep.toml: ward
  return "out/" + name.stem().string();
}

/// Rank 0 executes `command`; the other ranks do its runs.
template <class Command>
std::optional<StudyResult> on_all_ranks(const StudyOptions& options, const Command& command) {
  const auto* interrupt = options.interrupt;
  const study::RunFunction run = [interrupt](const study::Job& job) { return do_job(job, interrupt); };
  study::Ranks ranks;
  if (ranks.rank() > 0) {
    study::serve(ranks, options.jobs, run, *options.interrupt);
    return std::nullopt;
  }
  study::Executor executor(ranks, options.jobs, run, *options.interrupt);
  return command(executor);
}

}  // namespace

std::optional<StudyResult> sweep(const StudyOptions& options) {
  return on_all_ranks(options, [&](study::Executor& executor) {
    const auto spec = casefile::read_sweep(options.file);
    const auto folder = folder_of(options);
    study::Study study(spec, folder, "sweep", executor, !options.quiet);
    for (auto& point : study::points_of(spec)) study.add_runs(study.add_point(point), spec.replicas);
    study.require_a_good_case();
    if (options.estimate) return StudyResult{{}, false, "", "", study.forecast()};
    study.run();
    study.write_page(report::study_page(study, "Sweep", ""));
    return StudyResult{study.counts(), study.interrupted(), folder, "", ""};
  });
}

std::optional<StudyResult> optimize(const StudyOptions& options) {
  return on_all_ranks(options, [&](study::Executor& executor) {
    const auto spec = casefile::read_optimize(options.file);
    const auto folder = folder_of(options);
    study::Study study(spec, folder, "optimize", executor, !options.quiet);
    if (options.estimate) return StudyResult{{}, false, "", "", study::forecast(spec, study)};
    const auto result = study::optimize(spec, study);
    const auto finding = study::describe(spec, study, result);
    study.write_page(report::study_page(study, "Optimisation", finding));
    return StudyResult{study.counts(), study.interrupted(), folder, finding, ""};
  });
}

}  // namespace edmill::app
