#include "cli/run_command.hpp"

#include "casefile/memory_for.hpp"
#include "cli/dispatch.hpp"
#include "io/terminal.hpp"
#include "report/report_page.hpp"

namespace edmill::cli {

int run_and_report(const std::string& precision, casefile::CaseSpec spec, RunOptions options) {
  if (options.report) report::add_report_outputs(spec);
  options.case_text = report::case_text(spec, options.report);
  std::string place;
  options.when_written = [&] {
    if (options.report) place = report::put_report(options.folder).string();
  };
  const int code = casefile::with_memory_for(spec, [&] { return run_case(precision, spec, options); });
  if (options.report && !options.quiet) io::print("The report is {}\n", place);
  return code;
}

void tell_of_missing_locks(const std::filesystem::path& folder) {
  io::tell(
      "edmill: {}: this file system has no locks; nothing but you keeps another process out of the folder\n",
      folder.string());
}

}  // namespace edmill::cli
