// `edmill report`: what a run left, as one HTML page that needs nothing else.
#pragma once

#include <filesystem>
#include <string>

#include "report/run_folder.hpp"

namespace edmill::report {

/// The page as text. @throws InputError when a table is wrong
std::string report_page(const RunFolder& run);

/// Writes report.html into the folder of a run.
/// @return its place
/// @throws InputError when the folder holds no run, or a broken one
std::filesystem::path write_report(const std::filesystem::path& folder);

}  // namespace edmill::report
