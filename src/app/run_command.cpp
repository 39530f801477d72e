#include "edmill/app/run_command.hpp"

#include "edmill/app/dispatch.hpp"
#include "edmill/app/report_command.hpp"
#include "edmill/page/run_folder.hpp"

namespace edmill::app {

int run_and_report(const std::string& precision, casefile::CaseSpec spec, const RunOptions& options) {
  if (options.report) page::add_report_outputs(spec);
  const int code = run_case(precision, spec, options);
  page::write_case(options.folder, spec, options.report);
  if (options.report) run_report(options.folder, options.quiet);
  return code;
}

}  // namespace edmill::app
