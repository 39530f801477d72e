#include "cli/run_command.hpp"

#include <fmt/format.h>

#include "cli/dispatch.hpp"
#include "report/report_page.hpp"

namespace edmill::cli {

int run_and_report(const std::string& precision, casefile::CaseSpec spec, RunOptions options) {
  if (options.report) report::add_report_outputs(spec);
  std::string place;
  options.when_written = [&] {
    report::write_case(options.folder, spec, options.report);
    if (options.report) place = report::write_report(options.folder).string();
  };
  const int code = run_case(precision, spec, options);
  if (options.report && !options.quiet) fmt::print("The report is {}\n", place);
  return code;
}

}  // namespace edmill::cli
