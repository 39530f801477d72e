#include "cli/report_command.hpp"

#include <fmt/format.h>

#include "base/errors.hpp"
#include "cli/run_case.hpp"
#include "io/output_folder.hpp"
#include "report/report_page.hpp"

namespace edmill::cli {

namespace {

/// Temporary files of killed commands, unless another one works in the folder: they could be its own.
void remove_leftovers(const std::string& folder) {
  try {
    const io::FolderLock alone(folder, true);
    io::remove_temporaries(std::filesystem::path(folder) / "report.html", "");
  } catch (const InputError&) {
  }
}

}  // namespace

int run_report(const std::string& folder, bool quiet) {
  remove_leftovers(folder);
  const auto place = report::write_report(folder);
  if (!quiet) fmt::print("The report is {}\n", place.string());
  return ok;
}

}  // namespace edmill::cli
