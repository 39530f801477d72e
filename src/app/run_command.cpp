#include "edmill/app/run_command.hpp"

#include <fmt/format.h>

#include "edmill/app/dispatch.hpp"
#include "edmill/page/report_page.hpp"

namespace edmill::app {

int run_and_report(const std::string& precision, casefile::CaseSpec spec, RunOptions options) {
  if (options.report) page::add_report_outputs(spec);
  std::string place;
  options.when_written = [&] {
    page::write_case(options.folder, spec, options.report);
    if (options.report) place = page::write_report(options.folder).string();
  };
  const int code = run_case(precision, spec, options);
  if (options.report && !options.quiet) fmt::print("The report is {}\n", place);
  return code;
}

}  // namespace edmill::app
