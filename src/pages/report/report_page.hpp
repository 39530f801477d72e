// Self-contained HTML pages: of a run, of several side by side, of a study.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "report/run_folder.hpp"

namespace edmill::study {
class Study;
}  // namespace edmill::study

namespace edmill::report {

/// The page as text. @throws InputError when a table is wrong
std::string report_page(const RunFolder& run);

/// Writes report.html into the folder of a run.
/// @return its place
/// @throws InputError when the folder holds no complete run, or when another process writes there
std::filesystem::path write_report(const std::filesystem::path& folder);
/// Writes the page as `write_report` does. @pre the caller holds the folder's lock
std::filesystem::path put_report(const std::filesystem::path& folder);

/// Whether two rates differ: the 95 % interval of their difference, by half-widths in quadrature, leaves out
/// zero. Nothing where a rate has no interval.
std::optional<bool> differ(const RateOf& a, const RateOf& b);
/// One page that shows runs side by side. @param runs  two or more
std::string comparison_page(std::vector<RunFolder> runs);
/// @throws InputError when a folder is no run, or the file cannot be written
void write_comparison(const std::vector<std::string>& folders, const std::filesystem::path& file);

/// The page of a sweep or an optimisation: rates of all points with their intervals.
/// @param kind     "Sweep"
/// @param finding  lines of text, such as what an optimisation found; none when empty
std::string study_page(const study::Study& study, const std::string& kind, const std::string& finding);

}  // namespace edmill::report
