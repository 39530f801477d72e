#include "app/run.hpp"

#include "base/errors.hpp"
#include "casefile/case_spec.hpp"
#include "io/atomic_file.hpp"
#include "io/input_file.hpp"
#include "io/output_folder.hpp"
#include "io/summary.hpp"
#include "report/report_page.hpp"
#include "run/run_folder.hpp"

namespace edmill::app {

namespace {

/// Writes the text of `what_decides`, if it is required, to a file in the folder, and returns it.
std::string checked(
    const casefile::CaseSpec& spec, const io::Facts& facts, const RunOptions& options) {
  constexpr double few_impacts =
      1e6;  // six runs of a second each; their times would differ from run to run
  const bool quick =
      facts.text("precision") == "double" && facts.number("impacts_since_start") < few_impacts;
  if (!options.what_decides || !(options.check || (options.report && quick))) return "";
  const auto text = options.what_decides(spec, facts);
  if (text.empty()) return text;
  io::AtomicFile file(std::filesystem::path(options.folder) / report::check_file);
  file.stream() << text;
  file.complete();
  io::record_files(options.folder, {file.place()});
  file.commit();
  return text;
}

}  // namespace

RunResult run(const std::string& precision, casefile::CaseSpec spec, const RunOptions& options) {
  if (options.report) report::add_report_outputs(spec);
  return casefile::with_memory_for(spec, [&] {
    const auto run = run::make_run(precision, spec, options);
    run->write_to(options.folder, options.checkpoint, options.without_locks);
    options.begun();
    try {
      run->finish();
    } catch (const UndecidedError&) {  // the summary says so, and covers the time up to then
    }
    const auto facts = run->facts();
    RunResult result{io::end_reason_of(facts), facts.has("error") ? facts.text("error") : "",
        report::result_table(facts, casefile::partners_of(spec)), run->goes_on(), {}};
    run->commit([&] {
      result.table += checked(spec, facts, options);
      if (options.report) result.report = report::put_report(options.folder).string();
      Archive archive;
      archive(result);
      return archive.bytes();
    });
    return result;
  });
}

io::Checkpoint first_checkpoint(const casefile::CaseSpec& spec, const std::string& precision,
    bool report, const std::string& interval) {
  io::Checkpoint c;
  c.case_file = spec.file;
  c.case_text = spec.text;
  c.case_digest = spec.digest;
  if (io::is_stream(spec.initial_state))
    throw InputError(
        "key 'run.initial_state': found a pipe, expected a file: a resumed run reads it again");
  if (!spec.initial_state.empty())
    c.initial_state = std::filesystem::absolute(spec.initial_state).string();
  c.overrides = spec.settings;
  c.precision = precision;
  c.right_digits = spec.right_digits;
  c.report = report;
  c.interval = interval;
  return c;
}

/// Removes what a run left that was killed when its results were in place.
RunResult removed_leftovers(const casefile::CaseSpec& spec, const RunOptions& options) {
  const auto& bytes = options.checkpoint->result;
  run::RunFolder(options.folder, spec, options.checkpoint).remove_checkpoint(bytes);
  Archive archive(bytes);
  RunResult result;
  archive(result);
  return result;
}

RunResult resume(const std::string& interval, RunOptions options) {
  auto checkpoint = io::read_checkpoint(options.folder);
  if (!interval.empty()) checkpoint.interval = interval;
  auto overrides = checkpoint.overrides;
  if (!checkpoint.initial_state.empty())
    overrides.push_back("run.initial_state='" + checkpoint.initial_state + "'");
  auto spec = casefile::parse_case(checkpoint.case_text, checkpoint.case_file, overrides);
  spec.settings = checkpoint.overrides;
  spec.right_digits = checkpoint.right_digits;
  if (spec.digest != checkpoint.case_digest)
    throw InputError(options.folder + ": the initial state in " + spec.initial_state +
        " has changed since the run began: restore that file");
  const std::string precision = checkpoint.precision;
  options.report = checkpoint.report;
  options.checkpoint = std::move(checkpoint);
  if (!options.checkpoint->result.empty()) return removed_leftovers(spec, options);
  return run(precision, std::move(spec), options);
}

}  // namespace edmill::app
