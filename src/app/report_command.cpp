#include "edmill/app/report_command.hpp"

#include <fmt/format.h>

#include "edmill/app/run_case.hpp"
#include "edmill/page/report_page.hpp"

namespace edmill::app {

int run_report(const std::string& folder, bool quiet) {
  const auto place = page::write_report(folder);
  if (!quiet) fmt::print("The report is {}\n", place.string());
  return ok;
}

}  // namespace edmill::app
