#include "cli/report_command.hpp"

#include "cli/run_case.hpp"
#include "io/terminal.hpp"
#include "report/report_page.hpp"

namespace edmill::cli {

int run_report(const std::string& folder, bool quiet) {
  const auto place = report::write_report(folder);
  if (!quiet) io::print("The report is {}\n", place.string());
  return ok;
}

}  // namespace edmill::cli
