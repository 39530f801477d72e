// `edmill report`: the files of a run as one self-contained HTML page.
#pragma once

#include <filesystem>
#include <string>

#include "report/run_folder.hpp"

namespace edmill::report {

/// The page as text. @throws InputError when a table is wrong
std::string report_page(const RunFolder& run);

/// Writes report.html into the folder of a run.
/// @return its place
/// @throws InputError when the folder holds no complete run, or when another process writes there
std::filesystem::path write_report(const std::filesystem::path& folder);
/// Writes the page as `write_report` does. @pre the caller holds the folder's lock
std::filesystem::path put_report(const std::filesystem::path& folder);

}  // namespace edmill::report
